// GPU timestamps between the passes of a frame.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "device.h"
#include "unique.h"

namespace vitrail::tool {

class Timers {
 public:
  // For at most `maxPasses` passes in a submission. Where the queue has no timestamps every call does nothing.
  Timers(Gpu& gpu, std::uint32_t maxPasses);

  // Starts a frame, whose passes may come in several submissions.
  void startFrame();
  // Starts a submission. Outside a rendering scope.
  void cmdStart(VkCommandBuffer commands);
  // The pass `name` ends here, and the next one starts. Outside a rendering scope.
  void cmdEndPass(VkCommandBuffer commands, const std::string& name);
  // Adds milliseconds that the host worked on the frame for while the GPU had nothing to do.
  void addHostPass(const std::string& name, double milliseconds);
  // Adds the submission's passes to the frame's, once the GPU has executed it. A pass that comes again is summed.
  void addSubmission();

  // The frame's passes in milliseconds, in the order in which they came first; empty without timestamps.
  const std::vector<std::pair<std::string, double>>& milliseconds() const { return frame_; }

 private:
  void add(const std::string& name, double milliseconds);
  void cmdStamp(VkCommandBuffer commands);

  Gpu& gpu_;
  std::uint32_t maxStamps_;
  std::uint64_t mask_ = 0; // the bits of a timestamp that count; 0: none
  Unique<VkQueryPool> pool_;
  std::uint32_t stamps_ = 0;
  std::vector<std::string> names_; // of the submission's passes
  std::vector<std::pair<std::string, double>> frame_;
};

} // namespace vitrail::tool
