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

  // Begins a command buffer, which is recorded until execute(). What was begun before is dropped.
  VkCommandBuffer begin();
  // Ends the command buffer, submits it and returns when the GPU has executed it. `what` names the work in errors.
  void execute(const std::string& what);

  // Both, with `record` in between.
  void run(const std::string& what, const std::function<void(VkCommandBuffer)>& record);

 private:
  Gpu& gpu_;
  Unique<VkCommandPool> pool_;
  Unique<VkFence> fence_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

} // namespace vitrail::tool
