// Which method to use on a device, and why, from what was measured there and nothing else.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../bench/measurement.h"

namespace vitrail::tool {

struct Advice {
  std::optional<SweepKind> sweep; // none: of scenes that are in no sweep
  std::string need;               // what the advice is for: "Exact", "Approximate will do", "Little memory"
  std::string text;               // one sentence or more, with their numbers
};

// The steps of each sweep, and the other scenes, are gone through in their order; of each counts what has the fewest
// samples. By need:
//   exact         the cheapest setting of the methods that are exact in every frame (with nothing wrong in
//                 MethodTraits); one that was exact in these frames alone is named after it, where it costs less, and
//                 in its place only where no other was exact
//   approximate   the cheapest order-independent one (MethodTraits), exact or not; where that is one that is exact in
//                 every frame, nothing approximate is worth its errors
//   memory        the exact one that keeps the fewest bytes on the device, where the cheapest one keeps over a tenth
//   more
// A setting counts as cheap as the cheapest one where the interquartile ranges of their costs meet or its cost is
// within a twentieth. Of those the one is named that stays among the cheapest for the most steps, so that noise does
// not change the advice from step to step. Times are told of GPUs alone.
std::vector<Advice> recommend(const BenchReport& report);

// The scenes of one sweep, or those in none, in order.
std::vector<const SceneMeasurement*> scenesOf(const BenchReport& report, std::optional<SweepKind> sweep);

// The sweeps that a report has, in the order of its scenes; nothing stands for scenes in no sweep.
std::vector<std::optional<SweepKind>> sweepsOf(const BenchReport& report);

} // namespace vitrail::tool
