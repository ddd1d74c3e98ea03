// What pictures show and how the opaque part of it is drawn with OpenGL. What Stage is with Vulkan.
#pragma once

#include <optional>

#include "../scene/camera.h"
#include "../scene/scene.h"
#include "gl_frame.h"

namespace vitrail::tool {

class GlStage {
 public:
  // The scene need not outlive it; the Gl does. `released` as in GlScene. Throws GpuError, also where the device does
  // not draw so many samples.
  GlStage(Gl& gl, const Scene& scene, std::optional<float> opacity, DrawOrder order, std::uint32_t samples,
          Scene* released);

  Gl& gl() { return gl_; }
  const GlSurfaces& surfaces() const { return surfaces_; }
  const GlImages& images() const { return images_; }

  // What the images are for, before the first of them: makes the programs of the opaque scene. Throws GpuError.
  void setNeeds(const GlImageNeeds& needs);
  bool hasSize(std::uint32_t width, std::uint32_t height) const;
  // Makes images of another size, in place of the old ones. Throws GpuError.
  void setSize(std::uint32_t width, std::uint32_t height);
  // Looks at the scene so, through images that have their size.
  void setView(const View& view);

  // Draws the background, opaque and alpha-masked surfaces, as the pass "opaque".
  void drawOpaque(GlFrame& frame, const Background& background);
  // Draws the background alone and finishes the picture.
  void drawBackground(GlFrame& frame, const Background& background);
  // With several samples that are blended by themselves, takes their mean, as the pass "box_filter".
  void finishPicture(GlFrame& frame);

 private:
  void begin(const Background& background);

  Gl& gl_;
  GlImagesInfo info_;
  GlSurfaces surfaces_;
  GlImages images_;
  std::optional<GlSurfacePrograms> opaque_;
  GlObject sky_;
  GlObject noVertices_;
};

} // namespace vitrail::tool
