// What a user chooses of a transparency method, and the names of the choices.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <volk.h>

#include <vitrail/vitrail.h>

namespace vitrail::tool {

struct MethodOptions {
  std::string name = "linked-list";
  std::uint32_t samples = 1; // 1, 2, 4, 8
  // Of the methods that store fragments:
  VitrailNodeFormat nodes = VITRAIL_NODE_STANDARD;
  VitrailResolve resolve = VITRAIL_RESOLVE_DEFAULT;
  VitrailMsaaResolve msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  std::uint32_t maxLayers = 0; // 0: no bound
};

// All methods, the default first.
std::span<const std::string_view> methodNames();

// Throws std::invalid_argument with a one-line reason for an unknown name, or for options that exclude each other.
void checkMethodOptions(const MethodOptions& options);

// The names of the choices: "standard", "compact", "hdr"; "compute", "fragment"; "per-pixel", "per-sample".
std::string_view nameOf(VitrailNodeFormat nodes);
std::string_view nameOf(VitrailResolve resolve);
std::string_view nameOf(VitrailMsaaResolve msaaResolve);

// The choice of that name; nothing for another text.
std::optional<VitrailNodeFormat> nodeFormatNamed(std::string_view name);
std::optional<VitrailResolve> resolveNamed(std::string_view name);
std::optional<VitrailMsaaResolve> msaaResolveNamed(std::string_view name);

} // namespace vitrail::tool
