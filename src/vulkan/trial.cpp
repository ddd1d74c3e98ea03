// vulkan_trial.h: time stamps around a host's frames. Which way is the fastest is the core's to say (core/trial.h).
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "buffer.h"
#include "check.h"
#include "core/trial.h"
#include "vitrail/vulkan_trial.h"

namespace vitrail {

static_assert(VITRAIL_VK_MAX_WAYS == kMostWays);

constexpr std::uint32_t kTrialSlots = 64; // frames in flight
constexpr std::uint32_t kMostFrames = 1000;

// Where the GPU leaves a frame's time stamps.
struct TrialSlot {
  std::array<std::uint64_t, 2> times{};
  std::uint64_t tag = 0; // of the frame that left them: written last
};

// A frame that was recorded; tag 0: none, or it was looked at.
struct TrialFrame {
  std::uint64_t tag = 0;
  std::uint32_t way = 0;
};

} // namespace vitrail

struct VitrailVkTrial_T {
  explicit VitrailVkTrial_T(const VitrailVkTrialDesc& desc)
      : trial(desc.ways, desc.warmUps != 0 ? desc.warmUps : 4, desc.rounds != 0 ? desc.rounds : 9),
        version(desc.version),
        debugName(desc.debugName != nullptr ? desc.debugName : "vitrail trial") {}

  VitrailVkContext context = nullptr;
  vitrail::Trial trial;
  std::uint64_t device = 0; // which it is
  std::uint64_t version;
  std::string debugName;
  double millisecondsPerTick = 0.0;
  std::uint64_t validBits = 0;
  VkQueryPool queries = VK_NULL_HANDLE; // two a slot
  vitrail::Buffer slots;
  std::array<vitrail::TrialFrame, vitrail::kTrialSlots> frames{};
  std::uint64_t newest = 0; // tag
  bool isOpen = false;      // a frame has begun
};

namespace vitrail {

namespace {

std::uint64_t deviceOf(const VkPhysicalDeviceProperties& device) {
  struct Identity {
    std::array<std::uint32_t, 3> numbers;
    std::array<unsigned char, VK_UUID_SIZE> cache; // changes with the driver, too
  } identity{{device.vendorID, device.deviceID, device.driverVersion}, {}};
  std::copy(std::begin(device.pipelineCacheUUID), std::end(device.pipelineCacheUUID), identity.cache.begin());
  std::array<unsigned char, sizeof(identity)> bytes{};
  std::memcpy(bytes.data(), &identity, bytes.size());
  return hashOf(bytes);
}

VkResult checkTrial(const Log& log, const VitrailVkTrialDesc& desc) {
  const VkResult result = checkNext(log, desc.next, "VitrailVkTrialDesc");
  if (result != VK_SUCCESS) return result;
  if (desc.ways < 2 || desc.ways > kMostWays) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "ways %u: a trial has 2 to %u", desc.ways, kMostWays);
  }
  const auto isTooMany = [&](const char* field, std::uint32_t frames) {
    if (frames > kMostFrames) log.error("%s %u: %u is the most", field, frames, kMostFrames);
    return frames > kMostFrames;
  };
  if (isTooMany("warmUps", desc.warmUps) || isTooMany("rounds", desc.rounds)) return VK_ERROR_INITIALIZATION_FAILED;
  if (desc.memory == nullptr && desc.memorySize > 0) {
    return log.fail(VK_ERROR_INITIALIZATION_FAILED, "memorySize %llu without memory",
                    static_cast<unsigned long long>(desc.memorySize));
  }
  return VK_SUCCESS;
}

