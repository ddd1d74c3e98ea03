// Records commands, submits them and waits for them.
#pragma once

#include <functional>
#include <string>

#include "device.h"
#include "unique.h"

namespace vitrail::tool {

class Submitter {
 public:
  explicit Submitter(Gpu& gpu);

  // Calls `record` with a command buffer and returns when the GPU has executed it. `what` names the work in errors.
  void run(const std::string& what, const std::function<void(VkCommandBuffer)>& record);

 private:
  Gpu& gpu_;
  Unique<VkCommandPool> pool_;
  Unique<VkFence> fence_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

} // namespace vitrail::tool
