#include "methods.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "../scene/message.h"
#include "../scene/volume.h"
#include "gl_method.h"
#include "method.h"

namespace vitrail::tool {

namespace {

constexpr std::string_view kAveraged = "surfaces beyond the nearest ones are averaged";

// All methods, the default first.
constexpr std::array kMethods{
    MethodTraits{.name = kListMethod,
                 .help = "per-pixel linked lists of any length",
                 .make = makeLinkedList,
                 .makeGl = makeGlLinkedList,
                 .options = kTakesSamples | kTakesNodes | kTakesResolve | kTakesListBuild | kTakesMsaaResolve |
                            kTakesLayers | kTakesMemoryBudget | kTakesStencilMark | kTakesOverflow | kTakesSorting |
                            kTakesPeel,
                 .lists = true,
                 .orderIndependent = true},
    MethodTraits{.name = kTilesMethod,
                 .help = "a rasteriser in compute shaders, a tile at a time",
                 .make = makeTiles,
                 .options = kTakesSamples | kTakesMemoryBudget,
                 .orderIndependent = true},
    MethodTraits{.name = kCpuMethod,
                 .help = "on the processor, without Vulkan; lists of any length",
                 .options = kTakesSamples | kTakesMemoryBudget | kTakesPeel,
                 .orderIndependent = true,
                 .onProcessor = true},
    MethodTraits{.name = "unsorted",
                 .help = "plain blending in the order of the file",
                 .make = makeUnsorted,
                 .makeGl = makeGlUnsorted,
                 .options = kTakesSamples,
                 .wrong = "surfaces are blended in the order in which they are drawn"},
    MethodTraits{.name = "sorted",
                 .help = "objects back to front",
                 .make = makeSorted,
                 .makeGl = makeGlSorted,
                 .options = kTakesSamples,
                 .sortsOnHost = true,
                 .wrong = "objects that cross, nest or overlap in a cycle, and surfaces of one object, are blended in "
                          "a wrong order"},
    MethodTraits{.name = "sorted-triangles",
                 .help = "triangles back to front",
                 .make = makeSortedTriangles,
                 .options = kTakesSamples,
                 .sortsOnHost = true,
                 .wrong = "triangles that cross or overlap in a cycle are blended in a wrong order"},
    MethodTraits{.name = "depth-peeling",
                 .help = "front to back, a layer a pass",
                 .make = makeDepthPeeling,
                 .makeGl = makeGlDepthPeeling,
                 .options = kTakesLayers,
                 .orderIndependent = true},
    MethodTraits{.name = "reverse-depth-peeling",
                 .help = "back to front, a layer a pass",
                 .make = makeReverseDepthPeeling,
                 .orderIndependent = true},
    MethodTraits{.name = "dual-depth-peeling",
                 .help = "from both ends, two layers a pass",
                 .make = makeDualDepthPeeling,
                 .orderIndependent = true,
                 .wrong = "different surfaces of a pixel at one depth are evened out"},
    MethodTraits{.name = "a-buffer",
                 .help = "linear arrays, whose fragments are counted first",
                 .make = makeABuffer,
                 .orderIndependent = true},
    MethodTraits{.name = "stencil-routed",
                 .help = "as many layers a pass as a pixel has samples",
                 .make = makeStencilRouted,
                 .orderIndependent = true,
                 .wrong = "edges may lie a little beside the others' where samples are not moved to the middle"},
    MethodTraits{.name = "insertion",
                 .help = "lists as most published samples sort them",
                 .make = makeInsertion,
                 .lists = true,
                 .wrong = "fragments of a pixel beyond 128 are dropped"},
    MethodTraits{.name = "weighted",
                 .help = "a mean of all surfaces, weighted by depth: one pass",
                 .make = makeWeighted,
                 .options = kTakesSamples,
                 .orderIndependent = true,
                 .wrong = "near surfaces let too much through of what they hide: colours wash out towards their mean"},
    MethodTraits{.name = "moment",
                 .help = "dimmed by an estimate of what is in front: two passes",
                 .make = makeMoment,
                 .orderIndependent = true,
                 .wrong = "light leaks through opaque surfaces among many others, and dense stacks are smeared"},
    MethodTraits{.name = "stochastic",
                 .help = "surfaces cover random samples",
                 .make = makeStochastic,
                 .options = kTakesSamples | kTakesPasses,
                 .orderIndependent = true,
                 .wrong = "noise"},
    MethodTraits{.name = "loop",
                 .help = "the nearest surfaces exact, in two passes",
                 .make = makeLoop,
                 .options = kTakesLayers,
                 .orderIndependent = true,
                 .wrong = kAveraged},
    MethodTraits{.name = "loop-64",
                 .help = "the same in one pass, where the device can",
                 .make = makeLoop,
                 .options = kTakesLayers,
                 .orderIndependent = true,
                 .wrong = kAveraged},
    MethodTraits{.name = "interlock",
                 .help = "the same in one pass, where the device can",
                 .make = makeInterlock,
                 .options = kTakesLayers,
                 .orderIndependent = true,
                 .wrong = kAveraged},
    MethodTraits{.name = "multi-layer",
                 .help = "layers into which surfaces are merged, where the device can",
                 .make = makeMultiLayer,
                 .options = kTakesLayers,
                 .wrong = "surfaces beyond the layers are merged in the order in which they are drawn"},
    MethodTraits{
        .name = kLayerCount, .help = "the depth complexity of each pixel", .make = makeLayerCount, .listed = false},
};

constexpr auto kMethodNames = [] {
  std::array<std::string_view, std::ranges::count(kMethods, true, &MethodTraits::listed)> names;
  std::size_t count = 0;
  for (const MethodTraits& method : kMethods) {
    if (method.listed) names.at(count++) = method.name;
  }
  return names;
}();

// Refuses an option that a method does not have.
void refuse(std::string_view option, MethodOption bit, std::string_view method) {
  std::vector<std::string_view> owners;
  for (const MethodTraits& each : kMethods) {
    if (each.takes(bit)) owners.push_back(each.name);
  }
  const std::string whose = owners.empty() ? "no method" : fmt::format("the method {}", fmt::join(owners, ", "));
  throw std::invalid_argument(fmt::format("{} is of {}: {} has no choice, leave it out", option, whose, method));
}

// Refuses a method that is not there with an API.
void checkApi(const MethodOptions& options) {
  const MethodTraits& traits = traitsOf(options.name);
  if (options.api != Api::OpenGl || traits.makeGl != nullptr || traits.onProcessor) return;
  std::vector<std::string_view> there;
  for (const MethodTraits& each : kMethods) {
    if (each.makeGl != nullptr) there.push_back(each.name);
  }
  throw std::invalid_argument(
      fmt::format("--api opengl has the methods {}, not {}", fmt::join(there, ", "), options.name));
}

void checkTaken(const MethodOptions& options) {
  const MethodOptions defaults;
  const MethodTraits& traits = traitsOf(options.name);
  if (options.samples != 1 && !traits.takes(kTakesSamples)) {
    throw std::invalid_argument(fmt::format("the method {} has one sample a pixel: leave --samples out", options.name));
  }
  const auto check = [&](std::string_view option, MethodOption bit, bool chosen) {
    if (chosen && !traits.takes(bit)) refuse(option, bit, options.name);
  };
  check("--nodes", kTakesNodes, options.nodes != defaults.nodes);
  check("--resolve", kTakesResolve, options.resolve != defaults.resolve);
  check("--list-build", kTakesListBuild, options.listBuild != defaults.listBuild);
  check("--msaa-resolve", kTakesMsaaResolve, options.msaaResolve != defaults.msaaResolve);
  check("--layers", kTakesLayers, options.maxLayers != defaults.maxLayers);
  check("--stencil-mark", kTakesStencilMark, options.stencilMark != defaults.stencilMark);
  check("--overflow", kTakesOverflow, options.nodeCapacity != defaults.nodeCapacity);
  check("--memory-budget", kTakesMemoryBudget, options.memoryBudget != defaults.memoryBudget);
  check("--passes", kTakesPasses, options.passes != defaults.passes);
  check("--sorting", kTakesSorting, options.sorted != defaults.sorted);
}

// Refuses what does not go with lists that the tool walks by itself, as `option` makes it.
void checkWalked(const MethodOptions& options, std::string_view option) {
  if (options.name == kCpuMethod) return;
  if (options.api == Api::OpenGl) {
    throw std::invalid_argument(
        fmt::format("{} of {} is not there with --api opengl: leave one of them out", option, options.name));
  }
  if (options.maxLayers > 0) {
    throw std::invalid_argument(fmt::format("{} walks complete lists: leave --layers out", option));
  }
  if (options.nodeCapacity > 0) {
    throw std::invalid_argument(fmt::format("{} walks complete lists: leave --overflow out", option));
  }
  if (options.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_SAMPLE) {
    throw std::invalid_argument(fmt::format("{} is resolved per pixel: leave --msaa-resolve out", option));
  }
}

void checkStored(const MethodOptions& options) {
  if (options.nodes == VITRAIL_NODE_COMPACT && options.samples > 4) {
    throw std::invalid_argument(
        fmt::format("--nodes compact holds the coverage of at most 4 samples, not {}: use --nodes standard or hdr",
                    options.samples));
  }
  if (options.stencilMark == StencilMark::Off) {
    if (options.resolve == VITRAIL_RESOLVE_COMPUTE) {
      throw std::invalid_argument("--stencil-mark off is of resolves that are drawn: use --resolve fragment");
    }
    if (options.samples > 1 && options.msaaResolve == VITRAIL_MSAA_RESOLVE_PER_PIXEL) {
      throw std::invalid_argument(
          "--stencil-mark off is not of per-pixel resolves of several samples, which write every pixel: use "
          "--msaa-resolve per-sample");
    }
  }
  if (options.msaaResolve != VITRAIL_MSAA_RESOLVE_PER_SAMPLE) return;
  if (options.samples == 1) throw std::invalid_argument("--msaa-resolve per-sample needs --samples 2, 4 or 8");
  if (options.resolve == VITRAIL_RESOLVE_COMPUTE) {
    throw std::invalid_argument(
        "--msaa-resolve per-sample is drawn, not computed: use --resolve fragment, or --msaa-resolve per-pixel");
  }
}

} // namespace

std::span<const std::string_view> methodNames() { return kMethodNames; }

const MethodTraits& traitsOf(std::string_view name) {
  const auto* found = std::ranges::find(kMethods, name, &MethodTraits::name);
  if (found == kMethods.end()) throw std::logic_error(fmt::format("the method {} is not in the table", name));
  return *found;
}

std::unique_ptr<Method> makeMethod(const MethodHost& host, const MethodOptions& options) {
  return traitsOf(options.name).make(host, options);
}

std::unique_ptr<GlMethod> makeGlMethod(const GlMethodHost& host, const MethodOptions& options) {
  return traitsOf(options.name).makeGl(host, options);
}

void checkMethodOptions(const MethodOptions& options) {
  if (std::ranges::find(kMethodNames, options.name) == kMethodNames.end()) {
    throw std::invalid_argument(
        fmt::format("there is no method \"{}\"; the methods are {}", options.name, fmt::join(kMethodNames, ", ")));
  }
  if (options.samples != 1 && options.samples != 2 && options.samples != 4 && options.samples != 8) {
    throw std::invalid_argument(fmt::format("a pixel has 1, 2, 4 or 8 samples, not {}", options.samples));
  }
  checkApi(options);
  checkTaken(options);
  checkStored(options);
  if (!options.sorted) checkWalked(options, "--sorting off");
}

std::vector<std::string> methodWarnings(const Scene& scene, const MethodOptions& options) {
  const bool cut = !scene.clipPlanes.empty();
  const bool walks = options.name == kListMethod && options.maxLayers == 0 && options.sorted;
  const Solids solids(scene, false);
  if (walks && !cut && solids.open()) {
    const std::uint32_t material = *solids.open();
    return {
        fmt::format("{}: an object of it is not closed, so that light is absorbed there by the file's thickness, not "
                    "by its true way",
                    objectName("material", material, scene.materials[material].name))};
  }
  if ((walks && !cut) || !solids.any()) return {};
  if (cut) return {"volumes are attenuated by the file's thickness, not by the true path: --clip-plane cuts them open"};
  return {options.name == kListMethod
              ? fmt::format("volumes are attenuated by the file's thickness, not by the true path: leave {} out",
                            options.sorted ? "--layers" : "--sorting")
              : "volumes are attenuated by the file's thickness, not by the true path: use --method linked-list"};
}

void checkPictureOptions(const MethodOptions& method, bool memoryBudget, bool peels) {
  const MethodTraits& traits = traitsOf(method.name);
  if (memoryBudget && !traits.takes(kTakesMemoryBudget)) refuse("--memory-budget", kTakesMemoryBudget, method.name);
  if (!peels) return;
  if (!traits.takes(kTakesPeel)) refuse("--peel", kTakesPeel, method.name);
  checkWalked(method, "--peel");
  if (!method.sorted) throw std::invalid_argument("--peel needs sorted surfaces: leave --sorting out");
}

} // namespace vitrail::tool
