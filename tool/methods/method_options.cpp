#include "method_options.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vitrail::tool {

namespace {

// All methods, the default first.
constexpr std::array kMethods{
    MethodTraits{.name = "linked-list",
                 .nodes = true,
                 .resolves = true,
                 .linkings = true,
                 .msaaResolves = true,
                 .layers = true,
                 .memoryBudget = true,
                 .lists = true,
                 .orderIndependent = true},
    MethodTraits{.name = "unsorted", .wrong = "surfaces are blended in the order in which they are drawn"},
    MethodTraits{.name = "sorted",
                 .wrong =
                     "objects that cross, nest or overlap in a cycle, and surfaces of one object, are blended in a "
                     "wrong order"},
    MethodTraits{.name = "sorted-triangles",
                 .wrong = "triangles that cross or overlap in a cycle are blended in a wrong order"},
    MethodTraits{.name = "depth-peeling", .severalSamples = false, .layers = true, .orderIndependent = true},
    MethodTraits{.name = "reverse-depth-peeling", .severalSamples = false, .orderIndependent = true},
    MethodTraits{.name = "dual-depth-peeling",
                 .severalSamples = false,
                 .orderIndependent = true,
                 .wrong = "different surfaces of a pixel at one depth are evened out"},
    MethodTraits{.name = "a-buffer", .severalSamples = false, .orderIndependent = true},
    MethodTraits{.name = "stencil-routed",
                 .severalSamples = false,
                 .orderIndependent = true,
                 .wrong = "edges may lie a little beside the others' where samples are not moved to the middle"},
    MethodTraits{.name = "insertion",
                 .severalSamples = false,
                 .lists = true,
                 .wrong = "fragments of a pixel beyond 128 are dropped"},
    MethodTraits{.name = "weighted",
                 .orderIndependent = true,
                 .wrong = "near surfaces let too much through of what they hide: colours wash out towards their mean"},
    MethodTraits{.name = "moment",
                 .severalSamples = false,
                 .orderIndependent = true,
                 .wrong = "light leaks through opaque surfaces among many others, and dense stacks are smeared"},
    MethodTraits{.name = "stochastic", .passes = true, .orderIndependent = true, .wrong = "noise"},
    MethodTraits{.name = "loop",
                 .severalSamples = false,
                 .layers = true,
                 .orderIndependent = true,
                 .wrong = "surfaces beyond the nearest ones are averaged"},
    MethodTraits{.name = "loop-64",
                 .severalSamples = false,
                 .layers = true,
                 .orderIndependent = true,
                 .wrong = "surfaces beyond the nearest ones are averaged"},
    MethodTraits{.name = "interlock",
                 .severalSamples = false,
                 .layers = true,
                 .orderIndependent = true,
                 .wrong = "surfaces beyond the nearest ones are averaged"},
    MethodTraits{.name = "multi-layer",
                 .severalSamples = false,
                 .layers = true,
                 .wrong = "surfaces beyond the layers are merged in the order in which they are drawn"},
};

constexpr std::array kNames = [] {
  std::array<std::string_view, kMethods.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kMethods[i].name;
  return names;
}();

template <typename Choice, std::size_t count>
using Names = std::array<std::pair<Choice, std::string_view>, count>;

constexpr Names<VitrailNodeFormat, 3> kNodeFormats{
    {{VITRAIL_NODE_COMPACT, "compact"}, {VITRAIL_NODE_STANDARD, "standard"}, {VITRAIL_NODE_HDR, "hdr"}}};
constexpr Names<VitrailResolve, 2> kResolves{
    {{VITRAIL_RESOLVE_COMPUTE, "compute"}, {VITRAIL_RESOLVE_FRAGMENT, "fragment"}}};
constexpr Names<VitrailListBuild, 2> kLinkings{
    {{VITRAIL_LIST_BUILD_FRAGMENT, "fragment"}, {VITRAIL_LIST_BUILD_COMPUTE, "compute"}}};
constexpr Names<VitrailMsaaResolve, 2> kMsaaResolves{
    {{VITRAIL_MSAA_RESOLVE_PER_PIXEL, "per-pixel"}, {VITRAIL_MSAA_RESOLVE_PER_SAMPLE, "per-sample"}}};

template <typename Table, typename Choice>
std::string_view nameIn(const Table& table, Choice choice) {
  const auto found = std::ranges::find(table, choice, [](const auto& entry) { return entry.first; });
  return found != table.end() ? found->second : "default";
}

template <typename Choice, std::size_t count>
std::optional<Choice> choiceIn(const Names<Choice, count>& table, std::string_view name) {
  const auto found = std::ranges::find(table, name, [](const auto& entry) { return entry.second; });
  if (found == table.end()) return std::nullopt;
  return found->first;
}

// Refuses an option that a method does not have.
void refuse(std::string_view option, bool MethodTraits::*has, std::string_view method) {
  std::vector<std::string_view> owners;
  for (const MethodTraits& each : kMethods) {
    if (each.*has) owners.push_back(each.name);
  }
  const std::string whose = owners.empty() ? "no method" : fmt::format("the method {}", fmt::join(owners, ", "));
  throw std::invalid_argument(fmt::format("{} is of {}: {} has no choice, leave it out", option, whose, method));
}

void checkTraits(const MethodOptions& options) {
  const MethodOptions defaults;
  const MethodTraits& traits = traitsOf(options.name);
  if (options.samples != 1 && !traits.severalSamples) {
    throw std::invalid_argument(fmt::format("the method {} has one sample a pixel: leave --samples out", options.name));
  }
  const auto check = [&](std::string_view option, bool MethodTraits::*has, bool chosen) {
    if (chosen && !(traits.*has)) refuse(option, has, options.name);
  };
  check("--nodes", &MethodTraits::nodes, options.nodes != defaults.nodes);
  check("--resolve", &MethodTraits::resolves, options.resolve != defaults.resolve);
  check("--linking", &MethodTraits::linkings, options.listBuild != defaults.listBuild);
  check("--msaa-resolve", &MethodTraits::msaaResolves, options.msaaResolve != defaults.msaaResolve);
  check("--layers", &MethodTraits::layers, options.maxLayers != defaults.maxLayers);
  check("--passes", &MethodTraits::passes, options.passes != defaults.passes);
}

void checkStored(const MethodOptions& options) {
  if (options.nodes == VITRAIL_NODE_COMPACT && options.samples > 4) {
    throw std::invalid_argument(
        fmt::format("--nodes compact holds the coverage of at most 4 samples, not {}: use --nodes standard or hdr",
                    options.samples));
  }
  if (options.msaaResolve != VITRAIL_MSAA_RESOLVE_PER_SAMPLE) return;
  if (options.samples == 1) throw std::invalid_argument("--msaa-resolve per-sample needs --samples 2, 4 or 8");
  if (options.resolve == VITRAIL_RESOLVE_COMPUTE) {
    throw std::invalid_argument(
        "--msaa-resolve per-sample is drawn, not computed: use --resolve fragment, or --msaa-resolve per-pixel");
  }
}

} // namespace

