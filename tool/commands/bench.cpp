// `vitrail bench`: what transparency methods cost on a device, against blending in no order, and which one to use.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "../bench/bandwidth.h"
#include "../bench/runner.h"
#include "../report/bench_csv.h"
#include "../report/bench_json.h"
#include "../report/bench_page.h"
#include "../report/bench_table.h"
#include "../scene/split.h"
#include "bench_options.h"
#include "commands.h"
#include "device_options.h"
#include "errors.h"
#include "output_file.h"
#include "output_folder.h"
#include "progress.h"
#include "scene_options.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kSweepCount = 8; // spheres whose triangles are split, and of all sweeps on a CPU's driver

// A scene that is measured, and what it is called.
struct Subject {
  std::string name;
  std::optional<std::uint32_t> count;
  Scene scene;
};

Subject openNamed(const std::string& name, std::optional<std::uint32_t> count) {
  BuiltinOptions options;
  options.count = count;
  return {name, count, openBuiltin(name, options)};
}

// Subject `index` of the scenes that were asked for.
Subject openSubject(const BenchArguments& arguments, std::size_t index) {
  if (!arguments.model.empty()) {
    return {std::filesystem::path(arguments.model).filename().string(), {}, openModel(arguments.model, arguments.load)};
  }
  std::optional<std::uint32_t> count;
  if (!arguments.counts.empty()) count = arguments.counts[arguments.counts.size() > 1 ? index : 0];
  return openNamed(arguments.scenes[index], count);
}

BenchReport describeRun(const BenchArguments& arguments, const Device& device) {
  BenchReport report;
  static_cast<Machine&>(report) = machineOf(device);
  report.repeats = roundsOn(report, arguments.repeats);
  report.warmups = warmupsOn(report, arguments.warmups);
  report.limits = arguments.matrix.limits;
  return report;
}

// How one picture of a scene is measured. What the options do not allow goes to `skipped`.
BenchRun runOf(const BenchArguments& arguments, const BenchReport& report, const Scene& scene, const SweepStep& step,
               std::vector<SkippedSetting>& skipped) {
  BenchMatrix matrix = arguments.matrix;
  if (step.samples != 0) matrix.samples = {step.samples};
  if (step.cap != 0) matrix.limits.layers = step.cap;
  BenchSettings settings = configurationsOf(matrix);
  SceneArguments view; // of the file's first camera, or the three-quarter view
  view.width = step.width;
  view.height = step.height;
  BenchRun run;
  run.settings = std::move(settings.measured);
  run.picture = pictureOf(view, scene);
  run.opacity = arguments.opacity;
  run.repeats = report.repeats;
  run.warmups = report.warmups;
  run.bytesPerSecond = report.bytesPerSecond;
  skipped = std::move(settings.skipped);
  return run;
}

// Adds what was measured under its name, with what the options had not allowed.
void addScene(BenchReport& report, SceneMeasurement measured, const Subject& subject,
              const std::vector<SkippedSetting>& refused) {
  measured.name = subject.name;
  measured.count = subject.count;
  measured.skipped.insert(measured.skipped.begin(), refused.begin(), refused.end());
  report.scenes.push_back(std::move(measured));
}

void measureScenes(Device& device, const BenchArguments& arguments, const std::vector<Subject>& subjects,
                   const Progress& progress, BenchReport& report) {
  SweepStep all; // one for all
  all.width = arguments.width != 0 ? arguments.width : 1280;
  all.height = arguments.width != 0 ? arguments.height : 720;
  all.samples = 0; // those of the matrix
  for (const Subject& subject : subjects) {
    std::vector<SkippedSetting> refused;
    BenchRun run = runOf(arguments, report, subject.scene, all, refused);
    run.progress = [&](const std::string& what) { progress.show(fmt::format("{}: {}", subject.name, what)); };
    addScene(report, measureScene(device, subject.scene, run), subject, refused);
  }
}

// The scene of a sweep over something other than layers. Where no count was chosen the sweep has its own.
Subject subjectOf(const BenchArguments& arguments, SweepKind kind, const Subject& chosen, bool isSlow) {
  const bool isDefault = arguments.model.empty() && arguments.counts.empty() && chosen.name == "spheres";
  return isDefault && (isSlow || kind == SweepKind::Triangles) ? openNamed(chosen.name, kSweepCount) : chosen;
}

