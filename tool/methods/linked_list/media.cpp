#include "media.h"

#include <array>
#include <cstring>

#include "../../gpu/pixel_pass_shared.h"
#include "shaders/media_resolve.comp.h"
#include "shaders/media_resolve_address.comp.h"
#include "shaders/media_resolve_samples.comp.h"
#include "shaders/media_resolve_samples_address.comp.h"

namespace vitrail::tool {

namespace {

std::span<const std::uint32_t> resolveCode(bool several, bool byAddress) {
  if (several && byAddress) return shaders::media_resolve_samples_address_comp;
  if (several) return shaders::media_resolve_samples_comp;
  if (byAddress) return shaders::media_resolve_address_comp;
  return shaders::media_resolve_comp;
}

} // namespace

Media::Media(const MethodHost& host, VkDescriptorSetLayout lists, std::uint32_t samples)
    : gpu_(host.gpu),
      samples_(samples),
      list_(host.surfaces.scene(), host.scene),
      slots_(host.surfaces.framesInFlight()) {
  for (Slot& slot : slots_) {
    slot.buffer = GpuBuffer(gpu_, list_.table().size() * sizeof(shaders::MediaObject),
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryKind::Upload, "objects that absorb");
    slot.set = SingleSet(gpu_,
                         {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},
                          {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
                          {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT},
                          {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT}},
                         "media");
    slot.set.writeBuffer(0, slot.buffer.get(), slot.buffer.size());
  }
  layout_ = makePipelineLayout(gpu_, {lists, slots_[0].set.layout()},
                               {VK_SHADER_STAGE_COMPUTE_BIT, sizeof(shaders::MediaView)}, "media resolve");
}

Unique<VkPipeline> Media::makePipeline(bool anyNear) {
  const bool tested = samples_ == 1 || gpu_.features().postDepthCoverage;
  return makeComputePipeline(gpu_, layout_.get(), resolveCode(samples_ > 1, gpu_.features().poolByAddress),
                             "media resolve",
                             {{0, samples_}, {1, tested ? VK_FALSE : VK_TRUE}, {2, anyNear ? VK_TRUE : VK_FALSE}});
}

void Media::setTarget(const MethodTarget& target) {
  for (Slot& slot : slots_) {
    slot.set.writeImage(1, target.color, VK_IMAGE_LAYOUT_GENERAL);
    slot.set.writeImage(2, target.depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    if (samples_ > 1) slot.set.writeImage(3, target.opaque, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  }
}

void Media::setView(const shaders::FrameData& view) {
  list_.setView(view);
  slot_ = (slot_ + 1) % slots_.size();
  std::memcpy(slots_[slot_].buffer.mapped(), list_.table().data(), list_.table().size() * sizeof(shaders::MediaObject));
  Unique<VkPipeline>& pipeline = pipelines_.at(list_.anyNear() ? 1 : 0);
  if (pipeline.get() == VK_NULL_HANDLE) pipeline = makePipeline(list_.anyNear());
}

void Media::cmdResolve(VkCommandBuffer commands, VkDescriptorSet lists, VkExtent2D area) const {
  const std::array<VkDescriptorSet, 2> sets{lists, slots_[slot_].set.set()};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_.at(list_.anyNear() ? 1 : 0).get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0,
                          static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
  vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(shaders::MediaView),
                     &list_.view());
  vkCmdDispatch(commands, shaders::pixelGroups(area.width), shaders::pixelGroups(area.height), 1);
}

} // namespace vitrail::tool
