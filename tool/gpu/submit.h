// Records commands, submits them and waits for them, at once or later.
#pragma once

#include <functional>
#include <string>

#include "device.h"
#include "unique.h"

namespace vitrail::tool {

class Submitter {
 public:
  explicit Submitter(Gpu& gpu);
  ~Submitter(); // waits for what was submitted
  Submitter(const Submitter&) = delete;
  Submitter& operator=(const Submitter&) = delete;

  // Begins a command buffer, which is recorded until execute(). What was begun before is dropped; what was submitted
  // has been waited for.
  VkCommandBuffer begin();
  // Ends the command buffer, submits it and returns when the GPU has executed it. `what` names the work in errors.
  void execute(const std::string& what);
  // The two halves of it: between them nothing is recorded.
  void submit(const std::string& what);
  void wait(); // nothing where that has been done

  // Both, with `record` in between.
  void run(const std::string& what, const std::function<void(VkCommandBuffer)>& record);

 private:
  Gpu& gpu_;
  Unique<VkCommandPool> pool_;
  Unique<VkFence> fence_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  std::string pending_; // what was submitted and not waited for
};

} // namespace vitrail::tool
