// What a user chooses of a transparency method, and the names of the choices.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <volk.h>

#include <vitrail/vulkan.h>

namespace vitrail::tool {

struct MethodOptions {
  std::string name = "linked-list";
  std::uint32_t samples = 1; // 1, 2, 4, 8
  // Of methods that have a choice of them (MethodTraits):
  VitrailNodeFormat nodes = VITRAIL_NODE_STANDARD;
  VitrailResolve resolve = VITRAIL_RESOLVE_DEFAULT;
  VitrailListBuild linking = VITRAIL_LIST_BUILD_DEFAULT;
  VitrailMsaaResolve msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  std::uint32_t maxLayers = 0; // the nearest of a pixel that are drawn as they are; 0: no bound, or the method's own
  std::uint32_t passes = 0;    // over the surfaces; 0: the method's own number
};

// What options a method has. What it has not is refused, never ignored.
struct MethodTraits {
  std::string_view name;
  bool severalSamples = true;
  bool nodes = false;        // --nodes
  bool resolves = false;     // --resolve
  bool linkings = false;     // --linking
  bool msaaResolves = false; // --msaa-resolve
  bool layers = false;       // --layers
  bool passes = false;       // --passes
  bool memoryBudget = false; // --memory-budget
  bool lists = false;        // its fragments are nodes of lists
  // Whether pictures are the same whatever order surfaces are drawn in, where they are not exact too; with
  // depth-peeling and reverse-depth-peeling but for surfaces at equal depths.
  bool orderIndependent = false;
  std::string_view wrong{}; // what its pictures get wrong, in words; nothing: they are exact
};

// All methods, the default first.
std::span<const std::string_view> methodNames();

// The method of that name, which is one of methodNames(); else throws std::logic_error.
const MethodTraits& traitsOf(std::string_view name);

// Throws std::invalid_argument with a one-line reason for an unknown name, for options that the method does not have,
// or for options that exclude each other.
void checkMethodOptions(const MethodOptions& options);

// The same for what is chosen with each picture: whether there is a memory budget.
void checkPictureOptions(std::string_view method, bool memoryBudget);

// The names of the choices: "standard", "compact", "hdr"; "compute", "fragment", of resolve and linking; "per-pixel",
// "per-sample".
std::string_view nameOf(VitrailNodeFormat nodes);
std::string_view nameOf(VitrailResolve resolve);
std::string_view nameOf(VitrailListBuild linking);
std::string_view nameOf(VitrailMsaaResolve msaaResolve);

// The choice of that name; nothing for another text.
std::optional<VitrailNodeFormat> nodeFormatNamed(std::string_view name);
std::optional<VitrailResolve> resolveNamed(std::string_view name);
std::optional<VitrailListBuild> linkingNamed(std::string_view name);
std::optional<VitrailMsaaResolve> msaaResolveNamed(std::string_view name);

} // namespace vitrail::tool
