// `vitrail info`: what is in model files; or the devices of this machine and what each can do for Vitrail.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../gpu/device.h"
#include "../methods/methods.h"
#include "../opengl/gl.h"
#include "../render/cpu_still.h"
#include "../render/device.h"
#include "../report/model_info.h"
#include "../scene/message.h"
#include "commands.h"
#include "errors.h"
#include "method_choice.h"
#include "progress.h"
#include "scene_options.h"

namespace vitrail::tool {

namespace {

constexpr const char* kInfoHelp =
    R"(Tells what is in model files; without one, lists what this machine can draw with: the processor,
Vulkan and OpenGL devices.

Usage:
  vitrail info MODEL... [--json]
  vitrail info

Of a model: its format and size, its box in the file's own coordinates, meshes, materials, images,
extensions and which of them are drawn, lights, cameras, animations, variants, and what a picture of
it lacks.

  --json                the same as JSON, on standard output

Of each device: its driver, the limits that bound a picture, and what it can and cannot do for
Vitrail. What stands in front of a device, or a part of its name, is what --device takes. The processor, cpu, draws by Vitrail's own rasteriser, without Vulkan; it stands first where
there is no GPU, and is the default there.

Examples:
  vitrail info car.glb
  vitrail info *.gltf --json
)";

struct InfoArguments {
  std::vector<std::string> models;
  bool json = false;
};

constexpr double kMebibyte = 1024.0 * 1024.0;
constexpr double kNodeBytes = 16.0; // of the default node format

std::string sizeText(std::uint64_t bytes) {
  const double mebibytes = static_cast<double>(bytes) / kMebibyte;
  return mebibytes < 10240.0 ? fmt::format("{:.0f} MiB", mebibytes) : fmt::format("{:.1f} GiB", mebibytes / 1024.0);
}

void line(const char* label, const std::string& text) { fmt::print("     {:<15}{}\n", label, text); }

// What draws in windows and turns where no method is named; empty: nothing was measured.
std::string methodText(const DeviceSummary& device) {
  const std::optional<std::filesystem::path> memory = methodMemory();
  if (!memory) return {};
  const std::optional<MethodCosts> costs = rememberedCosts(*memory, device.identity);
  if (!costs) return {};
  if (costs->tiles.empty()) return fmt::format("{}: the device does not offer {}", kListMethod, kTilesMethod);
  std::vector<std::string> times;
  for (std::size_t i = 0; i < costs->lists.size(); ++i) {
    times.push_back(fmt::format("{:.2f} and {:.2f} ms", costs->tiles[i].nextMs, costs->lists[i].nextMs));
  }
  return fmt::format("{} in windows and turns: {} and {} were measured with {} a picture",
                     fasterMethod(*costs, kPicturesOfAWindow), kTilesMethod, kListMethod, fmt::join(times, ", "));
}

void printDevice(const DeviceSummary& device) {
  fmt::print("  {:<3}{} ({})\n", device.index, device.name, device.kind);
  line("driver", device.driver);
  line("Vulkan", fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(device.apiVersion),
                             VK_API_VERSION_MINOR(device.apiVersion), VK_API_VERSION_PATCH(device.apiVersion)));
  if (!device.missing.empty()) {
    line("renders", fmt::format("no, it lacks {}", device.missing));
    return;
  }
  std::uint64_t pool = std::min(device.maxAllocationBytes, device.memoryBytes);
  if (!device.features.poolByAddress) pool = std::min(pool, device.maxBindingBytes);
  line("renders", "yes, exactly");
  line("memory", sizeText(device.memoryBytes));
  line("fragments", fmt::format("any number, {:.1f} M at once ({}): pictures with more are drawn in tiles",
                                static_cast<double>(pool) / kNodeBytes / 1e6, sizeText(pool)));
  line("samples", fmt::format("{} a pixel{}", sampleCountsText(device.features.sampleCounts),
                              device.features.postDepthCoverage ? "" : ", without post-depth coverage"));
  // Mesa's CPU driver ends a shader's loops after a number of turns (docs/resolve.md).
  const bool loopsEnd = device.driver.find("llvmpipe") != std::string::npos;
  line("layers", loopsEnd ? "at most about 15,000 in one pixel" : "any number in one pixel");
  line("picture", fmt::format("at most {0}x{0}", device.maxPictureSide));
  line("pass times", device.timestamps ? "yes" : "no, the queue has no timestamps");
  if (const std::string method = methodText(device); !method.empty()) line("method", method);
}

