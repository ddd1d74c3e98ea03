#include "bench_options.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "errors.h"
#include "option_values.h"

namespace vitrail::tool {

const char* const kBenchHelp =
    R"(Measures what exact transparency costs on a device, against blending in no order.

Usage:
  vitrail bench [options]
  vitrail bench MODEL [options]
  vitrail bench --scene NAME,... [options]

Every choice is measured with every other, except those that a method does not have. Lists are separated by commas.

What to draw:
  MODEL                 a .gltf, .glb, .obj, .ply or .stl file
  --scene NAME,...      built-in scenes (default spheres,planes,hairball; vitrail scenes lists all)
  --count N,...         how many spheres, panes, ...: one number for all scenes, or one for each
  --size WxH            pixels (default 1280x720)
  --opacity A           makes every material translucent, 0.004 to 1

What to compare with method unsorted, which is always measured:
  --methods NAME,...    linked-list, insertion, sorted, sorted-triangles, unsorted,
                        depth-peeling, reverse-depth-peeling, dual-depth-peeling, stencil-routed, a-buffer,
                        weighted, moment, stochastic, loop, loop-64, interlock, multi-layer
                        (default linked-list,insertion)
  --nodes F,...         node formats of linked-list: standard, compact, hdr (default standard)
  --samples N,...       1, 2, 4, 8 (default 1)
  --resolve R,...       resolves of linked-list: compute, fragment (default: the library's choice)

How often:
  --repeat N            rounds, each of which draws one frame of every setting (default 31, on a CPU 3)
  --warmup N            frames of every setting before the first round (default 3, on a CPU 1)

Where to:
  --json FILE           everything that was measured; the file appears whole or not at all
  --quiet               print nothing but errors

Which device:
  --device D            a number or a part of a name from `vitrail info`, or cpu
                        (default: the best GPU, else the CPU)

Examples:
  vitrail bench
  vitrail bench --scene spheres,planes,hairball --count 400,32,4000 --size 1920x1080 --json h100.json
  vitrail bench engine.glb --opacity 0.25 --nodes compact,standard,hdr --samples 1,4
)";

namespace {

std::optional<std::uint32_t> sampleCount(const std::string& text) {
  constexpr std::array<std::string_view, 4> kCounts{"1", "2", "4", "8"};
  return std::ranges::count(kCounts, text) > 0 ? numberOf<std::uint32_t>(text) : std::nullopt;
}

} // namespace

void addBenchOptions(CLI::App& command, BenchArguments& arguments) {
  command.add_option("MODEL", arguments.model);
  command.add_option("--json", arguments.json);
  command.add_option("--device", arguments.device);
  command.add_flag("--quiet", arguments.quiet);
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
}

void checkBenchArguments(BenchArguments& arguments) {
  if (!arguments.model.empty()) {
    if (!arguments.scenes.empty()) throw UsageError("a model file and --scene exclude each other: name one of them");
    if (!arguments.counts.empty()) throw UsageError("--count is for built-in scenes: add --scene NAME");
    return;
  }
  if (arguments.scenes.empty()) arguments.scenes = {"spheres", "planes", "hairball"};
  const std::size_t counts = arguments.counts.size();
  if (counts > 1 && counts != arguments.scenes.size()) {
    throw UsageError(fmt::format("--count has {} numbers for {} scenes: give one for all, or one for each", counts,
                                 arguments.scenes.size()));
  }
}

} // namespace vitrail::tool
