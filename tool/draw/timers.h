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
  // For at most `maxPasses` passes. Where the queue has no timestamps every call does nothing.
  Timers(Gpu& gpu, std::uint32_t maxPasses);

  // Starts a frame. Outside a rendering scope.
  void cmdStart(VkCommandBuffer commands);
  // The pass `name` ends here, and the next one starts. Outside a rendering scope.
  void cmdEndPass(VkCommandBuffer commands, const std::string& name);

  // The passes' milliseconds, in order, once the GPU has executed the frame; empty without timestamps.
  std::vector<std::pair<std::string, double>> milliseconds() const;

 private:
  void cmdStamp(VkCommandBuffer commands);

  Gpu& gpu_;
  std::uint32_t maxStamps_;
  std::uint64_t mask_ = 0; // the bits of a timestamp that count; 0: none
  Unique<VkQueryPool> pool_;
  std::uint32_t stamps_ = 0;
  std::vector<std::string> names_;
};

} // namespace vitrail::tool
