#include "method_options.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vitrail::tool {

namespace {

constexpr std::array<std::string_view, 3> kMethods{"linked-list", "unsorted", "insertion"};

template <typename Choice, std::size_t count>
using Names = std::array<std::pair<Choice, std::string_view>, count>;

constexpr Names<VitrailNodeFormat, 3> kNodeFormats{
    {{VITRAIL_NODE_COMPACT, "compact"}, {VITRAIL_NODE_STANDARD, "standard"}, {VITRAIL_NODE_HDR, "hdr"}}};
constexpr Names<VitrailResolve, 2> kResolves{
    {{VITRAIL_RESOLVE_COMPUTE, "compute"}, {VITRAIL_RESOLVE_FRAGMENT, "fragment"}}};
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

// Whether there is a choice of how fragments are stored and resolved.
bool hasChoices(std::string_view method) { return method == "linked-list"; }

void checkStored(const MethodOptions& options) {
  const MethodOptions defaults;
  if (options.name == "insertion" && options.samples != 1) {
    throw std::invalid_argument("the method insertion has one sample a pixel: leave --samples out");
  }
  if (!hasChoices(options.name)) {
    if (options.nodes == defaults.nodes && options.resolve == defaults.resolve &&
        options.msaaResolve == defaults.msaaResolve && options.maxLayers == defaults.maxLayers) {
      return;
    }
    throw std::invalid_argument(
        fmt::format("--nodes, --resolve, --msaa-resolve and --layers are of the method linked-list: {} has no choice",
                    options.name));
  }
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

std::span<const std::string_view> methodNames() { return kMethods; }

void checkMethodOptions(const MethodOptions& options) {
  if (std::ranges::find(kMethods, options.name) == kMethods.end()) {
    throw std::invalid_argument(
        fmt::format("there is no method \"{}\"; the methods are {}", options.name, fmt::join(kMethods, ", ")));
  }
  if (options.samples != 1 && options.samples != 2 && options.samples != 4 && options.samples != 8) {
    throw std::invalid_argument(fmt::format("a pixel has 1, 2, 4 or 8 samples, not {}", options.samples));
  }
  checkStored(options);
}

std::string_view nameOf(VitrailNodeFormat nodes) { return nameIn(kNodeFormats, nodes); }
std::string_view nameOf(VitrailResolve resolve) { return nameIn(kResolves, resolve); }
std::string_view nameOf(VitrailMsaaResolve msaaResolve) { return nameIn(kMsaaResolves, msaaResolve); }

std::optional<VitrailNodeFormat> nodeFormatNamed(std::string_view name) { return choiceIn(kNodeFormats, name); }
std::optional<VitrailResolve> resolveNamed(std::string_view name) { return choiceIn(kResolves, name); }
std::optional<VitrailMsaaResolve> msaaResolveNamed(std::string_view name) { return choiceIn(kMsaaResolves, name); }

} // namespace vitrail::tool
