// What a user chooses of a transparency method, and the names of the choices.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <volk.h>

#include <vitrail/vulkan.h>

namespace vitrail::tool {

// Whether a drawn resolve skips pixels without fragments by the stencil that collecting left (VitrailVkScope).
enum class StencilMark { On, Off };

// What draws.
enum class Api { Vulkan, OpenGl };

// What becomes of a picture that has more fragments than its memory.
enum class Overflow {
  Grow,       // it is drawn again, with more memory or in tiles
  Approximate // it is blended approximately, in a fixed number of nodes
};

struct MethodOptions {
  std::string name = "linked-list";
  Api api = Api::Vulkan;     // but of the method cpu, which needs none
  std::uint32_t samples = 1; // 1, 2, 4, 8
  // Of methods that have a choice of them (MethodTraits):
  VitrailNodeFormat nodes = VITRAIL_NODE_HDR; // the one that keeps pictures within 1/255
  VitrailResolve resolve = VITRAIL_RESOLVE_DEFAULT;
  VitrailListBuild listBuild = VITRAIL_LIST_BUILD_DEFAULT;
  VitrailMsaaResolve msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  StencilMark stencilMark = StencilMark::On;
  std::uint32_t nodeCapacity = 0; // nodes of Overflow::Approximate; 0: Overflow::Grow
  std::uint32_t memoryBudget = 0; // MiB of each picture; 0: what RenderOptions says
  std::uint32_t maxLayers = 0;    // the nearest of a pixel that are drawn as they are; 0: no bound, or the method's own
  std::uint32_t passes = 0;       // over the surfaces; 0: the method's own number
  bool sorted = true;             // false: surfaces are blended in the order in which they arrive

  bool operator==(const MethodOptions&) const = default;
};

// The names of the choices: "standard", "compact", "hdr"; "compute", "fragment", of resolve and list build;
// "per-pixel", "per-sample"; "on", "off".
std::string_view nameOf(VitrailNodeFormat nodes);
std::string_view nameOf(VitrailResolve resolve);
std::string_view nameOf(VitrailListBuild listBuild);
std::string_view nameOf(VitrailMsaaResolve msaaResolve);
std::string_view nameOf(StencilMark mark);
std::string_view nameOf(Api api); // "vulkan", "opengl"

// The choice of that name; nothing for another text.
std::optional<VitrailNodeFormat> nodeFormatNamed(std::string_view name);
std::optional<VitrailResolve> resolveNamed(std::string_view name);
std::optional<VitrailListBuild> listBuildNamed(std::string_view name);
std::optional<VitrailMsaaResolve> msaaResolveNamed(std::string_view name);
std::optional<StencilMark> stencilMarkNamed(std::string_view name);
std::optional<bool> sortingNamed(std::string_view name); // "on", "off"
std::optional<Api> apiNamed(std::string_view name);
std::optional<Overflow> overflowNamed(std::string_view name); // "grow", "approximate"

} // namespace vitrail::tool
