#include "submit.h"

#include <cstdint>
#include <utility>

#include "vk.h"

namespace vitrail::tool {

Submitter::Submitter(Gpu& gpu) : gpu_(gpu) {
  auto poolInfo = vkStruct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
  poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  poolInfo.queueFamilyIndex = gpu.queueFamily();
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(gpu.device(), &poolInfo, nullptr, &pool), "vkCreateCommandPool");
  pool_ = {gpu.device(), pool, vkDestroyCommandPool};
  setDebugName(gpu.device(), VK_OBJECT_TYPE_COMMAND_POOL, pool, "commands");

  auto bufferInfo = vkStruct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
  bufferInfo.commandPool = pool;
  bufferInfo.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  bufferInfo.commandBufferCount = 1;
  check(vkAllocateCommandBuffers(gpu.device(), &bufferInfo, &commands_), "vkAllocateCommandBuffers");
  setDebugName(gpu.device(), VK_OBJECT_TYPE_COMMAND_BUFFER, commands_, "commands");

  const auto fenceInfo = vkStruct<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
  VkFence fence = VK_NULL_HANDLE;
  check(vkCreateFence(gpu.device(), &fenceInfo, nullptr, &fence), "vkCreateFence");
  fence_ = {gpu.device(), fence, vkDestroyFence};
  setDebugName(gpu.device(), VK_OBJECT_TYPE_FENCE, fence, "commands executed");
}

Submitter::~Submitter() {
  const VkFence fence = fence_.get();
  if (!pending_.empty()) vkWaitForFences(gpu_.device(), 1, &fence, VK_TRUE, UINT64_MAX);
}

VkCommandBuffer Submitter::begin() {
  check(vkResetCommandPool(gpu_.device(), pool_.get(), 0), "vkResetCommandPool");
  auto begin = vkStruct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
  return commands_;
}

void Submitter::execute(const std::string& what) {
  submit(what);
  wait();
}

void Submitter::submit(const std::string& what) {
  check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer (" + what + ")");

  auto commandInfo = vkStruct<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
  commandInfo.commandBuffer = commands_;
  auto submit = vkStruct<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
  submit.commandBufferInfoCount = 1;
  submit.pCommandBufferInfos = &commandInfo;
  check(gpu_.submit(submit, fence_.get()), "vkQueueSubmit2 (" + what + ")");
  pending_ = what;
}

void Submitter::wait() {
  if (pending_.empty()) return;
  const VkFence fence = fence_.get();
  const std::string what = std::exchange(pending_, {});
  check(vkWaitForFences(gpu_.device(), 1, &fence, VK_TRUE, UINT64_MAX), "vkWaitForFences (" + what + ")");
  check(vkResetFences(gpu_.device(), 1, &fence), "vkResetFences");
}

void Submitter::run(const std::string& what, const std::function<void(VkCommandBuffer)>& record) {
  record(begin());
  execute(what);
}

} // namespace vitrail::tool
