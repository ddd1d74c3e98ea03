// `vitrail info`: the Vulkan devices of this machine and what each can do for Vitrail.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "../gpu/device.h"
#include "commands.h"

namespace vitrail::tool {

namespace {

constexpr const char* kInfoHelp =
    R"(Lists the Vulkan devices of this machine, their drivers, the limits that bound a picture,
and what each device can and cannot do for Vitrail.

Usage:
  vitrail info

The number in front of a device, or a part of its name, is what --device takes.
)";

constexpr double kMebibyte = 1024.0 * 1024.0;
constexpr double kNodeBytes = 12.0; // the standard node format

std::string sizeText(std::uint64_t bytes) {
  const double mebibytes = static_cast<double>(bytes) / kMebibyte;
  return mebibytes < 10240.0 ? fmt::format("{:.0f} MiB", mebibytes) : fmt::format("{:.1f} GiB", mebibytes / 1024.0);
}

void line(const char* label, const std::string& text) { fmt::print("     {:<15}{}\n", label, text); }

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
}

void runInfo() {
  fmt::print("Vulkan devices\n");
  for (const DeviceSummary& device : listDevices()) printDevice(device);
}

} // namespace

void addInfoCommand(CLI::App& app, std::function<void()>& run) {
  addPlainCommand(app, run, "info", kInfoHelp, runInfo);
}

} // namespace vitrail::tool
