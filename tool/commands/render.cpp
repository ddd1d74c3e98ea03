// `vitrail render`: a model or a built-in scene in, a picture out.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <span>
#include <stdexcept>

#include "../draw/renderer.h"
#include "../image/png_encode.h"
#include "../scene/builtin.h"
#include "../scene/load.h"
#include "commands.h"
#include "errors.h"
#include "output_file.h"
#include "render_options.h"
#include "report.h"

namespace vitrail::tool {

namespace {

Scene openScene(const RenderArguments& arguments) {
  if (!arguments.scene.empty()) {
    try {
      return makeBuiltinScene(arguments.scene, {arguments.count, arguments.seed.value_or(BuiltinOptions{}.seed)});
    } catch (const std::invalid_argument& error) {
      throw UsageError(error.what());
    }
  }
  try {
    return loadModel(arguments.model);
  } catch (const LoadError& error) {
    throw std::runtime_error(fmt::format("{}: {}", arguments.model, error.what()));
  }
}

View chooseView(const RenderArguments& arguments, const Scene& scene) {
  const std::size_t cameras = scene.cameras.size();
  if (arguments.camera && *arguments.camera >= cameras) {
    throw UsageError(cameras == 0
                         ? "--camera: this scene has no cameras"
                         : fmt::format("--camera {}: this scene has cameras 0 to {}", *arguments.camera, cameras - 1));
  }
  if (cameras == 0 || arguments.orbit) {
    const float aspect = static_cast<float>(arguments.width) / static_cast<float>(arguments.height);
    return frameScene(scene, arguments.orbit.value_or(Orbit{}), aspect);
  }
  return viewOf(scene.cameras[arguments.camera.value_or(0)]);
}

RenderResult renderScene(const RenderArguments& arguments, const Scene& scene) {
  RenderOptions options;
  options.width = arguments.width;
  options.height = arguments.height;
  options.view = chooseView(arguments, scene);
  options.background = arguments.background.value_or(scene.background.value_or(Background{}));
  if (arguments.memoryBudget) options.memoryBudget = std::uint64_t{*arguments.memoryBudget} << 20U;

  Gpu gpu({arguments.device, arguments.validate});
  RenderResult result;
  {
    Renderer renderer(gpu, scene, arguments.opacity, DrawOrder::Forward, arguments.method);
    result = renderer.render(options);
  }
  gpu.close(); // what was not destroyed by now is a validation error
  const std::vector<std::string> errors = gpu.validationErrors();
  if (!errors.empty()) {
    throw std::runtime_error(
        fmt::format("the validation layer reports {} errors, the first: {}", errors.size(), errors[0]));
  }
  return result;
}

void runRender(const RenderArguments& arguments) {
  checkRenderArguments(arguments);
  OutputFile picture(arguments.output);
  std::optional<OutputFile> report;
  if (!arguments.json.empty()) report.emplace(arguments.json);
  if (report && report->isSameAs(picture)) throw UsageError("-o and --json name the same file");

  const RenderResult result = renderScene(arguments, openScene(arguments));

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
  setHelpPage(*command, kRenderHelp);
  const auto arguments = std::make_shared<RenderArguments>();
  addRenderOptions(*command, *arguments);
  command->callback([arguments, &run] { run = [arguments] { runRender(*arguments); }; });
}

} // namespace vitrail::tool
