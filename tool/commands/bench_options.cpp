#include "bench_options.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

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
  --size WxH            pixels (default 1280x720; of sweeps on a CPU 320x180)
  --opacity A           makes every material translucent, 0.004 to 1

What grows, step by step (one scene, default spheres):
  --sweep NAME,...      layers       1, 2, 4, ... 64 panes (on a CPU 32), of the scene planes
                        triangles    every triangle is split into 4, again and again
                        resolution   320x180 to 3840x2160 (on a CPU 160x90 to 960x540)
                        samples      1, 2, 4 and 8 a pixel

What to compare with method unsorted, which is always measured:
  --methods NAME,...    methods of vitrail render (default: all)
  --nodes F,...         node formats of methods that have a choice: standard, compact, hdr
                        (default hdr)
  --samples N,...       1, 2, 4, 8 (default 1)
  --resolve R,...       resolves of such methods: compute, fragment (default: the library's choice)
  --list-build L,...    list builds of such methods: fragment, compute (default: the library's choice)
  --layers N, --passes N
                        as of vitrail render, of the methods that have them; the others stay as they
                        are

How often:
  --repeat N            rounds, each of which draws one frame of every setting, and of every step of
                        a sweep (default 31, on a CPU 3)
  --warmup N            frames of every setting before the first round (default 3, on a CPU 1)

Where to:
  -o, --output DIR      a folder, made where there is none, for index.html, one page that needs
                        nothing beside it, report.json and report.csv; files appear whole
  --json FILE           everything that was measured; the file appears whole or not at all
  --csv FILE            one row for each measurement
  --quiet               print nothing but errors
  --strict              fail where there would be a warning: where the picture lacks something
                        that the file has, or shows nothing

Which device:
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

std::string benchHelp() { return withDeviceHelp(withText(kBenchHelp, "@load@", kLoadHelp)); }

void addBenchOptions(CLI::App& command, BenchArguments& arguments) {
  command.add_option("MODEL", arguments.model);
  command.add_option("--json", arguments.json);
  command.add_option("--csv", arguments.csv);
  command.add_option("-o,--output", arguments.folder);
  addList<SweepKind>(command, "--sweep", arguments.sweeps, "a sweep: layers, triangles, resolution or samples",
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
  addList<VitrailNodeFormat>(command, "--nodes", matrix.nodes, "a node format: standard, compact or hdr",
                             nodeFormatNamed);
  addList<std::uint32_t>(command, "--samples", matrix.samples, "1, 2, 4 or 8", sampleCount);
  addList<VitrailResolve>(command, "--resolve", matrix.resolves, "a resolve: compute or fragment", resolveNamed);
  addList<VitrailListBuild>(command, "--list-build", matrix.listBuilds, "a list build: fragment or compute",
                            listBuildNamed);
  addLimits(command, matrix.limits);
}

void checkBenchArguments(const CLI::App& command, BenchArguments& arguments) {
  checkLimitsOf(arguments.matrix.methods, arguments.matrix.limits);
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
