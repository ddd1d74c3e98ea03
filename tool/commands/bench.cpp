// `vitrail bench`: what exact transparency costs on a device, against blending in no order.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>

#include <unistd.h>

#include "../bench/bandwidth.h"
#include "../bench/runner.h"
#include "../bench/table.h"
#include "../scene/builtin.h"
#include "../scene/load.h"
#include "bench_json.h"
#include "bench_options.h"
#include "commands.h"
#include "errors.h"
#include "output_file.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kGpuRepeats = 31;
constexpr std::uint32_t kGpuWarmups = 3;
constexpr std::uint32_t kCpuRepeats = 3; // a frame takes seconds there
constexpr std::uint32_t kCpuWarmups = 1;

// One line on the terminal that is written over and over; nothing where nobody watches.
class Progress {
 public:
  explicit Progress(bool wanted) : shown_(wanted && ::isatty(STDERR_FILENO) != 0) {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { show(""); }

  void show(const std::string& text) const {
    if (shown_) fmt::print(stderr, "\r\x1b[K{:.100}", text);
  }

 private:
  bool shown_;
};

// A scene that is measured, and what it is called.
struct Subject {
  std::string name;
  std::optional<std::uint32_t> count;
  Scene scene;
};

Subject openModel(const std::string& file) {
  try {
    return {std::filesystem::path(file).filename().string(), {}, loadModel(file)};
  } catch (const LoadError& error) {
    throw std::runtime_error(fmt::format("{}: {}", file, error.what()));
  }
}

// Subject `index` of the scenes that were asked for.
Subject openScene(const BenchArguments& arguments, std::size_t index) {
  if (!arguments.model.empty()) return openModel(arguments.model);
  BuiltinOptions options;
  if (!arguments.counts.empty()) options.count = arguments.counts[arguments.counts.size() > 1 ? index : 0];
  const std::string& name = arguments.scenes[index];
  try {
    return {name, options.count, makeBuiltinScene(name, options)};
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

// The view of the file's first camera, or the three-quarter view.
RenderOptions pictureOf(const BenchArguments& arguments, const Scene& scene) {
  RenderOptions options;
  options.width = arguments.width;
  options.height = arguments.height;
  const float aspect = static_cast<float>(arguments.width) / static_cast<float>(arguments.height);
  options.view = scene.cameras.empty() ? frameScene(scene, Orbit{}, aspect) : viewOf(scene.cameras[0]);
  options.background = scene.background.value_or(Background{});
  return options;
}

BenchReport describeRun(const BenchArguments& arguments, const Gpu& gpu) {
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &driver;
  vkGetPhysicalDeviceProperties2(gpu.physicalDevice(), &properties);
  BenchReport report;
  report.device = gpu.properties().deviceName;
  report.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
  report.api = "Vulkan 1.3";
  report.isCpu = gpu.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  report.width = arguments.width;
  report.height = arguments.height;
  report.repeats = arguments.repeats.value_or(report.isCpu ? kCpuRepeats : kGpuRepeats);
  report.warmups = arguments.warmups.value_or(report.isCpu ? kCpuWarmups : kGpuWarmups);
  return report;
}

BenchReport measure(const BenchArguments& arguments) {
  const Progress progress(!arguments.quiet);
  progress.show("preparing");
  const std::size_t count = arguments.model.empty() ? arguments.scenes.size() : 1;
  std::vector<Subject> subjects;
  for (std::size_t i = 0; i < count; ++i) subjects.push_back(openScene(arguments, i));

  Gpu gpu({arguments.device});
  BenchReport report = describeRun(arguments, gpu);
  report.bytesPerSecond = measureBandwidth(gpu);
  for (const Subject& subject : subjects) {
    BenchRun run;
    run.settings = configurationsOf(arguments.matrix);
    run.picture = pictureOf(arguments, subject.scene);
    run.opacity = arguments.opacity;
    run.repeats = report.repeats;
    run.warmups = report.warmups;
    run.bytesPerSecond = report.bytesPerSecond;
    run.progress = [&](const std::string& step) { progress.show(fmt::format("{}: {}", subject.name, step)); };
    SceneMeasurement measured = measureScene(gpu, subject.scene, run);
    measured.name = subject.name;
    measured.count = subject.count;
    report.scenes.push_back(std::move(measured));
  }
  return report;
}

void runBench(BenchArguments arguments) {
  checkBenchArguments(arguments);
  std::optional<OutputFile> file;
  if (!arguments.json.empty()) file.emplace(arguments.json);

  const BenchReport report = measure(arguments);

  const std::string json = toJson(report);
  if (file) {
    file->write(std::as_bytes(std::span(json)));
    file->commit();
  }
  const bool outputIsTaken = file && file->isSpecial(); // it may be standard output
  if (!arguments.quiet && !outputIsTaken) fmt::print("{}", toTable(report));
}

} // namespace

void addBenchCommand(CLI::App& app, std::function<void()>& run) {
  CLI::App* command = app.add_subcommand("bench");
  setHelpPage(*command, kBenchHelp);
  const auto arguments = std::make_shared<BenchArguments>();
  addBenchOptions(*command, *arguments);
  command->callback([arguments, &run] { run = [arguments] { runBench(*arguments); }; });
}

} // namespace vitrail::tool
