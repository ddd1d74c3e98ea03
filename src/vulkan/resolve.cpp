// The recording call that sorts and blends.
#include <array>
#include <cstddef>

#include "dispatch_compute.h"

namespace vitrail {

namespace {

void resolveByCompute(VkCommandBuffer commandBuffer, VitrailTarget_T& target, std::uint32_t view) {
  const ResolvePipelines& pipelines = target.pipelines;
  bindTargetSet(commandBuffer, target);
  bindViewSet(commandBuffer, target, view);
  dispatchIndirect(commandBuffer, target, pipelines.shortLists, offsetof(layout::VitrailControl, pixelGroupsX));
  if (pipelines.plain != VK_NULL_HANDLE) { // instead: no barrier
    dispatchIndirect(commandBuffer, target, pipelines.plain, offsetof(layout::VitrailControl, plainGroupsX));
  }
  const auto next = [&](VkPipeline pipeline, std::size_t counter) {
    if (pipeline == VK_NULL_HANDLE) return;
    betweenDispatches(commandBuffer, target);
    dispatchIndirect(commandBuffer, target, pipeline, counter);
  };
  next(pipelines.mediumLists, classGroups(VITRAIL_CLASS_MEDIUM));
  next(pipelines.longLists, classGroups(VITRAIL_CLASS_LONG));
  next(pipelines.longestLists, classGroups(VITRAIL_CLASS_LONGEST));
  next(pipelines.overflow, offsetof(layout::VitrailControl, overflowGroupsX));
  target.storage.sumsAreClear = true;
}

void resolveByFragments(VkCommandBuffer commandBuffer, const VitrailTarget_T& target, std::uint32_t view) {
  const VitrailContext_T& context = *target.context;
  const VkRect2D area = target.area;
  const VkViewport viewport{static_cast<float>(area.offset.x),
                            static_cast<float>(area.offset.y),
                            static_cast<float>(area.extent.width),
                            static_cast<float>(area.extent.height),
                            0.0F,
                            1.0F};
  const bool hasView = view < target.storage.viewCount;
  const std::array<VkDescriptorSet, 2> sets = {target.storage.set,
                                               hasView ? target.storage.viewSets[view] : VK_NULL_HANDLE};
  context.vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, context.resolveLayout, 0,
                                   hasView ? 2 : 1, sets.data(), 0, nullptr);
  context.vk.CmdSetViewport(commandBuffer, 0, 1, &viewport);
  context.vk.CmdSetScissor(commandBuffer, 0, 1, &area);
  const auto draw = [&](VkPipeline pipeline, std::size_t arguments) {
    if (pipeline == VK_NULL_HANDLE) return;
    context.vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    const Storage& storage = target.storage;
    context.vk.CmdDrawIndirect(commandBuffer, storage.buffer,
                               storage.offset + storage.layout.control.offset + arguments, 1, 0);
  };
  draw(target.pipelines.fragment, offsetof(layout::VitrailControl, drawVertices));
  draw(target.pipelines.fragmentPlain, offsetof(layout::VitrailControl, plainVertices));
}

} // namespace

} // namespace vitrail

extern "C" void vitrailCmdResolve(VkCommandBuffer commandBuffer, VitrailTarget target, const VitrailResolveInfo* info) {
  if (target->area.extent.width == 0) return;
  std::uint32_t view = info != nullptr ? info->view : 0;
  if (view != 0 && view >= target->storage.viewCount) {
    static_cast<void>(target->context->log.fail(VK_ERROR_INITIALIZATION_FAILED,
                                                "view %u is resolved, the target has %u: view 0 is taken", view,
                                                target->storage.viewCount));
    view = 0;
  }
  if (target->isCompute()) {
    vitrail::resolveByCompute(commandBuffer, *target, view);
  } else {
    vitrail::resolveByFragments(commandBuffer, *target, view);
  }
}
