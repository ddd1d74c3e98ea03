// What measurements were taken on, and how often a frame is worth drawing there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "../gpu/device.h"

namespace vitrail::tool {

struct Machine {
  std::string device;
  std::string driver;
  std::string api;
  bool isCpu = false; // only ratios mean anything
};

Machine machineOf(const Gpu& gpu);

// The number that was asked for, or the machine's default.
std::uint32_t roundsOn(const Machine& machine, std::optional<std::uint32_t> asked);
std::uint32_t warmupsOn(const Machine& machine, std::optional<std::uint32_t> asked);

} // namespace vitrail::tool