// What the queue family's time stamps are like.
VkResult findClock(VitrailVkTrial_T& trial, const VkPhysicalDeviceProperties& device, std::uint32_t family) {
  const VitrailVkContext_T& context = *trial.context;
  std::uint32_t count = 0;
  context.vk.GetPhysicalDeviceQueueFamilyProperties(context.physicalDevice, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  context.vk.GetPhysicalDeviceQueueFamilyProperties(context.physicalDevice, &count, families.data());
  if (family >= count) {
    return context.log.fail(VK_ERROR_INITIALIZATION_FAILED, "queueFamily %u: %s has %u", family, device.deviceName,
                            count);
  }
  const VkQueueFamilyProperties& found = families[family];
  if ((found.queueFlags & (VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT)) == 0) {
    return context.log.fail(VK_ERROR_INITIALIZATION_FAILED, "queueFamily %u neither draws nor computes", family);
  }
  const std::uint32_t bits = found.timestampValidBits;
  if (bits == 0) {
    return context.log.fail(VK_ERROR_FEATURE_NOT_PRESENT,
                            "queueFamily %u of %s has no time stamps: measure by the host's clock", family,
                            device.deviceName);
  }
  trial.validBits = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  trial.millisecondsPerTick = 1e-6 * static_cast<double>(device.limits.timestampPeriod);
  return VK_SUCCESS;
}

VkResult createQueries(VitrailVkTrial_T& trial) {
  const VitrailVkContext_T& context = *trial.context;
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = 2 * kTrialSlots;
  const VkResult result = context.vk.CreateQueryPool(context.device, &info, context.allocator, &trial.queries);
  if (result != VK_SUCCESS) return context.log.fail(result, "%s: no query pool", trial.debugName.c_str());
  context.name(VK_OBJECT_TYPE_QUERY_POOL, trial.queries, trial.debugName.c_str());
  constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  const VkResult made = trial.slots.create(context, kTrialSlots * sizeof(TrialSlot), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                           kHost, VK_MEMORY_PROPERTY_HOST_CACHED_BIT, trial.debugName.c_str(), "times");
  if (made != VK_SUCCESS) return made;
  std::fill_n(static_cast<TrialSlot*>(trial.slots.mapped), kTrialSlots, TrialSlot{});
  return VK_SUCCESS;
}

VkResult build(VitrailVkTrial_T& trial, const VitrailVkTrialDesc& desc) {
  const VitrailVkContext_T& context = *trial.context;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  context.vk.GetPhysicalDeviceProperties2(context.physicalDevice, &properties);
  trial.device = deviceOf(properties.properties);
  const auto* const memory = static_cast<const unsigned char*>(desc.memory);
  if (desc.memorySize > 0 && trial.trial.remember({memory, desc.memorySize}, trial.device, trial.version)) {
    return VK_SUCCESS;
  }
  const VkResult result = findClock(trial, properties.properties, desc.queueFamily);
  return result == VK_SUCCESS ? createQueries(trial) : result;
}

// Takes the times of frames that have finished.
void follow(VitrailVkTrial_T& trial) {
  if (trial.trial.isOver()) return;
  for (std::uint32_t i = 1; i <= kTrialSlots; ++i) { // the oldest first
    TrialFrame& frame = trial.frames[(trial.newest + i) % kTrialSlots];
    if (frame.tag == 0) continue;
    TrialSlot& slot = static_cast<TrialSlot*>(trial.slots.mapped)[frame.tag % kTrialSlots];
    const std::atomic_ref<std::uint64_t> written(slot.tag);
    if (written.load(std::memory_order_acquire) != frame.tag) continue;
    const std::uint64_t ticks = (slot.times[1] - slot.times[0]) & trial.validBits;
    trial.trial.take(frame.way, static_cast<double>(ticks) * trial.millisecondsPerTick);
    frame.tag = 0;
  }
}

} // namespace

} // namespace vitrail

extern "C" VkResult vitrailVkCreateTrial(VitrailVkContext context, const VitrailVkTrialDesc* desc,
                                         VitrailVkTrial* trial) {
  using namespace vitrail;
  if (trial != nullptr) *trial = nullptr;
  if (context == nullptr || desc == nullptr || trial == nullptr) return nullArgument(context, "vitrailVkCreateTrial");
  if (context->destroyed) {
    return context->log.fail(VK_ERROR_INITIALIZATION_FAILED, "vitrailVkCreateTrial: the context was destroyed");
  }
  VkResult result = checkTrial(context->log, *desc);
  if (result != VK_SUCCESS) return result;
  VitrailVkTrial_T* made = nullptr;
  try {
    made = new VitrailVkTrial_T(*desc);
    made->context = context;
    ++context->owners;
    result = build(*made, *desc);
  } catch (const std::bad_alloc&) {
    result = context->log.fail(VK_ERROR_OUT_OF_HOST_MEMORY, "no memory for a trial");
  }
  if (result != VK_SUCCESS) {
    vitrailVkDestroyTrial(made);
    return result; // the log has the reason
  }
  *trial = made;
  return VK_SUCCESS;
}

extern "C" void vitrailVkDestroyTrial(VitrailVkTrial trial) {
  if (trial == nullptr) return;
  const std::unique_ptr<VitrailVkTrial_T> owned(trial);
  const VitrailVkContext_T& context = *trial->context;
  context.vk.DestroyQueryPool(context.device, trial->queries, context.allocator);
  trial->slots.destroy(context);
  vitrail::releaseContext(trial->context);
}

extern "C" uint32_t vitrailVkTrialWay(VitrailVkTrial trial) {
  if (trial == nullptr) return 0;
  vitrail::follow(*trial);
  return trial->trial.next();
}

