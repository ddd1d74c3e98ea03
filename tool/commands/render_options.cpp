#include "render_options.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "errors.h"

namespace vitrail::tool {

const char* const kRenderHelp =
    R"(Draws a model with exact transparency and writes a PNG.

Usage:
  vitrail render MODEL -o FILE [options]
  vitrail render --scene NAME -o FILE [options]

What to draw:
  MODEL                 a .gltf, .glb, .obj, .ply or .stl file
  --scene NAME          a built-in scene (vitrail scenes lists them)
  --count N             how many spheres, planes, ... the scene has
  --seed S              another arrangement of the same scene (default 1)

How to look at it:
  --size WxH            pixels (default 1280x720)
  --camera N            camera N of the file, from 0 (default: the file's first camera;
                        without one the whole model is seen from a three-quarter view)
  --orbit AZ,EL[,ZOOM]  look from azimuth and elevation in degrees: 0,0 is the front, 90,0 the right,
                        0,90 the top; ZOOM 2 shows it twice as large
  --opacity A           X-ray: makes every material translucent, 0.004 to 1
  --background B        a colour as #rrggbb (sRGB), sky, or transparent (a PNG with alpha)

How to blend it:
  --method M            linked-list (default): exact. For comparisons: unsorted, plain blending in
                        the order of the file, wrong wherever a nearer surface comes first;
                        sorted, objects back to front, and sorted-triangles, the same for every
                        triangle, both wrong where surfaces cross or overlap in a cycle;
                        depth-peeling, front to back, and reverse-depth-peeling, back to front, a layer
                        a pass; dual-depth-peeling, two; stencil-routed, as many as there are samples;
                        a-buffer, linear arrays that are counted first;
                        insertion, lists as most published samples sort them
  --samples N           1 (default), 2, 4 or 8 samples a pixel, as the device offers
  --msaa-resolve R      per-pixel (default): the samples are blended and averaged at once.
                        per-sample: each is blended into a multisampled picture. The same picture
  --nodes F             how a fragment is stored: standard (default, 12 bytes), compact (8 bytes,
                        coarser colours and depths), hdr (16 bytes, brighter than white)
  --resolve R           where the lists are sorted: compute or fragment shaders (default: the faster
                        one of the device). The same picture
  --layers N            blends only the nearest N surfaces of a pixel exactly (default: all);
                        depth-peeling leaves the others out
  --memory-budget MIB   for fragments, at least 1; a picture that needs more is drawn in tiles, the
                        same picture (default: what the device can give)

Where to:
  -o, --output FILE     the picture, .png; it appears whole or not at all
  --json FILE           a report: fragments, layers, memory, GPU time of each pass
  --quiet               print nothing but errors

Which device:
  --device D            a number or a part of a name from `vitrail info`, or cpu
                        (default: the best GPU, else the CPU)
  --validate            run under the Vulkan validation layer; its errors fail the command

Examples:
  vitrail render engine.glb -o engine.png --opacity 0.25
  vitrail render car.gltf -o car.png --size 1920x1080 --orbit 30,15 --background '#202028'
  vitrail render --scene interlocked -o rings.png
)";

namespace {

constexpr std::uint32_t kMaxSide = 65536; // a sane bound; the device's own is checked when it is known

// The whole text as a number, or nothing.
template <class Number>
std::optional<Number> parse(std::string_view text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return {};
  return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0;;) {
    const std::size_t next = text.find(separator, at);
    parts.push_back(text.substr(at, next - at));
    if (next == std::string_view::npos) return parts;
    at = next + 1;
  }
}

void setSize(RenderArguments& arguments, const std::string& text) {
  const std::vector<std::string_view> parts = split(text, 'x');
  const auto width = parts.size() == 2 ? parse<std::uint32_t>(parts[0]) : std::nullopt;
  const auto height = parts.size() == 2 ? parse<std::uint32_t>(parts[1]) : std::nullopt;
  if (!width || !height || *width == 0 || *height == 0 || *width > kMaxSide || *height > kMaxSide) {
    throw CLI::ValidationError("--size", fmt::format("'{}' is not a size such as 1280x720", text));
  }
  arguments.width = *width;
  arguments.height = *height;
}

void setOrbit(RenderArguments& arguments, const std::string& text) {
  const std::vector<std::string_view> parts = split(text, ',');
  std::array<float, 3> values = {0.0F, 0.0F, 1.0F};
  bool good = parts.size() == 2 || parts.size() == 3;
  for (std::size_t i = 0; good && i < parts.size(); ++i) {
    const auto value = parse<float>(parts[i]);
    good = value.has_value() && std::isfinite(*value);
    if (good) values[i] = *value;
  }
  if (!good) {
    throw CLI::ValidationError("--orbit",
                               fmt::format("'{}' is not AZIMUTH,ELEVATION[,ZOOM], such as 35,20 or 0,90,2", text));
  }
  if (std::abs(values[1]) > 90.0F) throw CLI::ValidationError("--orbit", "the elevation is between -90 and 90");
  if (values[2] < 0.01F || values[2] > 100.0F)
    throw CLI::ValidationError("--orbit", "the zoom is between 0.01 and 100");
  arguments.orbit = Orbit{std::remainder(values[0], 360.0F), values[1], values[2]};
}

