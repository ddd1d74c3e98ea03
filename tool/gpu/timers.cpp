#include "timers.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "vk.h"

namespace vitrail::tool {

Timers::Timers(Gpu& gpu, std::uint32_t maxPasses) : gpu_(gpu), maxStamps_(maxPasses + 1) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(gpu.physicalDevice(), &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(gpu.physicalDevice(), &count, families.data());
  const std::uint32_t bits = families.at(gpu.queueFamily()).timestampValidBits;
  if (bits == 0) return;
  mask_ = UINT64_MAX >> (64U - bits);

  auto info = vkStruct<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = maxStamps_;
  VkQueryPool pool = VK_NULL_HANDLE;
  check(vkCreateQueryPool(gpu.device(), &info, nullptr, &pool), "vkCreateQueryPool");
  pool_ = {gpu.device(), pool, vkDestroyQueryPool};
  setDebugName(gpu.device(), VK_OBJECT_TYPE_QUERY_POOL, pool, "pass times");
}

void Timers::startFrame() { frame_.clear(); }

void Timers::cmdStart(VkCommandBuffer commands) {
  names_.clear();
  stamps_ = 0;
  if (mask_ == 0) return;
  vkCmdResetQueryPool(commands, pool_.get(), 0, maxStamps_);
  cmdStamp(commands);
}

void Timers::cmdEndPass(VkCommandBuffer commands, const std::string& name) {
  if (mask_ == 0) return;
  if (stamps_ == maxStamps_) throw std::logic_error("more passes than timestamps");
  names_.push_back(name);
  cmdStamp(commands);
}

// Bottom of pipe: when everything before it has ended, so that the passes' times add up to the frame's.
void Timers::cmdStamp(VkCommandBuffer commands) {
  vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT, pool_.get(), stamps_++);
}

void Timers::addSubmission() {
  if (stamps_ == 0) return;
  std::vector<std::uint64_t> ticks(stamps_);
  check(vkGetQueryPoolResults(gpu_.device(), pool_.get(), 0, stamps_, ticks.size() * sizeof(std::uint64_t),
                              ticks.data(), sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT),
        "vkGetQueryPoolResults");
  const double msPerTick = static_cast<double>(gpu_.properties().limits.timestampPeriod) * 1e-6;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    add(names_[i], static_cast<double>((ticks[i + 1] - ticks[i]) & mask_) * msPerTick);
  }
}

void Timers::addHostPass(const std::string& name, double milliseconds) {
  if (mask_ != 0) add(name, milliseconds);
}

void Timers::add(const std::string& name, double milliseconds) {
  const auto known = std::ranges::find(frame_, name, &std::pair<std::string, double>::first);
  if (known == frame_.end()) {
    frame_.emplace_back(name, milliseconds);
  } else {
    known->second += milliseconds;
  }
}

} // namespace vitrail::tool
