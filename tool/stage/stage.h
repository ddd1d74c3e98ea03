// What pictures show and how the opaque part of it is drawn: a scene on the GPU, the view, the images, and the pass
// before the transparent surfaces. Drivers (render/) have one, with a method that draws the rest.
#pragma once

#include <optional>

#include "../scene/camera.h"
#include "../scene/scene.h"
#include "frame.h"
#include "picture_images.h"
#include "surfaces.h"

namespace vitrail::tool {

// The scene of a stage.
struct StageInfo {
  std::optional<float> opacity;         // of every material: X-ray view. Default: the materials' own
  DrawOrder order = DrawOrder::Forward; // of the transparent draws
  std::uint32_t samples = 1;            // of a pixel
  Scene* released = nullptr;            // the same scene, whose geometry is let go of as it has been copied; or null
  std::uint32_t framesInFlight = 1;     // that may be pending at once
};

class Stage {
 public:
  // The scene need not outlive it; the Gpu does. Throws GpuError, also where the device does not draw so many samples.
  Stage(Gpu& gpu, const Scene& scene, const StageInfo& info);

  Gpu& gpu() { return gpu_; }
  const Surfaces& surfaces() const { return surfaces_; }
  PictureImages& images() { return images_; }
  std::uint32_t samples() const { return static_cast<std::uint32_t>(imagesInfo_.samples); }

  // What the images are for, before the first of them: makes the pipelines of the opaque scene. Throws GpuError.
  void setNeeds(const ImageNeeds& needs);

  // Whether the images have that size. No frame is pending, for this and setSize().
  bool hasSize(VkExtent2D extent) const;
  // Makes images of another size, in place of the old ones. Throws GpuError.
  void setSize(VkExtent2D extent);
  // Which images those are: how often they have been made.
  std::uint64_t imagesMade() const { return imagesMade_; }
  // Looks at the scene so, through images that have their size, or the part of them that is drawn. No frame is pending
  // that was recorded `framesInFlight` views ago.
  void setView(const View& view);
  // The same, of a picture of that size on no images.
  void setView(const View& view, VkExtent2D extent);

  // As SurfaceList.
  void setClipPlanes(const Scene& scene) { surfaces_.setClipPlanes(scene); }

  // Draws the background, opaque and alpha-masked surfaces, as the pass "opaque".
  void drawOpaque(Frame& frame, const Background& background);
  // Draws the background alone and finishes the picture.
  void drawBackground(Frame& frame, const Background& background);
  // With several samples that are blended by themselves, takes their mean, as the pass "box_filter".
  void finishPicture(Frame& frame);

 private:
  struct OpaquePass {
    SurfacePipelines surfaces;
    Unique<VkPipeline> sky;
  };

  void cmdBegin(VkCommandBuffer commands, const Background& background);

  Gpu& gpu_;
  PictureImagesInfo imagesInfo_;
  Surfaces surfaces_;
  PictureImages images_;
  std::uint64_t imagesMade_ = 0;
  std::optional<OpaquePass> opaque_;
};

} // namespace vitrail::tool