void measureSweep(Device& device, const BenchArguments& arguments, SweepKind kind, const Subject& chosen,
                  const Progress& progress, BenchReport& report) {
  const Subject base =
      kind == SweepKind::Layers ? Subject{"planes", {}, {}} : subjectOf(arguments, kind, chosen, report.isSlow());
  SweepStart start;
  start.isSlow = report.isSlow();
  start.width = arguments.width != 0 ? arguments.width : start.isSlow ? 320 : 1280;
  start.height = arguments.width != 0 ? arguments.height : start.isSlow ? 180 : 720;
  start.samples = arguments.matrix.samples.front();
  start.triangles = triangleCount(base.scene);
  if (!arguments.caps.empty()) start.caps = arguments.caps;
  const std::vector<SweepStep> steps = planSweep(kind, start);
  std::vector<std::vector<SkippedSetting>> refused(steps.size());

  std::vector<SceneMeasurement> measured = measureSteps(device, steps.size(), [&](std::size_t i) {
    BenchStep made;
    made.scene =
        steps[i].panes ? openNamed(base.name, steps[i].panes).scene : splitTriangles(base.scene, steps[i].splits);
    made.run = runOf(arguments, report, made.scene, steps[i], refused[i]);
    made.run.progress = [&progress, kind](const std::string& what) {
      progress.show(fmt::format("{}: {}", nameOf(kind), what));
    };
    made.place = fmt::format("step {} of {}", i + 1, steps.size());
    return made;
  });
  for (std::size_t i = 0; i < steps.size(); ++i) {
    measured[i].sweep = placeOf(kind, steps[i], measured[i].triangles);
    addScene(report, std::move(measured[i]), {base.name, steps[i].panes ? steps[i].panes : base.count, {}}, refused[i]);
  }
}

BenchReport measure(const BenchArguments& arguments) {
  const Progress progress(!arguments.quiet);
  progress.show("preparing");
  const std::size_t count = arguments.model.empty() ? arguments.scenes.size() : 1;
  std::vector<Subject> subjects;
  for (std::size_t i = 0; i < count; ++i) subjects.push_back(openSubject(arguments, i));
  progress.show("");
  std::vector<std::string> warnings;
  for (const Subject& subject : subjects) {
    warnings.insert(warnings.end(), subject.scene.warnings.begin(), subject.scene.warnings.end());
    SceneArguments view;
    view.width = arguments.width != 0 ? arguments.width : view.width;
    view.height = arguments.height != 0 ? arguments.height : view.height;
    warnIfUnseen(subject.scene, seenOf(pictureOf(view, subject.scene), arguments.opacity), warnings);
  }
  reportWarnings(warnings, arguments);

  Device device(deviceFor(arguments.device, false, arguments.matrix.methods, arguments.matrix.apis));
  BenchReport report = describeRun(arguments, device);
  report.warnings = std::move(warnings);
  if (device.gpu() != nullptr) report.bytesPerSecond = measureBandwidth(*device.gpu());
  if (arguments.sweeps.empty()) measureScenes(device, arguments, subjects, progress, report);
  for (const SweepKind kind : arguments.sweeps) measureSweep(device, arguments, kind, subjects[0], progress, report);
  return report;
}

void runBench(const CLI::App& command, BenchArguments arguments) {
  checkBenchArguments(command, arguments);
  std::optional<OutputFile> jsonFile;
  std::optional<OutputFile> csvFile;
  std::optional<OutputFolder> folder;
  if (!arguments.json.empty()) jsonFile.emplace(arguments.json);
  if (!arguments.csv.empty()) csvFile.emplace(arguments.csv);
  const std::vector<std::string> read{arguments.model};
  if (jsonFile) checkNotRead(*jsonFile, read);
  if (csvFile) checkNotRead(*csvFile, read);
  if (jsonFile && csvFile && jsonFile->isSameAs(*csvFile)) {
    throw UsageError("--json and --csv name one file: give each its own");
  }
  if (!arguments.folder.empty()) folder.emplace(arguments.folder);
  const std::vector<std::string> names{"report.json", "report.csv", "index.html"};
  if (folder) folder->check(names);
  if (folder && jsonFile) checkApart(*folder, names, "--json", *jsonFile);
  if (folder && csvFile) checkApart(*folder, names, "--csv", *csvFile);

  const BenchReport report = measure(arguments);

  const std::string json = toJson(report);
  const std::string csv = toCsv(report);
  const std::string page = folder ? toBenchPage(json) : "";
  const auto bytesOf = [](const std::string& text) { return std::as_bytes(std::span(text)); };
  if (folder) {
    folder->write("report.json", bytesOf(json));
    folder->write("report.csv", bytesOf(csv));
    folder->write("index.html", bytesOf(page));
  }
  if (jsonFile) jsonFile->write(bytesOf(json));
  if (csvFile) csvFile->write(bytesOf(csv));
  if (folder) folder->commit();
  if (jsonFile) jsonFile->commit();
  if (csvFile) csvFile->commit();
  const bool outputIsTaken = (jsonFile && jsonFile->isSpecial()) || (csvFile && csvFile->isSpecial());
  if (arguments.quiet || outputIsTaken) return; // it may be standard output
  fmt::print("{}", toTable(report));
  if (folder) fmt::print("\n{}\n", (std::filesystem::path(arguments.folder) / "index.html").string());
}

} // namespace

void addBenchCommand(CLI::App& app, std::function<void()>& run) {
  CLI::App* command = app.add_subcommand("bench");
  setHelpPage(*command, benchHelp());
  const auto arguments = std::make_shared<BenchArguments>();
  addBenchOptions(*command, *arguments);
  command->callback([command, arguments, &run] { run = [command, arguments] { runBench(*command, *arguments); }; });
}

} // namespace vitrail::tool
