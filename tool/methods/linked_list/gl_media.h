// Light through objects that absorb it, with OpenGL. What Media is with Vulkan.
#pragma once

#include <array>
#include <cstdint>

#include "../../opengl/gl_frame.h"
#include "../gl_method.h"
#include "media_objects.h"

namespace vitrail::tool {

class GlMedia {
 public:
  // `lists` is the library's text for shaders that walk lists. Throws GpuError.
  GlMedia(const GlMethodHost& host, const char* lists, std::uint32_t samples);

  // How the surfaces are seen now. `tested`: coverage has passed the depth test.
  void setView(const shaders::FrameData& view, bool tested);
  const MediaObjects& objects() const { return list_; }

  // Draws the lists of an area that the library has sorted and bound, over the opaque picture.
  void resolve(const GlImages& images, std::uint32_t width, std::uint32_t height) const;

 private:
  GlObject makeProgram(bool anyNear, bool tested) const;

  Gl& gl_;
  std::string lists_;
  std::uint32_t samples_;
  MediaObjects list_;
  GlBuffer buffer_; // its table
  GlPushed view_;
  std::array<GlObject, 2> programs_; // for views without such objects that rays begin in and with them
};

} // namespace vitrail::tool
