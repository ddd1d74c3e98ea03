// What measurements were taken on, and how often a frame is worth drawing there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "../render/device.h"

namespace vitrail::tool {

struct Machine {
  std::string device;
  std::string driver;
  std::string api;
  bool isCpu = false;      // only ratios mean anything
  std::string processor{}; // what draws the method `cpu`
  bool hasDevice = true;   // false: the processor is all there is, and nothing has a ratio

  // A driver draws on the processor, where a frame takes seconds. Our own rasteriser does not.
  bool isSlow() const { return isCpu && hasDevice; }
};

Machine machineOf(const Device& device);

// The number that was asked for, or the machine's default.
std::uint32_t roundsOn(const Machine& machine, std::optional<std::uint32_t> asked);
std::uint32_t warmupsOn(const Machine& machine, std::optional<std::uint32_t> asked);

} // namespace vitrail::tool
