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
  std::vector<std::string> methods;
  std::vector<VitrailNodeFormat> nodes = {VITRAIL_NODE_STANDARD};
  std::vector<std::uint32_t> samples = {1};
  std::vector<VitrailResolve> resolves = {VITRAIL_RESOLVE_DEFAULT};
};

// The settings that the choices stand for, by sample count, the baseline of each count first, whether or not it was
// chosen. Choices that a method does not have (MethodTraits) are left out: unsorted and insertion have one node format
// and one resolve of their own, insertion one sample, and compact nodes no room for 8 samples. Nothing is listed twice.
std::vector<MethodOptions> configurationsOf(const BenchMatrix& matrix);

// A setting in words, for people: "linked-list, compact, 4 samples, compute".
std::string describe(const MethodOptions& options);

} // namespace vitrail::tool
