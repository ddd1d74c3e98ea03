// Light through objects that absorb it: a resolve of the tool's own over the library's sorted lists, for scenes that
// have such objects (media_resolve.comp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "../../gpu/descriptors.h"
#include "../../gpu/pipeline.h"
#include "../../gpu/resources.h"
#include "../method.h"
#include "media_objects.h"

namespace vitrail::tool {

class Media {
 public:
  // `lists` is the layout of the library's set. `scene` is what the surfaces show. Throws GpuError.
  Media(const MethodHost& host, VkDescriptorSetLayout lists, std::uint32_t samples);

  // Writes the picture of `target`, whose depth is sampled.
  void setTarget(const MethodTarget& target);
  // How the surfaces are seen by the frames to come, as Surfaces has it.
  void setView(const shaders::FrameData& view);

  const MediaObjects& objects() const { return list_; }

  // Draws the lists of an area that the library has sorted, over the opaque picture. Images and lists are there for
  // compute shaders. Outside a rendering scope.
  void cmdResolve(VkCommandBuffer commands, VkDescriptorSet lists, VkExtent2D area) const;

 private:
  Unique<VkPipeline> makePipeline(bool anyNear);

  Gpu& gpu_;
  std::uint32_t samples_;
  MediaObjects list_;
  struct Slot {
    GpuBuffer buffer; // its table
    SingleSet set;
  };
  std::vector<Slot> slots_; // of each frame in flight
  std::size_t slot_ = 0;    // of the frames to come
  Unique<VkPipelineLayout> layout_;
  std::array<Unique<VkPipeline>, 2> pipelines_; // for views without such objects and with them, once there are any
};

} // namespace vitrail::tool
