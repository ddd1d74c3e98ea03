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
  Device device(deviceFor(arguments.device, arguments.validate, arguments.methods, arguments.apis));
  const Machine machine = machineOf(device);
  ComparisonRun run;
  run.methods = arguments.methods;
  run.apis = arguments.apis;
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

// The names of a method's files.
std::string stemOf(std::string_view method, Api api) {
  return std::string(method) + (api == Api::OpenGl && !traitsOf(method).onProcessor ? "-opengl" : "");
}
std::string pictureName(std::string_view stem) { return fmt::format("{}.png", stem); }
std::string errorName(std::string_view stem) { return fmt::format("{}-error.png", stem); }

// The files of a folder: those of some methods, or with none named of whatever methods.
std::vector<std::string> namesInFolder(std::vector<std::string> methods, const std::vector<Api>& apis) {
  if (methods.empty()) methods.assign(methodNames().begin(), methodNames().end());
  methods.emplace_back(kBaselineMethod);
  std::vector<std::string> names{"report.json", "index.html", "exact.png", "layers.png"};
  for (const std::string& method : methods) {
    for (const Api api : apis) {
      names.push_back(pictureName(stemOf(method, api)));
      names.push_back(errorName(stemOf(method, api)));
    }
  }
  return names;
}

void writeFolder(OutputFolder& folder, const Comparison& comparison, const std::string& json) {
  const ComparisonPictures pictures = encodePictures(comparison);
  folder.write("exact.png", pictures.exact);
  folder.write("layers.png", pictures.layers);
  for (std::size_t i = 0; i < pictures.methods.size(); ++i) {
    const MethodOptions& options = comparison.methods[i].measurement.options;
    const std::string stem = stemOf(options.name, options.api);
    folder.write(pictureName(stem), pictures.methods[i].picture);
    folder.write(errorName(stem), pictures.methods[i].error);
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
  if (folder) folder->check(namesInFolder(arguments.methods, arguments.apis));
  if (folder && report) checkApart(*folder, namesInFolder({}, arguments.apis), "--json", *report);

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
  setHelpPage(*command, withApiHelp(withDeviceHelp(withSceneHelp(kCompareHelp)), true));
  const auto arguments = std::make_shared<CompareArguments>();
  addCompareOptions(*command, *arguments);
  command->callback([command, arguments, &run] { run = [command, arguments] { runCompare(*command, *arguments); }; });
}

} // namespace vitrail::tool
