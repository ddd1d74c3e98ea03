// All transparency methods: one row of a table each, which says how a method is made, what it takes and what it
// promises.
//
// A new method is a folder of its own with its code and its shaders, a line among the factories below, and a row of the
// table in methods.cpp. Options, help pages, benchmarks and reports follow from the row. With OpenGL as well it has a
// gl_NAME.cpp beside it, a factory and a place in the row, and its shaders stand in opengl/shaders.cmake, too.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "method_options.h"

namespace vitrail::tool {

struct Scene; // scene/scene.h
class Method; // method.h
struct MethodHost;
class GlMethod; // gl_method.h
struct GlMethodHost;

// The options of MethodOptions that only some methods have. What a method has not is refused, never ignored.
enum MethodOption : std::uint32_t {
  kTakesSamples = 1U << 0U,      // --samples
  kTakesNodes = 1U << 1U,        // --nodes
  kTakesResolve = 1U << 2U,      // --resolve
  kTakesListBuild = 1U << 3U,    // --list-build
  kTakesMsaaResolve = 1U << 4U,  // --msaa-resolve
  kTakesLayers = 1U << 5U,       // --layers
  kTakesPasses = 1U << 6U,       // --passes
  kTakesMemoryBudget = 1U << 7U, // --memory-budget
  kTakesStencilMark = 1U << 8U,  // --stencil-mark
  kTakesOverflow = 1U << 9U,     // --overflow
  kTakesSorting = 1U << 10U,     // --sorting
  kTakesPeel = 1U << 11U         // --peel
};

// A row of the table.
struct MethodTraits {
  std::string_view name; // what --method takes
  std::string_view help; // how it draws: a line of at most 65 characters
  std::unique_ptr<Method> (*make)(const MethodHost& host, const MethodOptions& options) = nullptr;
  std::unique_ptr<GlMethod> (*makeGl)(const GlMethodHost& host, const MethodOptions& options) = nullptr; // or not there
  std::uint32_t options = 0; // of MethodOption
  bool lists = false;        // its fragments are nodes of lists
  bool sortsOnHost = false;  // it reads the geometry that MethodHost::scene has
  // Whether pictures are the same whatever order surfaces are drawn in, where they are not exact too; with
  // depth-peeling and reverse-depth-peeling but for surfaces at equal depths.
  bool orderIndependent = false;
  std::string_view wrong{}; // what its pictures get wrong, in words; nothing: they are exact
  bool listed = true;       // false: no method to draw with
  bool onProcessor = false; // drawn by render/cpu_still.h, without Vulkan: `make` is null

  bool takes(MethodOption option) const { return (options & option) != 0; }
};

// The methods that are listed, the default first.
std::span<const std::string_view> methodNames();

// The row of that name, also of one that is not listed; where there is none, throws std::logic_error.
const MethodTraits& traitsOf(std::string_view name);

// Makes a method that is not drawn on the processor. The options have passed checkMethodOptions(), or are
// kLayerCount's. Throws GpuError where the device does not offer them.
std::unique_ptr<Method> makeMethod(const MethodHost& host, const MethodOptions& options);

// The same with OpenGL, for a method that is there with it.
std::unique_ptr<GlMethod> makeGlMethod(const GlMethodHost& host, const MethodOptions& options);

// Throws std::invalid_argument with a one-line reason for a name that is not listed, for options that the method does
// not have, or for options that exclude each other.
void checkMethodOptions(const MethodOptions& options);

// The same for what is chosen with each picture: whether there is a memory budget, and whether surfaces are left out.
void checkPictureOptions(const MethodOptions& method, bool memoryBudget, bool peels);

// What the method draws otherwise of a scene than others would: lines as Scene::warnings has them.
std::vector<std::string> methodWarnings(const Scene& scene, const MethodOptions& options);

// The exact methods of choice: on a Vulkan device, and on the processor.
inline constexpr std::string_view kListMethod = "linked-list";
inline constexpr std::string_view kCpuMethod = "cpu";
// Where it is faster than lists, which commands/method_choice.h measures.
inline constexpr std::string_view kTilesMethod = "tiles";

// What draws, as reports have it: "vulkan", "opengl", or "cpu" without either.
inline std::string_view apiOf(const MethodOptions& options) {
  return options.name == kCpuMethod ? kCpuMethod : nameOf(options.api);
}

// Counts the fragments of each pixel and draws no picture; not listed.
inline constexpr std::string_view kLayerCount = "layer-count";

// The factories, each in the folder of its name. Throw GpuError.
std::unique_ptr<Method> makeABuffer(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeDepthPeeling(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeDualDepthPeeling(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeInsertion(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeInterlock(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeLayerCount(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeLinkedList(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeLoop(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeMoment(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeMultiLayer(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeReverseDepthPeeling(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeSorted(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeSortedTriangles(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeStencilRouted(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeStochastic(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeTiles(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeUnsorted(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<Method> makeWeighted(const MethodHost& host, const MethodOptions& options);
std::unique_ptr<GlMethod> makeGlDepthPeeling(const GlMethodHost& host, const MethodOptions& options);
std::unique_ptr<GlMethod> makeGlLinkedList(const GlMethodHost& host, const MethodOptions& options);
std::unique_ptr<GlMethod> makeGlSorted(const GlMethodHost& host, const MethodOptions& options);
std::unique_ptr<GlMethod> makeGlUnsorted(const GlMethodHost& host, const MethodOptions& options);

} // namespace vitrail::tool
