// Light through objects that absorb it: a resolve of the tool's own over the library's sorted lists, for scenes that
// have such objects (media_resolve.comp).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "../../gpu/descriptors.h"
#include "../../gpu/pipeline.h"
#include "../../gpu/resources.h"
#include "../../stage/surfaces.h"
#include "../method.h"
#include "media_shared.h"

namespace vitrail::tool {

class Media {
 public:
  // `lists` is the layout of the library's set. `scene` is what the surfaces show. Throws GpuError.
  Media(const MethodHost& host, VkDescriptorSetLayout lists, std::uint32_t samples);

  // Writes the picture of `target`, whose depth is sampled.
  void setTarget(const MethodTarget& target);
  // How the surfaces are seen now. No frame is pending.
  void setView(const shaders::FrameData& view);

  // Whether rays may begin inside of an object, seen so. Surfaces of such objects are drawn whatever opaque surfaces
  // are before them.
  bool anyNear() const { return anyNear_; }
  // What of `runs` those surfaces are, or what else there is.
  std::vector<SurfaceRun> part(std::span<const SurfaceRun> runs, bool near) const;

  // Draws the lists of an area that the library has sorted, over the opaque picture. Images and lists are there for
  // compute shaders. Outside a rendering scope.
  void cmdResolve(VkCommandBuffer commands, VkDescriptorSet lists, VkExtent2D area) const;

 private:
  // An object's box where the GPU has it, and its row of the table.
  struct Placed {
    std::uint32_t object = 0;
    glm::dmat4 toBox{1.0}; // from the GPU's space; of no use where the object is flat
    bool flat = false;
    Bounds box;
  };

  Unique<VkPipeline> makePipeline(bool anyNear);

  Gpu& gpu_;
  std::uint32_t samples_;
  GpuBuffer objects_; // shaders::MediaObject, one an instance
  std::vector<Placed> placed_;
  std::vector<bool> near_; // by instance
  bool anyNear_ = false;
  SingleSet set_;
  Unique<VkPipelineLayout> layout_;
  std::array<Unique<VkPipeline>, 2> pipelines_; // for views without such objects and with them, once there are any
  shaders::MediaView view_{};
};

} // namespace vitrail::tool