void setBackground(RenderArguments& arguments, const std::string& text) {
  Background background;
  if (text == "sky") {
    background.kind = Background::Kind::Sky;
  } else if (text == "transparent") {
    background.kind = Background::Kind::Transparent;
  } else {
    std::uint32_t value = 0;
    const char* end = text.data() + text.size();
    const bool shaped = text.size() == 7 && text[0] == '#';
    if (!shaped || std::from_chars(text.data() + 1, end, value, 16).ptr != end) {
      throw CLI::ValidationError("--background",
                                 fmt::format("'{}' is not a colour such as #20a0ff, nor sky or transparent", text));
    }
    for (int i = 0; i < 3; ++i) background.srgb[i] = static_cast<float>((value >> (16 - 8 * i)) & 0xffU) / 255.0F;
  }
  arguments.background = background;
}

void setOpacity(RenderArguments& arguments, const std::string& text) {
  const auto value = parse<float>(text);
  // The first opacity that the node format does not round to none.
  if (!value || !(*value >= 1.0F / 255.0F) || *value > 1.0F) {
    throw CLI::ValidationError("--opacity", fmt::format("'{}' is not between 1/255 (0.004) and 1", text));
  }
  arguments.opacity = *value;
}

// A whole number that fits; CLI11's own conversion takes -1 and 1e3 for some types.
void addCount(CLI::App& command, const std::string& name, std::optional<std::uint32_t>& target) {
  command.add_option_function<std::string>(name, [name, &target](const std::string& text) {
    target = parse<std::uint32_t>(text);
    if (!target) throw CLI::ValidationError(name, fmt::format("'{}' is not a whole number from 0", text));
  });
}

// A choice by name. `names` is what to say where there is none of that name.
template <typename Choice>
void addChoice(CLI::App& command, const std::string& name, const char* names, Choice& target,
               std::optional<Choice> (*named)(std::string_view)) {
  command.add_option_function<std::string>(name, [name, names, &target, named](const std::string& text) {
    const std::optional<Choice> choice = named(text);
    if (!choice) throw CLI::ValidationError(name, fmt::format("'{}' is none of {}", text, names));
    target = *choice;
  });
}

// A whole number from 1.
template <typename Target>
void addPositive(CLI::App& command, const std::string& name, Target& target) {
  command.add_option_function<std::string>(name, [name, &target](const std::string& text) {
    const auto value = parse<std::uint32_t>(text);
    if (!value || *value < 1) throw CLI::ValidationError(name, fmt::format("'{}' is not a whole number from 1", text));
    target = *value;
  });
}

void addMethodOptions(CLI::App& command, RenderArguments& arguments) {
  MethodOptions& method = arguments.method;
  command.add_option("--method", method.name);
  addPositive(command, "--samples", method.samples);
  addPositive(command, "--layers", method.maxLayers);
  addPositive(command, "--passes", method.passes);
  addPositive(command, "--memory-budget", arguments.memoryBudget);
  addChoice(command, "--nodes", "standard, compact and hdr", method.nodes, nodeFormatNamed);
  addChoice(command, "--resolve", "compute and fragment", method.resolve, resolveNamed);
  addChoice(command, "--msaa-resolve", "per-pixel and per-sample", method.msaaResolve, msaaResolveNamed);
}

void checkMethod(const RenderArguments& arguments) {
  try {
    checkMethodOptions(arguments.method);
    checkPictureOptions(arguments.method.name, arguments.memoryBudget.has_value(), false);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

} // namespace

void addRenderOptions(CLI::App& command, RenderArguments& arguments) {
  command.add_option("MODEL", arguments.model);
  command.add_option("--scene", arguments.scene);
  addCount(command, "--count", arguments.count);
  addCount(command, "--seed", arguments.seed);
  addCount(command, "--camera", arguments.camera);
  command.add_option("-o,--output", arguments.output);
  command.add_option("--json", arguments.json);
  command.add_option("--device", arguments.device);
  command.add_flag("--validate", arguments.validate);
  command.add_flag("--quiet", arguments.quiet);
  const auto text = [&](const char* name, void (*set)(RenderArguments&, const std::string&)) {
    command.add_option_function<std::string>(name,
                                             [&arguments, set](const std::string& value) { set(arguments, value); });
  };
  text("--size", setSize);
  text("--orbit", setOrbit);
  text("--background", setBackground);
  text("--opacity", setOpacity);
  addMethodOptions(command, arguments);
}

void checkRenderArguments(const RenderArguments& arguments) {
  if (arguments.model.empty() == arguments.scene.empty()) {
    throw UsageError(arguments.model.empty()
                         ? "nothing to draw: name a model file or a --scene (see vitrail render --help)"
                         : "a model file and --scene exclude each other: name one of them");
  }
  if (arguments.scene.empty() && (arguments.count || arguments.seed)) {
    throw UsageError("--count and --seed are for built-in scenes: add --scene NAME");
  }
  if (arguments.camera && arguments.orbit)
    throw UsageError("--camera and --orbit exclude each other: give one of them");
  checkMethod(arguments);
  if (arguments.output.empty()) throw UsageError("no output: add -o picture.png");
  const std::filesystem::path output(arguments.output);
  std::string extension = output.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension != ".png" && !output.native().starts_with("/dev/")) {
    throw UsageError(fmt::format("{}: pictures are written as .png", arguments.output));
  }
}

} // namespace vitrail::tool