std::span<const std::string_view> methodNames() { return kNames; }

const MethodTraits& traitsOf(std::string_view name) {
  const auto* found = std::ranges::find(kMethods, name, &MethodTraits::name);
  if (found == kMethods.end()) throw std::logic_error(fmt::format("the method {} is not in the table", name));
  return *found;
}

void checkMethodOptions(const MethodOptions& options) {
  if (std::ranges::find(kNames, options.name) == kNames.end()) {
    throw std::invalid_argument(
        fmt::format("there is no method \"{}\"; the methods are {}", options.name, fmt::join(kNames, ", ")));
  }
  if (options.samples != 1 && options.samples != 2 && options.samples != 4 && options.samples != 8) {
    throw std::invalid_argument(fmt::format("a pixel has 1, 2, 4 or 8 samples, not {}", options.samples));
  }
  checkTraits(options);
  checkStored(options);
}

void checkPictureOptions(std::string_view method, bool memoryBudget) {
  if (!memoryBudget) return;
  if (!traitsOf(method).memoryBudget) refuse("--memory-budget", &MethodTraits::memoryBudget, method);
}

std::string_view nameOf(VitrailNodeFormat nodes) { return nameIn(kNodeFormats, nodes); }
std::string_view nameOf(VitrailResolve resolve) { return nameIn(kResolves, resolve); }
std::string_view nameOf(VitrailListBuild linking) { return nameIn(kLinkings, linking); }
std::string_view nameOf(VitrailMsaaResolve msaaResolve) { return nameIn(kMsaaResolves, msaaResolve); }

std::optional<VitrailNodeFormat> nodeFormatNamed(std::string_view name) { return choiceIn(kNodeFormats, name); }
std::optional<VitrailResolve> resolveNamed(std::string_view name) { return choiceIn(kResolves, name); }
std::optional<VitrailListBuild> linkingNamed(std::string_view name) { return choiceIn(kLinkings, name); }
std::optional<VitrailMsaaResolve> msaaResolveNamed(std::string_view name) { return choiceIn(kMsaaResolves, name); }

} // namespace vitrail::tool
