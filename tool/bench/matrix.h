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

// What is said of all methods that have such an option (MethodTraits), and of no other.
struct MethodLimits {
  std::uint32_t layers = 0; // --layers; 0: the method's own
  std::uint32_t passes = 0; // --passes
};

// The options of a method with the limits that it has.
MethodOptions withLimits(MethodOptions options, const MethodLimits& limits);

// Throws std::invalid_argument where a limit is of none of the methods. None named: all of methodNames().
void checkLimits(const std::vector<std::string>& methods, const MethodLimits& limits);

// A line that says which limits there are; empty where there is none.
std::string describe(const MethodLimits& limits);

// The choices of each kind, every one of which is measured with every one of the others.
struct BenchMatrix {
  std::vector<std::string> methods;      // none: all of methodNames()
  std::vector<Api> apis = {Api::Vulkan}; // with the methods that each has, where none are named
  std::vector<VitrailNodeFormat> nodes = {VITRAIL_NODE_HDR};
  std::vector<std::uint32_t> samples = {1};
  std::vector<VitrailResolve> resolves = {VITRAIL_RESOLVE_DEFAULT};
  std::vector<VitrailListBuild> listBuilds = {VITRAIL_LIST_BUILD_DEFAULT};
  std::vector<VitrailMsaaResolve> msaaResolves = {VITRAIL_MSAA_RESOLVE_PER_PIXEL};
  std::vector<StencilMark> stencilMarks = {StencilMark::On};
  std::vector<std::uint32_t> nodeCapacities = {0}; // MethodOptions::nodeCapacity
  std::vector<std::uint32_t> memoryBudgets = {0};  // MethodOptions::memoryBudget
  std::vector<std::uint32_t> layers;               // where there are several; none: those of the limits
  MethodLimits limits;                             // one for all
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

// The settings that the choices stand for, by sample count and API, the baseline of each first, whether or not it was
// chosen. Choices that a method does not have (MethodTraits) it is not listed with.
// What checkMethodOptions() refuses, such as several samples of a method that has one, is skipped. Nothing is listed
// twice.
BenchSettings configurationsOf(const BenchMatrix& matrix);

// A setting in words, for people: "linked-list, compact, 4 samples, compute, list build compute", "loop, 16 layers".
std::string describe(const MethodOptions& options);

// The name of a method, with the API that is not the usual one: "linked-list, OpenGL".
std::string labelOf(const MethodOptions& options);

// The same beside its sample count: "linked-list, compact, compute".
std::string describeWithoutSamples(MethodOptions options);

} // namespace vitrail::tool
