// `vitrail render`: a model or a built-in scene in, a picture out.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <span>
#include <stdexcept>

#include "../image/png_encode.h"
#include "../render/still.h"
#include "../report/frame.h"
#include "commands.h"
#include "errors.h"
#include "output_file.h"
#include "render_options.h"

namespace vitrail::tool {

namespace {

RenderResult renderScene(const RenderArguments& arguments, Scene scene) {
  RenderOptions options = pictureOf(arguments, scene);
  if (arguments.memoryBudget) options.memoryBudget = std::uint64_t{*arguments.memoryBudget} << 20U;

  Gpu gpu({arguments.device, arguments.validate});
  RenderResult result;
  {
    StillRenderer renderer(gpu, std::move(scene), arguments.opacity, arguments.method);
    result = renderer.render(options);
  }
  closeValidated(gpu);
  return result;
}

void runRender(const RenderArguments& arguments) {
  checkRenderArguments(arguments);
  OutputFile picture(arguments.output);
  std::optional<OutputFile> report;
  if (!arguments.json.empty()) report.emplace(arguments.json);
  if (report && report->isSameAs(picture)) throw UsageError("-o and --json name the same file");

  Scene scene = openScene(arguments);
  const std::vector<std::string> warnings = scene.warnings;
  RenderResult result = renderScene(arguments, std::move(scene));
  result.report.warnings.insert(result.report.warnings.begin(), warnings.begin(), warnings.end());
  reportWarnings(result.report.warnings, arguments);

  const std::vector<std::byte> png = encodePng(result.picture);
  const std::string json = toJson(result.report);
  picture.write(png);
  if (report) report->write(std::as_bytes(std::span(json)));
  picture.commit();
  if (report) report->commit();
  const bool outputIsTaken = picture.isSpecial() || (report && report->isSpecial()); // it may be standard output
  if (!arguments.quiet && !outputIsTaken) fmt::print("{}: {}\n", arguments.output, toSummary(result.report));
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
