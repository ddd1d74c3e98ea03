// What a user chooses of a transparency method, and the names of the choices.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <volk.h>

#include <vitrail/vulkan.h>

namespace vitrail::tool {

struct MethodOptions {
  std::string name = "linked-list";
  std::uint32_t samples = 1; // 1, 2, 4, 8
  // Of methods that have a choice of them (MethodTraits):
  VitrailNodeFormat nodes = VITRAIL_NODE_HDR; // the one that keeps pictures within 1/255
  VitrailResolve resolve = VITRAIL_RESOLVE_DEFAULT;
  VitrailListBuild listBuild = VITRAIL_LIST_BUILD_DEFAULT;
  VitrailMsaaResolve msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  std::uint32_t maxLayers = 0; // the nearest of a pixel that are drawn as they are; 0: no bound, or the method's own
  std::uint32_t passes = 0;    // over the surfaces; 0: the method's own number
};

// The names of the choices: "standard", "compact", "hdr"; "compute", "fragment", of resolve and list build;
// "per-pixel", "per-sample".
std::string_view nameOf(VitrailNodeFormat nodes);
std::string_view nameOf(VitrailResolve resolve);
std::string_view nameOf(VitrailListBuild listBuild);
std::string_view nameOf(VitrailMsaaResolve msaaResolve);

// The choice of that name; nothing for another text.
std::optional<VitrailNodeFormat> nodeFormatNamed(std::string_view name);
std::optional<VitrailResolve> resolveNamed(std::string_view name);
std::optional<VitrailListBuild> listBuildNamed(std::string_view name);
std::optional<VitrailMsaaResolve> msaaResolveNamed(std::string_view name);

} // namespace vitrail::tool
