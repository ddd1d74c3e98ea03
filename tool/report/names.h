// The names of the numbers that reports tell of a measured setting, each once, with its unit. JSON, CSV and the pages
// use these: they are an interface and stay. docs/performance.md and docs/compare.md say more of each.
#pragma once

namespace vitrail::tool::names {

// The setting.
inline constexpr const char* kMethod = "method";
inline constexpr const char* kNodes = "nodes";
inline constexpr const char* kSamples = "samples"; // of a pixel
inline constexpr const char* kResolve = "resolve";
inline constexpr const char* kListBuild = "list_build";
inline constexpr const char* kMsaaResolve = "msaa_resolve";       // of several samples
inline constexpr const char* kStencilMark = "stencil_mark";       // "on", "off", of drawn resolves that can have one
inline constexpr const char* kMemoryBudget = "memory_budget_mib"; // --memory-budget, where it was given
inline constexpr const char* kNodeCapacity = "node_capacity";     // --node-capacity, where it was given
inline constexpr const char* kMaxLayers = "max_layers";           // --layers, where it was given
inline constexpr const char* kPasses = "passes";                  // --passes, where it was given

// What a frame held.
inline constexpr const char* kExact = "exact"; // within 1/255 of the real-number answer
// How far a pixel may be from that answer, in 1/255; null where surfaces are missing or blended otherwise.
inline constexpr const char* kErrorBound = "error_bound_255";
inline constexpr const char* kFragments = "fragments"; // transparent ones that were asked for
inline constexpr const char* kMissing = "missing";     // of them
inline constexpr const char* kLayers = "layers";
inline constexpr const char* kLayersMax = "layers_max";  // fragments of the deepest pixel
inline constexpr const char* kOverflowed = "overflowed"; // more fragments than nodes: not exact
inline constexpr const char* kApproximatePixels = "approximate_pixels";
inline constexpr const char* kTiles = "tiles";
inline constexpr const char* kNodesBytes = "nodes_bytes";
inline constexpr const char* kMemoryBytes = "memory_bytes"; // all that the method keeps on the device

// What pictures lack, a line each.
inline constexpr const char* kWarnings = "warnings";

// What it cost: milliseconds of GPU time, medians where several frames were drawn.
inline constexpr const char* kPassesMs = "passes_ms";
inline constexpr const char* kCostMs = "cost_ms";         // all passes but the opaque one
inline constexpr const char* kFrameMs = "frame_ms";       // all passes
inline constexpr const char* kCostRatio = "cost_ratio";   // over that of unsorted in the same picture
inline constexpr const char* kFrameRatio = "frame_ratio"; // so here

// Where it was measured.
inline constexpr const char* kDevice = "device";
inline constexpr const char* kDriver = "driver";
inline constexpr const char* kApi = "api";
inline constexpr const char* kCpu = "cpu"; // whether the device is one: then only ratios mean anything

// What was drawn.
inline constexpr const char* kScene = "scene";
inline constexpr const char* kCount = "count"; // --count
inline constexpr const char* kSweep = "sweep";
inline constexpr const char* kStep = "step"; // of the sweep: layers, triangles, pixels, samples or the cap
inline constexpr const char* kWidth = "width";
inline constexpr const char* kHeight = "height";
inline constexpr const char* kTriangles = "triangles";

} // namespace vitrail::tool::names
