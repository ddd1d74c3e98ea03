// The reduction that measures the depth complexity (complexity_reduce.comp), step by step, and what its result says. No
// graphics API.
#pragma once

#include <cstdint>
#include <vector>

#include "../frame_stats.h"
#include "complexity_shared.h"

namespace vitrail::tool {

// The results of all steps over so many pixels: shaders::Complexity each, the last one first.
std::uint64_t complexityParts(std::uint32_t pixels);

// A step: its constants, and the work groups of its dispatch.
struct ComplexityStep {
  shaders::ComplexityReduction constants;
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
};

// All steps over a picture. `source` is what the first one reads; of each pixel `nearest` surfaces are kept, 0: all.
std::vector<ComplexityStep> complexitySteps(std::uint32_t width, std::uint32_t height, std::uint32_t source,
                                            std::uint32_t nearest);

// What was counted; exact where no surface is left out.
FrameStats complexityStats(const shaders::Complexity& measured);

} // namespace vitrail::tool
