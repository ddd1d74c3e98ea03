#include "compare_options.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>

#include "device_options.h"
#include "errors.h"
#include "option_values.h"

namespace vitrail::tool {

const char* const kCompareHelp =
    R"(Compares transparency methods with the exact picture, or one picture with another.

Usage:
  vitrail compare MODEL... [options]
  vitrail compare --scene NAME [options]
  vitrail compare EXPECTED.png PICTURE.png [--heatmap FILE] [--json FILE] [--quiet]

Of each method: how far its picture is from the exact one (PSNR, SSIM, FLIP, the worst pixel, the
share of pixels that are off by more than 2/255), what it costs against plain blending in no order
(unsorted), and its memory. The exact picture is that of linked-list with hdr nodes, by Vulkan where
that is among the APIs.

@scene@

What to compare:
  --methods NAME,...    methods of vitrail render (default: all); unsorted is always there. What
                        the device or the options do not allow is listed with the reason
  --samples N           1 (default), 2, 4 or 8 samples a pixel
  --layers N, --passes N
                        as of vitrail render, of the methods that have them; the others, and the
                        exact picture, stay as they are
  --repeat N            rounds, each of which draws one frame with every method (default 31, on a
                        CPU 3)
  --warmup N            frames of every method before the first round (default 3, on a CPU 1)

Where to:
  -o, --output DIR      a folder, made where there is none, for index.html, one page that needs
                        nothing beside it, report.json and the pictures; files appear whole
  --heatmap FILE        of two pictures: the FLIP error of each pixel as a .png, dark to bright
  --json FILE           everything that was measured
  --quiet               print nothing but errors
  --strict              fail where there would be a warning: where the picture lacks something
                        that the file has, or shows nothing

Which device:
@api@
@device@
  --validate            run under the Vulkan validation layer, or with OpenGL's debug output, and fail
                        on any error

Examples:
  vitrail compare --scene interlocked -o comparison
  vitrail compare engine.glb --opacity 0.25 --methods linked-list,unsorted --size 1920x1080
  vitrail compare before.png after.png --heatmap difference.png
)";

namespace {

bool isPng(const std::string& file) { return std::filesystem::path(file).extension() == ".png"; }

bool isModel(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  constexpr std::array<std::string_view, 5> kModels{".gltf", ".glb", ".obj", ".ply", ".stl"};
  return std::ranges::find(kModels, extension) != kModels.end();
}

void takeModels(CompareArguments& arguments) {
  const auto picture = std::ranges::find_if(arguments.files, isPng);
  if (picture != arguments.files.end()) {
    throw UsageError(arguments.files.size() == 1
                         ? fmt::format("{} is a picture: name the picture to compare it with as well", *picture)
                         : fmt::format("{} is a picture: two pictures are compared, or models drawn", *picture));
  }
  arguments.models = arguments.files;
}

// Refuses options that only drawing has.
void checkFileOptions(const CLI::App& command) {
  for (const char* name :
       {"--scene",    "--count",   "--seed",      "--size",       "--up",         "--camera",     "--orbit",
        "--eye",      "--look-at", "--fov",       "--clip-plane", "--opacity",    "--background", "--methods",
        "--samples",  "--layers",  "--passes",    "--repeat",     "--warmup",     "--output",     "--device",
        "--validate", "--time",    "--animation", "--variant",    "--point-size", "--api"}) {
    if (command.count(name) > 0) {
      throw UsageError(fmt::format("{} is for comparing methods: two pictures are compared as they are", name));
    }
  }
}

} // namespace

bool CompareArguments::pictures() const { return files.size() == 2 && std::ranges::none_of(files, isModel); }

void addCompareOptions(CLI::App& command, CompareArguments& arguments) {
  command.add_option("FILES", arguments.files);
  addSceneOptions(command, arguments);
  addMethods(command, arguments.methods);
  addApis(command, arguments.apis);
  addPositive(command, "--samples", arguments.samples);
  addLimits(command, arguments.limits);
  addFrames(command, "--repeat", arguments.repeats);
  addFrames(command, "--warmup", arguments.warmups);
  command.add_option("-o,--output", arguments.folder);
  command.add_option("--heatmap", arguments.heatmap);
  command.add_option("--json", arguments.json);
  command.add_option("--device", arguments.device);
  command.add_flag("--validate", arguments.validate);
  addWarningOptions(command, arguments);
}

void checkCompareArguments(const CLI::App& command, CompareArguments& arguments) {
  if (arguments.pictures()) return checkFileOptions(command);
  takeModels(arguments);
  checkSceneArguments(arguments, "compare");
  if (arguments.samples != 1 && arguments.samples != 2 && arguments.samples != 4 && arguments.samples != 8) {
    throw UsageError(fmt::format("a pixel has 1, 2, 4 or 8 samples, not {}", arguments.samples));
  }
  checkLimitsOf(arguments.methods, arguments.limits);
  if (!arguments.heatmap.empty()) {
    throw UsageError("--heatmap is for two pictures: -o DIR has a heatmap of every method");
  }
}

} // namespace vitrail::tool
