#include "bench_options.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "../methods/methods.h"

#include "device_options.h"
#include "errors.h"
#include "option_values.h"
#include "scene_options.h"

namespace vitrail::tool {

namespace {

constexpr const char* kBenchHelp =
    R"(Measures what transparency methods cost on a device, against blending in no order, and tells
which one to use there.

Usage:
  vitrail bench [options]
  vitrail bench MODEL [options]
  vitrail bench --scene NAME,... [options]
  vitrail bench --sweep NAME,... [options]

Every choice is measured with every other. What a method or the device does not allow is listed as
skipped, with the reason. Lists are separated by commas.

What to draw:
  MODEL                 a .gltf, .glb, .obj, .ply or .stl file
  --scene NAME,...      built-in scenes (default spheres,planes,hairball; vitrail scenes lists all)
  --count N,...         how many spheres, panes, ...: one number for all scenes, or one for each
@load@
  --size WxH            pixels (default 1280x720; of sweeps on a CPU's driver 320x180)
  --opacity A           makes every material translucent, 0.004 to 1

What grows, step by step (one scene, default spheres):
  --sweep NAME,...      layers       1, 2, 4, ... 64 panes (on a CPU's driver 32), of planes
                        triangles    every triangle is split into 4, again and again
                        resolution   320x180 to 3840x2160 (on a CPU's driver 160x90 to 960x540)
                        samples      1, 2, 4 and 8 a pixel
                        cap          8, 16 and 32 layers that are blended exactly, or --layers

What to compare with method unsorted, which is always measured:
  --methods NAME,...    methods of vitrail render (default: all)
  --nodes F,...         node formats of methods that have a choice: standard, compact, hdr
                        (default hdr)
  --samples N,...       1, 2, 4, 8 (default 1)
  --resolve R,...       resolves of such methods: compute, fragment (default: the library's choice)
  --list-build L,...    list builds of such methods: fragment, compute (default: the library's choice)
  --msaa-resolve R,...  of several samples: per-pixel, per-sample (default per-pixel)
  --stencil-mark M,...  on, off: whether fragment resolves skip pixels without fragments by the
                        stencil (default on)
  --memory-budget MIB,...
                        for fragments: pictures that need more are drawn in tiles (default: what the
                        device can give)
  --overflow O          grow (default): a picture of more fragments than its memory is drawn again.
                        approximate: it is blended approximately, in --node-capacity nodes
  --node-capacity N,... nodes of linked-list, of --overflow approximate
  --layers N,..., --passes N
                        as of vitrail render, of the methods that have them; the others stay as they
                        are

How often:
  --repeat N            rounds, each of which draws one frame of every setting, and of every step of
                        a sweep (default 31, on a CPU's driver 3)
  --warmup N            frames of every setting before the first round (default 3, on a CPU's driver 1)

Where to:
  -o, --output DIR      a folder, made where there is none, for index.html, one page that needs
                        nothing beside it, report.json and report.csv; files appear whole
  --json FILE           everything that was measured; the file appears whole or not at all
  --csv FILE            one row for each measurement
  --quiet               print nothing but errors
  --strict              fail where there would be a warning: where the picture lacks something
                        that the file has, or shows nothing

Which device:
@api@
@device@

Examples:
  vitrail bench --sweep layers,triangles,resolution -o bench
  vitrail bench --scene spheres,planes,hairball --count 400,32,4000 --size 1920x1080 --json h100.json
  vitrail bench engine.glb --opacity 0.25 --methods linked-list --nodes compact,standard,hdr
)";

std::optional<std::uint32_t> sampleCount(const std::string& text) {
  constexpr std::array<std::string_view, 4> kCounts{"1", "2", "4", "8"};
  return std::ranges::count(kCounts, text) > 0 ? numberOf<std::uint32_t>(text) : std::nullopt;
}

std::optional<std::uint32_t> positive(const std::string& text) {
  const auto value = numberOf<std::uint32_t>(text);
  return value && *value > 0 ? value : std::nullopt;
}

// Who has --layers: one number for all, several to compare, or the steps of a sweep.
void takeLayers(BenchArguments& arguments) {
  BenchMatrix& matrix = arguments.matrix;
  const bool isSwept = std::ranges::count(arguments.sweeps, SweepKind::Cap) > 0;
  MethodLimits limits = matrix.limits;
  if (!matrix.layers.empty()) limits.layers = matrix.layers.front();
  if (isSwept && limits.layers == 0) limits.layers = 1; // any: some method has to have the option
  checkLimitsOf(matrix.methods, limits);
  if (isSwept) {
    if (arguments.sweeps.size() > 1 && !matrix.layers.empty()) {
      throw UsageError("--layers are the steps of --sweep cap: sweep over other things in a run of their own");
    }
    arguments.caps = std::move(matrix.layers);
    matrix.layers.clear();
    std::ranges::sort(arguments.caps);
    const auto repeated = std::ranges::unique(arguments.caps);
    arguments.caps.erase(repeated.begin(), repeated.end());
  } else if (matrix.layers.size() == 1) {
    matrix.limits.layers = matrix.layers.front();
    matrix.layers.clear();
  }
}

void checkMemory(const CLI::App& command, const BenchArguments& arguments) {
  const bool hasCapacity = command.count("--node-capacity") > 0;
  const bool isFixed = arguments.overflow == Overflow::Approximate;
  if (isFixed && !hasCapacity)
    throw UsageError("--overflow approximate needs a number of nodes: add --node-capacity N");
  if (!isFixed && hasCapacity)
    throw UsageError("--node-capacity is of --overflow approximate: add that, or leave it out");
  if (isFixed && command.count("--memory-budget") > 0) {
    throw UsageError("--overflow approximate has --node-capacity for its memory: leave --memory-budget out");
  }
}

// Refuses what none of the methods has.
void checkChoices(const CLI::App& command, const std::vector<std::string>& methods) {
  constexpr std::array<std::pair<const char*, MethodOption>, 4> kChoices{{{"--msaa-resolve", kTakesMsaaResolve},
                                                                          {"--stencil-mark", kTakesStencilMark},
                                                                          {"--memory-budget", kTakesMemoryBudget},
                                                                          {"--overflow", kTakesOverflow}}};
  for (const auto& [option, bit] : kChoices) {
    const auto hasIt = [bit = bit](const std::string& name) { return traitsOf(name).takes(bit); };
    if (command.count(option) == 0 || methods.empty() || std::ranges::any_of(methods, hasIt)) continue;
    throw UsageError(
        fmt::format("{} has no method that was named: leave it out, or add --methods linked-list", option));
  }
}

void checkSweeps(const CLI::App& command, BenchArguments& arguments) {
  const auto has = [&](SweepKind kind) { return std::ranges::count(arguments.sweeps, kind) > 0; };
  for (const SweepKind kind : arguments.sweeps) {
    if (std::ranges::count(arguments.sweeps, kind) > 1) {
      throw UsageError(fmt::format("--sweep names {} twice: once is enough", nameOf(kind)));
    }
  }
  if (arguments.scenes.size() > 1 || arguments.counts.size() > 1) {
    throw UsageError("--sweep takes one scene: name one with --scene, and one --count");
  }
  const bool chosen = !arguments.model.empty() || !arguments.scenes.empty() || !arguments.counts.empty();
  if (chosen && arguments.sweeps.size() == 1 && has(SweepKind::Layers)) {
    throw UsageError("--sweep layers is of the scene planes: leave MODEL, --scene and --count out");
  }
  if (command.count("--size") > 0 && arguments.sweeps.size() == 1 && has(SweepKind::Resolution)) {
    throw UsageError("--sweep resolution has sizes of its own: leave --size out");
  }
  if (command.count("--samples") > 0 && (has(SweepKind::Samples) || arguments.matrix.samples.size() > 1)) {
    throw UsageError(has(SweepKind::Samples)
                         ? "--sweep samples has 1, 2, 4 and 8: leave --samples out"
                         : "--sweep takes one number of --samples; --sweep samples goes through all");
  }
  if (arguments.model.empty() && arguments.scenes.empty()) arguments.scenes = {"spheres"};
}

} // namespace

std::string benchHelp() { return withApiHelp(withDeviceHelp(withText(kBenchHelp, "@load@", kLoadHelp)), true); }

void addBenchOptions(CLI::App& command, BenchArguments& arguments) {
  command.add_option("MODEL", arguments.model);
  command.add_option("--json", arguments.json);
  command.add_option("--csv", arguments.csv);
  command.add_option("-o,--output", arguments.folder);
  addList<SweepKind>(command, "--sweep", arguments.sweeps, "a sweep: layers, triangles, resolution, samples or cap",
                     sweepNamed);
  command.add_option("--device", arguments.device);
  addWarningOptions(command, arguments);
  addLoadOptions(command, arguments.load);
  addSize(command, arguments.width, arguments.height);
  addOpacity(command, arguments.opacity);
  addFrames(command, "--repeat", arguments.repeats);
  addFrames(command, "--warmup", arguments.warmups);
  BenchMatrix& matrix = arguments.matrix;
  addList<std::string>(command, "--scene", arguments.scenes, "the name of a scene",
                       [](const std::string& text) { return text.empty() ? std::nullopt : std::optional(text); });
  addList<std::uint32_t>(command, "--count", arguments.counts, "a whole number from 0",
                         [](const std::string& text) { return numberOf<std::uint32_t>(text); });
  addMethods(command, matrix.methods);
  addApis(command, matrix.apis);
  addList<VitrailNodeFormat>(command, "--nodes", matrix.nodes, "a node format: standard, compact or hdr",
                             nodeFormatNamed);
  addList<std::uint32_t>(command, "--samples", matrix.samples, "1, 2, 4 or 8", sampleCount);
  addList<VitrailResolve>(command, "--resolve", matrix.resolves, "a resolve: compute or fragment", resolveNamed);
  addList<VitrailListBuild>(command, "--list-build", matrix.listBuilds, "a list build: fragment or compute",
                            listBuildNamed);
  addList<VitrailMsaaResolve>(command, "--msaa-resolve", matrix.msaaResolves,
                              "a resolve of samples: per-pixel or per-sample", msaaResolveNamed);
  addList<StencilMark>(command, "--stencil-mark", matrix.stencilMarks, "on or off", stencilMarkNamed);
  addChoice(command, "--overflow", "grow and approximate", arguments.overflow, overflowNamed);
  constexpr const char* kPositive = "a whole number from 1";
  addList<std::uint32_t>(command, "--node-capacity", matrix.nodeCapacities, kPositive, positive);
  addList<std::uint32_t>(command, "--memory-budget", matrix.memoryBudgets, kPositive, positive);
  addList<std::uint32_t>(command, "--layers", matrix.layers, kPositive, positive);
  addPositive(command, "--passes", matrix.limits.passes);
}

void checkBenchArguments(const CLI::App& command, BenchArguments& arguments) {
  takeLayers(arguments);
  checkMemory(command, arguments);
  checkChoices(command, arguments.matrix.methods);
  checkLoadOptions(arguments.load, !arguments.model.empty());
  if (!arguments.model.empty()) {
    if (!arguments.scenes.empty()) throw UsageError("a model file and --scene exclude each other: name one of them");
    if (!arguments.counts.empty()) throw UsageError("--count is for built-in scenes: add --scene NAME");
  }
  if (!arguments.sweeps.empty()) return checkSweeps(command, arguments);
  if (!arguments.model.empty()) return;
  if (arguments.scenes.empty()) arguments.scenes = {"spheres", "planes", "hairball"};
  const std::size_t counts = arguments.counts.size();
  if (counts > 1 && counts != arguments.scenes.size()) {
    throw UsageError(fmt::format("--count has {} numbers for {} scenes: give one for all, or one for each", counts,
                                 arguments.scenes.size()));
  }
}

} // namespace vitrail::tool
