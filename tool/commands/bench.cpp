// `vitrail bench`: what exact transparency costs on a device, against blending in no order.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "../bench/bandwidth.h"
#include "../bench/runner.h"
#include "../bench/table.h"
#include "bench_json.h"
#include "bench_options.h"
#include "commands.h"
#include "errors.h"
#include "output_file.h"
#include "progress.h"
#include "scene_options.h"

namespace vitrail::tool {

namespace {

// A scene that is measured, and what it is called.
struct Subject {
  std::string name;
  std::optional<std::uint32_t> count;
  Scene scene;
};

// Subject `index` of the scenes that were asked for.
Subject openScene(const BenchArguments& arguments, std::size_t index) {
  if (!arguments.model.empty()) {
    return {std::filesystem::path(arguments.model).filename().string(), {}, openModel(arguments.model)};
  }
  BuiltinOptions options;
  if (!arguments.counts.empty()) options.count = arguments.counts[arguments.counts.size() > 1 ? index : 0];
  const std::string& name = arguments.scenes[index];
  return {name, options.count, openBuiltin(name, options)};
}

BenchReport describeRun(const BenchArguments& arguments, const Gpu& gpu) {
  BenchReport report;
  static_cast<Machine&>(report) = machineOf(gpu);
  report.width = arguments.width;
  report.height = arguments.height;
  report.repeats = roundsOn(report, arguments.repeats);
  report.warmups = warmupsOn(report, arguments.warmups);
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
  SceneArguments view; // of the file's first camera, or the three-quarter view
  view.width = arguments.width;
  view.height = arguments.height;
  for (const Subject& subject : subjects) {
    BenchRun run;
    run.settings = configurationsOf(arguments.matrix);
    run.picture = pictureOf(view, subject.scene);
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
