#include "method_options.h"

#include <algorithm>
#include <array>
#include <utility>

namespace vitrail::tool {

namespace {

template <typename Choice, std::size_t count>
using Names = std::array<std::pair<Choice, std::string_view>, count>;

constexpr Names<VitrailNodeFormat, 3> kNodeFormats{
    {{VITRAIL_NODE_COMPACT, "compact"}, {VITRAIL_NODE_STANDARD, "standard"}, {VITRAIL_NODE_HDR, "hdr"}}};
constexpr Names<VitrailResolve, 2> kResolves{
    {{VITRAIL_RESOLVE_COMPUTE, "compute"}, {VITRAIL_RESOLVE_FRAGMENT, "fragment"}}};
constexpr Names<VitrailListBuild, 2> kListBuilds{
    {{VITRAIL_LIST_BUILD_FRAGMENT, "fragment"}, {VITRAIL_LIST_BUILD_COMPUTE, "compute"}}};
constexpr Names<VitrailMsaaResolve, 2> kMsaaResolves{
    {{VITRAIL_MSAA_RESOLVE_PER_PIXEL, "per-pixel"}, {VITRAIL_MSAA_RESOLVE_PER_SAMPLE, "per-sample"}}};
constexpr Names<StencilMark, 2> kStencilMarks{{{StencilMark::On, "on"}, {StencilMark::Off, "off"}}};
constexpr Names<Overflow, 2> kOverflows{{{Overflow::Grow, "grow"}, {Overflow::Approximate, "approximate"}}};

constexpr Names<Api, 2> kApis{{{Api::Vulkan, "vulkan"}, {Api::OpenGl, "opengl"}}};

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

} // namespace

std::string_view nameOf(VitrailNodeFormat nodes) { return nameIn(kNodeFormats, nodes); }
std::string_view nameOf(VitrailResolve resolve) { return nameIn(kResolves, resolve); }
std::string_view nameOf(VitrailListBuild listBuild) { return nameIn(kListBuilds, listBuild); }
std::string_view nameOf(VitrailMsaaResolve msaaResolve) { return nameIn(kMsaaResolves, msaaResolve); }
std::string_view nameOf(StencilMark mark) { return nameIn(kStencilMarks, mark); }
std::string_view nameOf(Api api) { return nameIn(kApis, api); }

std::optional<VitrailNodeFormat> nodeFormatNamed(std::string_view name) { return choiceIn(kNodeFormats, name); }
std::optional<VitrailResolve> resolveNamed(std::string_view name) { return choiceIn(kResolves, name); }
std::optional<VitrailListBuild> listBuildNamed(std::string_view name) { return choiceIn(kListBuilds, name); }
std::optional<VitrailMsaaResolve> msaaResolveNamed(std::string_view name) { return choiceIn(kMsaaResolves, name); }
std::optional<StencilMark> stencilMarkNamed(std::string_view name) { return choiceIn(kStencilMarks, name); }
std::optional<bool> sortingNamed(std::string_view name) {
  if (name == "on") return true;
  if (name == "off") return false;
  return {};
}
std::optional<Api> apiNamed(std::string_view name) { return choiceIn(kApis, name); }
std::optional<Overflow> overflowNamed(std::string_view name) { return choiceIn(kOverflows, name); }

} // namespace vitrail::tool
