// `vitrail render`: models or a built-in scene in, a picture out, or those of a turn.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../render/device.h"
#include "../report/frame.h"
#include "../scene/volume.h"
#include "commands.h"
#include "device_options.h"
#include "errors.h"
#include "method_choice.h"
#include "output_file.h"
#include "output_format.h"
#include "progress.h"
#include "render_options.h"
#include "turntable_output.h"

namespace vitrail::tool {

namespace {

// What is drawn, and how all of its pictures are.
struct Job {
  const RenderArguments& arguments;
  OutputFormat format;
  const Progress& progress;
  Scene scene; // given away when it is drawn
  RenderOptions options;
  std::vector<View> views{}; // of a turn
  std::vector<std::string> warnings{};
  std::string emptyWarning{}; // of a picture that shows nothing
};

Job prepare(const RenderArguments& arguments, const Progress& progress) {
  Job job{arguments, outputFormatOf(arguments), progress, openScene(arguments, progress), {}};
  job.options = pictureOf(arguments, job.scene);
  job.options.encoding = encodingOf(job.format);
  if (arguments.memoryBudget) job.options.memoryBudget = std::uint64_t{*arguments.memoryBudget} << 20U;
  if (job.format.kind == FileKind::Mp4 && job.options.background.kind == Background::Kind::Transparent) {
    throw UsageError("a film has no alpha: choose another --background, or write pictures: -o frame_%04d.png");
  }
  job.options.peel = arguments.peel.value_or(0);
  job.options.onTile = [&progress](std::uint32_t tiles) {
    progress.show(fmt::format("drawing: {} tiles done", tiles));
  };
  if (arguments.turntable) {
    const float aspect = static_cast<float>(arguments.width) / static_cast<float>(arguments.height);
    job.views = turntableOf(arguments, job.scene, aspect, *arguments.turntable);
    job.options.view = job.views.front();
  }
  job.warnings = job.scene.warnings;
  job.emptyWarning = nothingSeenWarning(job.scene, seenOf(job.options, arguments.opacity));
  progress.show("preparing");
  return job;
}

// Light goes its true way through volumes by lists on a Vulkan device alone: worth one where nothing else was asked
// for.
Device openDevice(const Job& job) {
  const RenderArguments& arguments = job.arguments;
  Wish wish = arguments.wish;
  if (wish == Wish::Fastest && job.scene.clipPlanes.empty() && Solids(job.scene, false).any()) {
    wish = Wish::VulkanIfThere;
  }
  const bool openGl = arguments.method.api == Api::OpenGl;
  return Device({arguments.device, arguments.validate, wish, !openGl, openGl});
}

// The faster one of a GPU, for the many pictures of a turn. One picture is drawn by lists, which count what they draw,
// and so are those whose report is asked for.
std::string methodOfTurn(const Device& device, const Job& job) {
  const RenderArguments& arguments = job.arguments;
  const bool asksLists = arguments.peel || !arguments.json.empty() || arguments.method.api != Api::Vulkan;
  if (!arguments.turntable || asksLists || device.gpu() == nullptr || !drawsAlike(job.scene)) {
    return device.exactMethod().name;
  }
  return methodFor(*device.gpu(), *arguments.turntable, [&] { job.progress.show("measuring the device, this once"); });
}

// Where neither a method nor anything else of one was asked for, the device has its own exact one.
std::unique_ptr<Renderer> makeRenderer(const Device& device, Job& job) {
  MethodOptions method = job.arguments.method;
  if (job.arguments.wish == Wish::Fastest) method.name = methodOfTurn(device, job);
  return device.makeRenderer(std::move(job.scene), job.arguments.opacity, method);
}

RenderResult renderOne(Job& job) {
  Device device = openDevice(job);
  RenderResult result;
  {
    const std::unique_ptr<Renderer> renderer = makeRenderer(device, job);
    job.progress.show("drawing");
    result = renderer->render(job.options);
  }
  closeValidated(device);
  return result;
}

std::vector<NamedFrame> renderTurn(Job& job, TurntableOutput& output) {
  const RenderArguments& arguments = job.arguments;
  const std::uint32_t count = *arguments.turntable;
  Device device = openDevice(job);
  std::vector<NamedFrame> frames;
  {
    const std::unique_ptr<Renderer> renderer = makeRenderer(device, job);
    RenderOptions options = job.options;
    options.onTile = nullptr;
    for (std::uint32_t i = 0; i < count; ++i) {
      job.progress.show(fmt::format("picture {} of {}", i + 1, count), i, count);
      options.view = job.views[i];
      const RenderResult result = renderer->render(options);
      output.add(result);
      frames.push_back({output.nameOf(i), result.report});
    }
  }
  closeValidated(device);
  return frames;
}

// Tells the warnings: of the scene, of how it was drawn, and why all pictures are empty, if they are.
std::vector<std::string> warn(const Job& job, const std::vector<std::string>& drawn, bool isEmpty) {
  std::vector<std::string> warnings = job.warnings;
  warnings.insert(warnings.end(), drawn.begin(), drawn.end());
  if (isEmpty) warnings.push_back(job.emptyWarning);
  job.progress.show("");
  reportWarnings(warnings, job.arguments);
  return warnings;
}

// To standard output, unless that is taken.
void tell(const RenderArguments& arguments, bool outputIsTaken, const std::string& name, const std::string& summary) {
  if (arguments.quiet) return;
  if (isStandardOutput(arguments)) {
    fmt::print(stderr, "{}: {}\n", name, summary);
  } else if (!outputIsTaken) {
    fmt::print("{}: {}\n", name, summary);
  }
}

void runStill(const RenderArguments& arguments, std::optional<OutputFile>& report) {
  if (isStandardOutput(arguments) && ::isatty(STDOUT_FILENO) != 0) {
    throw UsageError(
        "standard output is a terminal: send the picture to a program, as in -o - | display, or name a file");
  }
  OutputFile picture = isStandardOutput(arguments) ? OutputFile::standardOutput() : OutputFile(arguments.output);
  checkNotRead(picture, arguments.models);
  if (report && report->isSameAs(picture)) throw UsageError("-o and --json name the same file");

  const Progress progress(!arguments.quiet, Progress::Shown::AfterASecond);
  Job job = prepare(arguments, progress);
  RenderResult result = renderOne(job);
  result.report.warnings = warn(job, result.report.warnings, result.isEmpty);
  progress.show("writing");
  const std::vector<std::byte> bytes = encodePicture(result, job.format);
  const std::string json = toJson(result.report);
  progress.show("");
  picture.write(bytes);
  if (report) report->write(std::as_bytes(std::span(json)));
  picture.commit();
  if (report) report->commit();
  tell(arguments, picture.isSpecial() || (report && report->isSpecial()), picture.name(), toSummary(result.report));
}

void runTurn(const RenderArguments& arguments, std::optional<OutputFile>& report) {
  TurntableOutput output(arguments, outputFormatOf(arguments), arguments.width, arguments.height);
  if (report && output.has(*report)) throw UsageError("-o and --json name the same file");

  const Progress progress(!arguments.quiet, Progress::Shown::AfterASecond);
  Job job = prepare(arguments, progress);
  // What is known before the first picture: the files of a turn appear one by one.
  if (arguments.strict) reportWarnings(job.warnings, arguments);
  const std::vector<NamedFrame> frames = renderTurn(job, output);
  const std::vector<std::string> warnings = warn(job, frames.front().report.warnings, output.isEmpty());
  const std::string json = toJson(frames, warnings);
  if (report) report->write(std::as_bytes(std::span(json)));
  output.finish();
  if (report) report->commit();
  tell(arguments, report && report->isSpecial(), output.name(), toSummary(frames));
}

void runRender(RenderArguments arguments) {
  checkRenderArguments(arguments);
  std::optional<OutputFile> report;
  if (!arguments.json.empty()) report.emplace(arguments.json);
  if (report) checkNotRead(*report, arguments.models);
  arguments.turntable ? runTurn(arguments, report) : runStill(arguments, report);
}

} // namespace

void addRenderCommand(CLI::App& app, std::function<void()>& run) {
  CLI::App* command = app.add_subcommand("render");
  setHelpPage(*command, renderHelp());
  const auto arguments = std::make_shared<RenderArguments>();
  addRenderOptions(*command, *arguments);
  command->callback([arguments, &run] { run = [arguments] { runRender(*arguments); }; });
}

} // namespace vitrail::tool
