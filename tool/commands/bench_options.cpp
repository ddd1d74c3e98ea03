#include "bench_options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "errors.h"

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
  --methods NAME,...    linked-list, insertion, sorted, sorted-triangles, depth-peeling,
                        reverse-depth-peeling, dual-depth-peeling, stencil-routed, a-buffer, unsorted
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

constexpr std::uint32_t kMaxSide = 65536; // a sane bound; the device's own is checked when it is known
constexpr std::uint32_t kMaxFrames = 100000;

std::optional<std::uint32_t> wholeNumber(std::string_view text) {
  std::uint32_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return {};
  return value;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t at = 0;;) {
    const std::size_t next = text.find(separator, at);
    parts.push_back(text.substr(at, next - at));
    if (next == std::string::npos) return parts;
    at = next + 1;
  }
}

// An option that is a list of what `parse` understands of each part; `known` says in words what that is.
template <class Value>
void addList(CLI::App& command, const std::string& name, std::vector<Value>& target, const std::string& known,
             std::function<std::optional<Value>(const std::string&)> parse) {
  command.add_option_function<std::string>(name, [=, &target](const std::string& text) {
    target.clear();
    for (const std::string& part : split(text, ',')) {
      const std::optional<Value> value = parse(part);
      if (!value) throw CLI::ValidationError(name, fmt::format("'{}' is not {}", part, known));
      target.push_back(*value);
    }
  });
}

void addFrames(CLI::App& command, const std::string& name, std::optional<std::uint32_t>& target) {
  command.add_option_function<std::string>(name, [name, &target](const std::string& text) {
    target = wholeNumber(text);
    if (!target || *target < 1 || *target > kMaxFrames) {
      throw CLI::ValidationError(name, fmt::format("'{}' is not a whole number from 1 to {}", text, kMaxFrames));
    }
  });
}

void addSize(CLI::App& command, BenchArguments& arguments) {
  command.add_option_function<std::string>("--size", [&arguments](const std::string& text) {
    const std::vector<std::string> parts = split(text, 'x');
    const std::uint32_t width = parts.size() == 2 ? wholeNumber(parts[0]).value_or(0) : 0;
    const std::uint32_t height = parts.size() == 2 ? wholeNumber(parts[1]).value_or(0) : 0;
    if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
      throw CLI::ValidationError("--size", fmt::format("'{}' is not a size such as 1280x720", text));
    }
    arguments.width = width;
    arguments.height = height;
  });
}

void addOpacity(CLI::App& command, BenchArguments& arguments) {
  command.add_option_function<std::string>("--opacity", [&arguments](const std::string& text) {
    float value = 0.0F;
    const char* end = text.data() + text.size();
    // The first opacity that the standard node format does not round to none.
    if (std::from_chars(text.data(), end, value).ptr != end || !(value >= 1.0F / 255.0F) || value > 1.0F) {
      throw CLI::ValidationError("--opacity", fmt::format("'{}' is not between 1/255 (0.004) and 1", text));
    }
    arguments.opacity = value;
  });
}

std::optional<std::string> methodNamed(const std::string& name) {
  return std::ranges::count(methodNames(), name) > 0 ? std::optional(name) : std::nullopt;
}

std::optional<std::uint32_t> sampleCount(const std::string& text) {
  constexpr std::array<std::string_view, 4> kCounts{"1", "2", "4", "8"};
  return std::ranges::count(kCounts, text) > 0 ? wholeNumber(text) : std::nullopt;
}

} // namespace

void addBenchOptions(CLI::App& command, BenchArguments& arguments) {
  command.add_option("MODEL", arguments.model);
  command.add_option("--json", arguments.json);
  command.add_option("--device", arguments.device);
  command.add_flag("--quiet", arguments.quiet);
  addSize(command, arguments);
  addOpacity(command, arguments);
  addFrames(command, "--repeat", arguments.repeats);
  addFrames(command, "--warmup", arguments.warmups);
  BenchMatrix& matrix = arguments.matrix;
  addList<std::string>(command, "--scene", arguments.scenes, "the name of a scene",
                       [](const std::string& text) { return text.empty() ? std::nullopt : std::optional(text); });
  addList<std::uint32_t>(command, "--count", arguments.counts, "a whole number from 0", wholeNumber);
  addList<std::string>(command, "--methods", matrix.methods,
                       fmt::format("a method; there are {}", fmt::join(methodNames(), ", ")), methodNamed);
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
