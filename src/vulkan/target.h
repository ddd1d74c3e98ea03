// One view: its memory now, the memory that frames in flight still use, and how it is resolved.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "buffer.h"
#include "context.h"
#include "core/call_order.h"
#include "core/frame_numbers.h"
#include "core/frame_plan.h"
#include "core/growth.h"
#include "core/statistics.h"
#include "core/sums_clear.h"
#include "pipelines.h"
#include "storage.h"
#include "vitrail/vulkan.h"

struct VitrailVkTarget_T {
  VitrailVkContext context = nullptr; // which the target owns a share of
  vitrail::TargetInfo info;           // with its defaults
  VkFormat colorFormat = VK_FORMAT_UNDEFINED;
  VitrailVkScope scope{};
  bool hostBarriers = false;
  VkBuffer hostBuffer = VK_NULL_HANDLE; // where the host brought the memory
  std::string debugName;
  // The host's views, for when the memory changes and the images do not; `views` points to the arrays.
  VitrailVkViews views{};
  std::array<VkImageView, VITRAIL_MAX_VIEWS> colorViews{};
  std::array<VkImageView, VITRAIL_MAX_VIEWS> opaqueViews{};
  std::array<VkImageView, VITRAIL_MAX_VIEWS> depthViews{};

  vitrail::Specialization constants;
  vitrail::FramePlan plan;
  std::vector<VkPipeline> pipelines;         // of each of the plan's passes; null where a pass has none
  std::vector<VkPipeline> graphicsPipelines; // of those the target's own; the others are the context's

  vitrail::Storage storage;
  std::vector<vitrail::Storage> retired; // that frames in flight use
  vitrail::Buffer stats;                 // StatsSlot[statisticsSlots()]
  vitrail::Growth growth;
  vitrail::SumsClear sums;

  // The frame that is being recorded.
  vitrail::FrameNumbers frames;
  vitrail::CallOrder order;
  VitrailRect area{};

  [[nodiscard]] std::span<vitrail::StatsSlot> slots() const {
    return {static_cast<vitrail::StatsSlot*>(stats.mapped), vitrail::statisticsSlots(info.framesInFlight)};
  }
  [[nodiscard]] std::size_t slotOf(std::uint64_t frame) const { return frame % slots().size(); }
  [[nodiscard]] VkDeviceSize slotOffset() const { return slotOf(frames.newest()) * sizeof(vitrail::StatsSlot); }
};

namespace vitrail {

// Makes everything that a target needs but its memory: plan, pipelines, statistics. Logs its errors.
VkResult buildTarget(VitrailVkTarget_T& target);

// Memory for the target with these needs and views. On error nothing changes.
VkResult replaceStorage(VitrailVkTarget_T& target, const StorageNeeds& needs, const VitrailVkViews& views);

// Keeps copies of what the host gave.
void keepViews(VitrailVkTarget_T& target, const VitrailVkViews& views);

// Frees memory that only frames used that have finished when the frame at that place (FrameNumbers) is recorded.
void freeRetired(VitrailVkTarget_T& target, std::uint64_t place);

} // namespace vitrail
