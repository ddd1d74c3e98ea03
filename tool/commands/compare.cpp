// `vitrail compare`: how far pictures are from each other, and transparency methods from the exact picture.
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../bench/matrix.h"
#include "../compare/comparison.h"
#include "../methods/methods.h"
#include "../report/comparison_json.h"
#include "../report/comparison_page.h"
#include "../report/comparison_table.h"
#include "commands.h"
#include "compare_options.h"
#include "device_options.h"
#include "file_comparison.h"
#include "output_folder.h"
#include "progress.h"

namespace vitrail::tool {

namespace {

Comparison measure(const CompareArguments& arguments) {
  const Progress progress(!arguments.quiet);
  progress.show("preparing");
  const Scene scene = openScene(arguments, progress);
  progress.show("");
  const RenderOptions picture = pictureOf(arguments, scene);
  std::vector<std::string> warnings = scene.warnings;
  const bool isUnseen = warnIfUnseen(scene, seenOf(picture, arguments.opacity), warnings);
  reportWarnings(warnings, arguments);
  Device device({arguments.device, arguments.validate, wishFor(arguments.methods)});
  const Machine machine = machineOf(device);
  ComparisonRun run;
  run.methods = arguments.methods;
  run.samples = arguments.samples;
  run.limits = arguments.limits;
  run.picture = picture;
  run.opacity = arguments.opacity;
  run.repeats = roundsOn(machine, arguments.repeats);
  run.warmups = warmupsOn(machine, arguments.warmups);
  run.progress = [&](const std::string& step) { progress.show(step); };
  Comparison comparison = compareMethods(device, scene, run);
  comparison.scene = nameOfScene(arguments);
  comparison.count = arguments.count;
  closeValidated(device);
  if (comparison.isEmpty && !isUnseen) { // for a reason that the scene alone does not show
    progress.show("");
    warnings.push_back(nothingSeenWarning(scene, seenOf(picture, arguments.opacity)));
    reportWarnings(std::span(warnings).last(1), arguments);
  }
  comparison.warnings = std::move(warnings);
  return comparison;
}

std::string pictureName(std::string_view method) { return fmt::format("{}.png", method); }
std::string errorName(std::string_view method) { return fmt::format("{}-error.png", method); }

// The files of a folder: those of some methods, or with none named of whatever methods.
std::vector<std::string> namesInFolder(std::vector<std::string> methods) {
  if (methods.empty()) methods.assign(methodNames().begin(), methodNames().end());
  methods.emplace_back(kBaselineMethod);
  std::vector<std::string> names{"report.json", "index.html", "exact.png", "layers.png"};
  for (const std::string& method : methods) {
    names.push_back(pictureName(method));
    names.push_back(errorName(method));
  }
  return names;
}

void writeFolder(OutputFolder& folder, const Comparison& comparison, const std::string& json) {
  const ComparisonPictures pictures = encodePictures(comparison);
  folder.write("exact.png", pictures.exact);
  folder.write("layers.png", pictures.layers);
  for (std::size_t i = 0; i < pictures.methods.size(); ++i) {
    const std::string& name = comparison.methods[i].measurement.options.name;
    folder.write(pictureName(name), pictures.methods[i].picture);
    folder.write(errorName(name), pictures.methods[i].error);
  }
  folder.write("report.json", std::as_bytes(std::span(json)));
  const std::string page = toPage(comparison, pictures, json);
  folder.write("index.html", std::as_bytes(std::span(page)));
}

void compareOnDevice(const CompareArguments& arguments) {
  std::optional<OutputFile> report;
  std::optional<OutputFolder> folder;
  if (!arguments.json.empty()) report.emplace(arguments.json);
  if (report) checkNotRead(*report, arguments.models);
  if (!arguments.folder.empty()) folder.emplace(arguments.folder);
  if (folder) folder->check(namesInFolder(arguments.methods));
  if (folder && report) checkApart(*folder, namesInFolder({}), "--json", *report);

  const Comparison comparison = measure(arguments);

  const std::string json = toJson(comparison);
  if (folder) writeFolder(*folder, comparison, json);
  if (report) report->write(std::as_bytes(std::span(json)));
  if (folder) folder->commit();
  if (report) report->commit();
  const bool outputIsTaken = report && report->isSpecial(); // it may be standard output
  if (arguments.quiet || outputIsTaken) return;
  fmt::print("{}", toTable(comparison));
  if (folder) fmt::print("\n{}\n", (std::filesystem::path(arguments.folder) / "index.html").string());
}

void runCompare(const CLI::App& command, CompareArguments arguments) {
  checkCompareArguments(command, arguments);
  if (arguments.pictures()) {
    compareFiles({arguments.files[0], arguments.files[1], arguments.heatmap, arguments.json, arguments.quiet});
  } else {
    compareOnDevice(arguments);
  }
}

} // namespace

void addCompareCommand(CLI::App& app, std::function<void()>& run) {
  CLI::App* command = app.add_subcommand("compare");
  setHelpPage(*command, withDeviceHelp(withSceneHelp(kCompareHelp)));
  const auto arguments = std::make_shared<CompareArguments>();
  addCompareOptions(*command, *arguments);
  command->callback([command, arguments, &run] { run = [command, arguments] { runCompare(*command, *arguments); }; });
}

} // namespace vitrail::tool
