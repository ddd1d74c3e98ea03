// Which method settings a benchmark compares.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "../methods/method_options.h"

namespace vitrail::tool {

// Unordered hardware blending: what every cost is compared with.
inline constexpr std::string_view kBaselineMethod = "unsorted";

// The choices of each kind, every one of which is measured with every one of the others.
struct BenchMatrix {
  std::vector<std::string> methods; // none: all of methodNames()
  std::vector<VitrailNodeFormat> nodes = {VITRAIL_NODE_STANDARD};
  std::vector<std::uint32_t> samples = {1};
  std::vector<VitrailResolve> resolves = {VITRAIL_RESOLVE_DEFAULT};
};

// A setting that the options or the device do not allow, and why.
struct SkippedSetting {
  MethodOptions options;
  std::string reason;
};

struct BenchSettings {
  std::vector<MethodOptions> measured;
  std::vector<SkippedSetting> skipped;
};

// The settings that the choices stand for, by sample count, the baseline of each count first, whether or not it was
// chosen. A method that has no choice of nodes and of resolves (MethodTraits) is listed once a sample count. What
// checkMethodOptions() refuses, such as several samples of a method that has one, is skipped. Nothing is listed twice.
BenchSettings configurationsOf(const BenchMatrix& matrix);

// A setting in words, for people: "linked-list, compact, 4 samples, compute".
std::string describe(const MethodOptions& options);

} // namespace vitrail::tool