extern "C" void vitrailVkCmdTrialBegin(VkCommandBuffer commandBuffer, VitrailVkTrial trial, uint32_t way) {
  using namespace vitrail;
  if (trial == nullptr) return;
  const Log& log = trial->context->log;
  if (commandBuffer == VK_NULL_HANDLE) return log.error("vitrailVkCmdTrialBegin: commandBuffer is null");
  if (way >= trial->trial.ways()) {
    return log.error("vitrailVkCmdTrialBegin: way %u of %u, which are counted from 0", way, trial->trial.ways());
  }
  if (trial->isOpen) { // perhaps in a command buffer that was dropped
    log.warn("vitrailVkCmdTrialBegin: the frame before has no vitrailVkCmdTrialEnd, and does not count");
    trial->isOpen = false;
  }
  if (trial->trial.isOver()) return;
  trial->isOpen = true;
  ++trial->newest;
  const auto slot = static_cast<std::uint32_t>(trial->newest % kTrialSlots);
  trial->frames.at(slot) = {0, way}; // not to be looked for before its end
  const Functions& vk = trial->context->vk;
  vk.CmdResetQueryPool(commandBuffer, trial->queries, 2 * slot, 2);
  vk.CmdWriteTimestamp(commandBuffer, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, trial->queries, 2 * slot);
}

extern "C" void vitrailVkCmdTrialEnd(VkCommandBuffer commandBuffer, VitrailVkTrial trial) {
  using namespace vitrail;
  if (trial == nullptr) return;
  const Log& log = trial->context->log;
  if (commandBuffer == VK_NULL_HANDLE) return log.error("vitrailVkCmdTrialEnd: commandBuffer is null");
  if (!trial->isOpen) {
    if (!trial->trial.isOver()) log.error("vitrailVkCmdTrialEnd: no vitrailVkCmdTrialBegin before it");
    return;
  }
  trial->isOpen = false;
  const auto slot = static_cast<std::uint32_t>(trial->newest % kTrialSlots);
  TrialFrame& frame = trial->frames.at(slot);
  frame.tag = trial->newest;
  trial->trial.record(frame.way);
  const Functions& vk = trial->context->vk;
  const auto barrier = [&](VkPipelineStageFlags to, VkAccessFlags used) {
    VkMemoryBarrier memory{};
    memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    memory.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    memory.dstAccessMask = used;
    vk.CmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_TRANSFER_BIT, to, 0, 1, &memory, 0, nullptr, 0, nullptr);
  };
  const VkDeviceSize at = slot * sizeof(TrialSlot);
  vk.CmdWriteTimestamp(commandBuffer, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, trial->queries, 2 * slot + 1);
  // The frame that had the slot before wrote it, if it was submitted.
  barrier(VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
  vk.CmdCopyQueryPoolResults(commandBuffer, trial->queries, 2 * slot, 2, trial->slots.buffer,
                             at + offsetof(TrialSlot, times), sizeof(std::uint64_t),
                             VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
  // The times are there before the tag says so.
  barrier(VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_HOST_BIT,
          VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT);
  vk.CmdUpdateBuffer(commandBuffer, trial->slots.buffer, at + offsetof(TrialSlot, tag), sizeof(frame.tag), &frame.tag);
  barrier(VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}

extern "C" VkResult vitrailVkReadTrial(VitrailVkTrial trial, VitrailVkTrialResult* result) {
  using namespace vitrail;
  if (result != nullptr) clearKeepingNext(*result);
  if (trial == nullptr || result == nullptr) {
    return nullArgument(trial != nullptr ? trial->context : nullptr, "vitrailVkReadTrial");
  }
  follow(*trial);
  const Trial& of = trial->trial;
  result->fastest = of.fastest();
  result->remembered = of.isRemembered() ? VK_TRUE : VK_FALSE;
  for (std::uint32_t way = 0; way < of.ways(); ++way) {
    result->rounds[way] = of.measured(way);
    result->milliseconds[way] = of.milliseconds(way);
  }
  return of.isOver() ? VK_SUCCESS : VK_NOT_READY;
}

extern "C" VkResult vitrailVkTrialMemory(VitrailVkTrial trial, size_t* size, void* data) {
  using namespace vitrail;
  const std::size_t room = size != nullptr ? *size : 0;
  if (size != nullptr) *size = 0;
  if (trial == nullptr || size == nullptr) {
    return nullArgument(trial != nullptr ? trial->context : nullptr, "vitrailVkTrialMemory");
  }
  follow(*trial);
  if (!trial->trial.isOver()) return VK_NOT_READY;
  const TrialMemory memory = trial->trial.memory(trial->device, trial->version);
  if (data != nullptr && room < sizeof(memory)) return VK_INCOMPLETE;
  if (data != nullptr) std::memcpy(data, &memory, sizeof(memory));
  *size = sizeof(memory);
  return VK_SUCCESS;
}
