// What one frame tells its shaders.
#pragma once

#include <cstdint>

#include "target_rules.h"
#include "vitrail/layout.h"

namespace vitrail {

// How shaders can reach a pool.
struct PoolAccess {
  std::uint64_t address = 0;   // of its first node; 0: not by address
  bool wholeByBinding = false; // one binding holds all of it
};

// `area` lies inside the target, with at most areaPixels pixels; `info` has its defaults.
layout::VitrailParameters parametersOf(const TargetInfo& info, std::uint32_t nodeCapacity, const PoolAccess& pool,
                                       const VitrailRect& area, std::uint64_t frame);

// The area of a frame for which the host asks for these pixels (an extent of 0: for everything): inside the target, and
// never more than there are head pointers for. Where that leaves something out `whole` becomes false, and the log says
// so.
VitrailRect areaOfFrame(const TargetInfo& info, const Log& log, std::int64_t x, std::int64_t y, std::uint32_t width,
                        std::uint32_t height, bool& whole);

} // namespace vitrail
