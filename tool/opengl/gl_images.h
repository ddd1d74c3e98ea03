// The textures that a picture is drawn into, and the framebuffers of a frame's passes over them. What PictureImages are
// with Vulkan. The first row of each is the picture's uppermost one.
#pragma once

#include <array>
#include <cstdint>

#include "objects.h"

namespace vitrail::tool {

// What who draws transparent surfaces asks of the images; as ImageNeeds (stage/picture_images.h).
struct GlImageNeeds {
  bool perSample = false; // surfaces are blended into the multisampled image, which is box-filtered
  bool stencil = false;   // depth has a stencil beside it
};

struct GlImagesInfo : GlImageNeeds {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 1;
};

class GlImages {
 public:
  GlImages() = default;
  // Throws GpuError where the device cannot render a picture of that size.
  GlImages(Gl& gl, const GlImagesInfo& info);

  const GlImagesInfo& info() const { return info_; }
  GLuint color() const { return color_.get(); }               // RGBA16F, one sample, linear, premultiplied alpha
  GLuint multisampled() const { return multisampled_.get(); } // the same with several samples; 0 at one
  GLuint depth() const { return depth_.get(); }               // as many samples

  // Binds a framebuffer for drawing over the whole picture:
  void bindDrawn() const;      // the opaque surfaces' colour, with its depth and stencil
  void bindDepthAlone() const; // the same without a colour
  void bindColor() const;      // the picture of one sample alone

  // The mean of several samples.
  void boxFilter() const;

 private:
  void bind(const GlObject& framebuffer) const;

  GlImagesInfo info_;
  GlTexture color_;
  GlTexture multisampled_;
  GlTexture depth_;
  GlObject drawnFramebuffer_;
  GlObject depthFramebuffer_;
  GlObject colorFramebuffer_;
};

// Clears a framebuffer's first colour.
void clearColor(const std::array<float, 4>& color);

} // namespace vitrail::tool
