// One view: its memory now, the memory that frames in flight still use, and how it is resolved.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "buffer.h"
#include "context.h"
#include "pipelines.h"
#include "storage.h"
#include "vitrail/layout.h"
#include "vitrail/vitrail.h"

namespace vitrail {

// What the GPU leaves behind for vitrailReadStats. The tag is 0 from the start of a frame until its counters are there:
// a slot whose tag is right, before and after the counters are read, is whole.
struct StatsSlot {
  layout::VitrailControl control;
  std::uint32_t nodeCapacity; // of the pool that the frame used
  std::uint32_t sumsCleared;  // VitrailTarget_T::sumsCleared of the frame; read without the tag
  std::uint64_t tag;          // frame + 1, so that a slot never written names no frame
};
static_assert(sizeof(StatsSlot) == 224);

// The pipelines of a target, from building lists to the resolve; null where its kind does not need one.
struct ResolvePipelines {
  VkPipeline prepare = VK_NULL_HANDLE;
  VkPipeline buildLists = VK_NULL_HANDLE;
  VkPipeline shortLists = VK_NULL_HANDLE;
  VkPipeline plain = VK_NULL_HANDLE;
  VkPipeline mediumLists = VK_NULL_HANDLE;
  VkPipeline longLists = VK_NULL_HANDLE;
  VkPipeline longestLists = VK_NULL_HANDLE;
  VkPipeline overflow = VK_NULL_HANDLE;
  VkPipeline sortFind = VK_NULL_HANDLE;
  VkPipeline sortLong = VK_NULL_HANDLE;
  VkPipeline clearSums = VK_NULL_HANDLE;
  VkPipeline fragment = VK_NULL_HANDLE; // the target's own, as the next one
  VkPipeline fragmentPlain = VK_NULL_HANDLE;
};

// Memory that frames up to `lastFrame` use.
struct Retired {
  Storage storage;
  std::uint64_t lastFrame = 0;
};

// What recent frames needed, for vitrailUpdateTarget.
struct Demand {
  std::uint64_t newestFrame = 0; // that was looked at, + 1
  std::uint32_t lowFrames = 0;   // in a row that needed less than a quarter of the pool
  std::uint64_t lowMost = 0;     // the most that any of those needed
};

} // namespace vitrail

struct VitrailTarget_T {
  VitrailContext context = nullptr;
  // As given, with defaults filled in; of its pointers only those of views are of use: they point to the arrays below.
  VitrailTargetDesc desc{};
  std::string debugName;
  bool keepSums = false;
  vitrail::Specialization constants;
  vitrail::ResolvePipelines pipelines;
  vitrail::Storage storage;
  std::vector<vitrail::Retired> retired;
  // The host's views, for when the memory changes and the images do not.
  std::array<VkImageView, VITRAIL_MAX_COLOR_VIEWS> colorViews{};
  std::array<VkImageView, VITRAIL_MAX_COLOR_VIEWS> opaqueViews{};
  std::array<VkImageView, VITRAIL_MAX_COLOR_VIEWS> depthViews{};
  vitrail::Buffer stats; // StatsSlot[framesInFlight]
  // The number of the clear that the sums need, from 1. Frames record it until one of them is seen to have run: one
  // that was recorded may never be submitted. Frames that ran leave the sums clear.
  std::uint32_t sumsCleared = 0;
  vitrail::Demand demand;
  std::uint64_t frame = 0; // the one being recorded
  VkRect2D area{};         // of that frame

  [[nodiscard]] bool isCompute() const { return desc.resolve == VITRAIL_RESOLVE_COMPUTE; }
  [[nodiscard]] std::uint32_t slot(std::uint64_t ofFrame) const {
    return static_cast<std::uint32_t>(ofFrame % desc.framesInFlight);
  }
  [[nodiscard]] VkDeviceSize slotOffset(std::uint64_t ofFrame) const {
    return slot(ofFrame) * sizeof(vitrail::StatsSlot);
  }
};

namespace vitrail {

// Memory for the target as it is, with another pool.
StorageInfo storageInfo(const VitrailTarget_T& target, std::uint32_t nodeCapacity);

// Gives the target other memory from `frame` on; frames before it keep theirs. On error nothing changes.
VkResult replaceStorage(VitrailTarget_T& target, const StorageInfo& info, std::uint64_t frame);

// Frees what only frames used that have finished when `frame` is recorded.
void freeRetired(VitrailTarget_T& target, std::uint64_t frame);

} // namespace vitrail