void printProcessor() {
  fmt::print("  {} {}\n", kProcessor, processorDevice());
  line("driver", "none: Vitrail's own rasteriser, without Vulkan");
  line("renders", "yes, exactly");
  line("fragments", "any number");
  line("samples", "1, 2, 4, 8 a pixel");
  line("layers", "any number in one pixel");
  line("picture", fmt::format("at most {0}x{0}", kMaxProcessorSide));
  line("pass times", "yes, by the clock");
}

void printDevice(const GlDeviceSummary& device) {
  fmt::print("  {:<3}{} ({})\n", device.index, device.name.empty() ? "a device" : device.name,
             device.isCpu ? "CPU" : "GPU");
  if (!device.missing.empty()) {
    line("renders", fmt::format("no, it lacks {}", device.missing));
    return;
  }
  line("driver", device.driver);
  line("OpenGL", device.version);
  line("renders", "yes, exactly, with --api opengl");
  line("samples", fmt::format("{} a pixel{}", sampleCountsText(device.sampleCounts),
                              device.postDepthCoverage ? "" : ", without post-depth coverage"));
  line("picture", fmt::format("at most {0}x{0}", device.maxPictureSide));
}

void printOpenGl() {
  std::vector<GlDeviceSummary> devices;
  try {
    devices = listGlDevices();
  } catch (const GpuError& error) {
    fmt::print("\nOpenGL devices\n  none: {}\n", error.what());
    return;
  }
  fmt::print("\nOpenGL devices\n");
  for (const GlDeviceSummary& device : devices) printDevice(device);
}

void runDevices() {
  std::vector<DeviceSummary> devices;
  std::string reason; // why there is none
  try {
    devices = listDevices();
  } catch (const GpuError& error) {
    reason = error.what();
  }
  const bool hasGpu = std::ranges::any_of(devices, isUsableGpu);
  fmt::print("Devices\n");
  if (!hasGpu) printProcessor();
  for (const DeviceSummary& device : devices) printDevice(device);
  if (hasGpu) printProcessor();
  if (devices.empty()) fmt::print("  no Vulkan device: {}\n", reason);
  printOpenGl();
}

// Of formats whose readers leave it to the name: OBJ.
std::string formatByName(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& c : extension) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return extension;
}

ModelInfo openInfo(const std::string& file) {
  ModelInfo model{file, 0, openModel(file, {})};
  std::error_code error;
  model.bytes = std::filesystem::file_size(file, error);
  if (error) model.bytes = 0;
  if (model.scene.file.format.empty()) model.scene.file.format = formatByName(file);
  return model;
}

void runInfo(const InfoArguments& arguments) {
  if (arguments.models.empty()) {
    if (arguments.json) throw UsageError("--json is of models: name one");
    return runDevices();
  }
  std::vector<ModelInfo> models;
  {
    const Progress progress(true, Progress::Shown::AfterASecond);
    for (const std::string& file : arguments.models) {
      progress.show(fmt::format("loading {}", printable(file)));
      models.push_back(openInfo(file));
    }
  }
  if (arguments.json) {
    fmt::print("{}", toJson(models));
  } else {
    for (const ModelInfo& model : models) fmt::print("{}", toText(model));
  }
}

} // namespace

void addInfoCommand(CLI::App& app, std::function<void()>& run) {
  CLI::App* command = app.add_subcommand("info");
  setHelpPage(*command, kInfoHelp);
  const auto arguments = std::make_shared<InfoArguments>();
  command->add_option("MODEL", arguments->models);
  command->add_flag("--json", arguments->json);
  command->callback([arguments, &run] { run = [arguments] { runInfo(*arguments); }; });
}

} // namespace vitrail::tool
