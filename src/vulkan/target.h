// The buffers and descriptor sets of one view.
#pragma once

#include <array>
#include <cstdint>

#include "buffer.h"
#include "context.h"
#include "vitrail/layout.h"
#include "vitrail/vitrail.h"

namespace vitrail {

// What the GPU leaves behind for vitrailReadStats. The tag is 0 from the start of a frame until its counters are there:
// a slot whose tag is right, before and after the counters are read, is whole.
struct StatsSlot {
  layout::VitrailControl control;
  std::uint64_t tag; // frame + 1, so that a slot never written names no frame
};
static_assert(sizeof(StatsSlot) == 48);

} // namespace vitrail

struct VitrailTarget_T {
  VitrailContext context = nullptr;
  VkExtent2D extent{};
  std::uint32_t capacity = 0;
  std::uint32_t framesInFlight = 0;
  std::uint64_t frame = 0;           // the frame being recorded
  vitrail::ResolvePipelines resolve; // the context's
  vitrail::Buffer parameters;
  vitrail::Buffer control;
  vitrail::Buffer heads;
  vitrail::Buffer nodes;     // empty where the host brought its own
  vitrail::Buffer longLists; // pixel numbers that the first resolve dispatch leaves to the second
  vitrail::Buffer stats;     // StatsSlot[framesInFlight]
  VkBuffer nodeBuffer = VK_NULL_HANDLE;
  VkDeviceSize nodeOffset = 0;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  std::uint32_t colorViewCount = 0;
  std::array<VkDescriptorSet, VITRAIL_MAX_COLOR_VIEWS> colorSets{};

  [[nodiscard]] VkDeviceSize slotOffset(std::uint64_t ofFrame) const {
    return (ofFrame % framesInFlight) * sizeof(vitrail::StatsSlot);
  }
};
