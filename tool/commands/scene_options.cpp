#include "scene_options.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "../scene/load.h"
#include "../scene/merge.h"
#include "../scene/message.h"
#include "errors.h"
#include "option_values.h"

namespace vitrail::tool {

namespace {

constexpr std::string_view kSceneHelp =
    R"(What to draw:
  MODEL...              .gltf, .glb, .obj, .ply and .stl files; several are drawn in one picture,
                        each where its own coordinates put it
  --scene NAME          a built-in scene (vitrail scenes lists them)
  --count N             how many spheres, planes, ... the scene has
  --seed S              another arrangement of the same scene (default 1)
@load@
  --isolate NAME        draws this object alone, with all below it: a node of the file, by its name or
                        its path (car/wheel); several times for several
  --hide NAME           leaves it out
  --show NAME           draws it although one above it is hidden
  --fade NAME=A         makes its materials translucent, 0.004 to 1

How to look at it:
  --size WxH            pixels (default 1280x720)
@camera@
  --point-size N        how many pixels the points of point clouds are across (default 3)
  --opacity A           X-ray: makes every material translucent, 0.004 to 1
  --background B        a colour as #rrggbb (sRGB), sky, or transparent (a picture with alpha))";

ObjectChoice::Fade fadeOf(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  const auto opacity = equals == std::string::npos ? std::nullopt : numberOf<float>(text.substr(equals + 1));
  if (!opacity || equals == 0 || !(*opacity >= 0.004F) || *opacity > 1.0F) {
    throw CLI::ValidationError("--fade",
                               fmt::format("'{}' is not NAME=A with an A from 0.004 to 1, such as wheel=0.25", text));
  }
  return {text.substr(0, equals), *opacity};
}

Background backgroundOf(const std::string& text) {
  Background background;
  if (text == "sky") {
    background.kind = Background::Kind::Sky;
  } else if (text == "transparent") {
    background.kind = Background::Kind::Transparent;
  } else {
    std::uint32_t value = 0;
    const char* end = text.data() + text.size();
    const bool shaped = text.size() == 7 && text[0] == '#';
    if (!shaped || std::from_chars(text.data() + 1, end, value, 16).ptr != end) {
      throw CLI::ValidationError("--background",
                                 fmt::format("'{}' is not a colour such as #20a0ff, nor sky or transparent", text));
    }
    for (int i = 0; i < 3; ++i) background.srgb[i] = static_cast<float>((value >> (16 - 8 * i)) & 0xffU) / 255.0F;
  }
  return background;
}

} // namespace

void addSceneOptions(CLI::App& command, SceneArguments& arguments) {
  command.add_option("--scene", arguments.scene);
  addCount(command, "--count", arguments.count);
  addCount(command, "--seed", arguments.seed);
  addSize(command, arguments.width, arguments.height);
  addOpacity(command, arguments.opacity);
  addPointSize(command, arguments.pointSize);
  addLoadOptions(command, arguments.load);
  addCameraOptions(command, arguments);
  // One name for each time that it is named.
  command.add_option("--isolate", arguments.objects.isolate)->allow_extra_args(false);
  command.add_option("--hide", arguments.objects.hide)->allow_extra_args(false);
  command.add_option("--show", arguments.objects.show)->allow_extra_args(false);
  command
      .add_option_function<std::vector<std::string>>("--fade",
                                                     [&arguments](const std::vector<std::string>& texts) {
                                                       arguments.objects.fade.clear();
                                                       for (const std::string& text : texts)
                                                         arguments.objects.fade.push_back(fadeOf(text));
                                                     })
      ->allow_extra_args(false);
  command.add_option_function<std::string>(
      "--background", [&arguments](const std::string& text) { arguments.background = backgroundOf(text); });
}

const std::string_view kLoadHelp =
    R"(  --time T              shows the file's animation at T seconds (default: the rest pose)
  --animation N         which animation: its name, or its number from 0 (default: the first)
  --variant NAME        with the materials of one of the file's variants (default: its default ones))";

std::string withSceneHelp(const std::string& page) {
  return withText(withText(withText(page, "@scene@", kSceneHelp), "@camera@", kCameraHelp), "@load@", kLoadHelp);
}

void addLoadOptions(CLI::App& command, LoadOptions& options) {
  command.add_option_function<std::string>("--time", [&options](const std::string& text) {
    options.time = numberOf<double>(text);
    if (!options.time || !std::isfinite(*options.time))
      throw CLI::ValidationError("--time", fmt::format("'{}' is not a number of seconds", text));
  });
  command.add_option("--animation", options.animation);
  command.add_option("--variant", options.variant);
}

void checkLoadOptions(const LoadOptions& options, bool model) {
  if (!model && (options.time || options.animation || options.variant))
    throw UsageError("--time, --animation and --variant are for model files: a built-in scene has none");
}

void checkSceneArguments(const SceneArguments& arguments, const std::string& command) {
  if (arguments.models.empty() == arguments.scene.empty()) {
    throw UsageError(
        arguments.models.empty()
            ? fmt::format("nothing to draw: name a model file or a --scene (see vitrail {} --help)", command)
            : "a model file and --scene exclude each other: name one of them");
  }
  if (arguments.scene.empty() && (arguments.count || arguments.seed)) {
    throw UsageError("--count and --seed are for built-in scenes: add --scene NAME");
  }
  checkLoadOptions(arguments.load, !arguments.models.empty());
  checkCameraArguments(arguments);
}

Scene openModel(const std::string& file, const LoadOptions& options) {
  try {
    return loadModel(file, options);
  } catch (const LoadError& error) {
    throw std::runtime_error(fmt::format("{}: {}", file, error.what()));
  }
}

Scene openBuiltin(const std::string& name, const BuiltinOptions& options) {
  try {
    return makeBuiltinScene(name, options);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

namespace {

// Several models in one picture: what the options choose need not be in all of them, but in one.
std::vector<Scene> openModels(const SceneArguments& arguments, const Progress& progress) {
  LoadOptions options = arguments.load;
  options.optional = arguments.models.size() > 1;
  std::vector<Scene> parts;
  for (const std::string& model : arguments.models) {
    progress.show(fmt::format("loading {}", printable(model)));
    parts.push_back(openModel(model, options));
  }
  const auto anyHas = [&](bool (*has)(const FileFacts&, const LoadOptions&)) {
    return std::ranges::any_of(parts, [&](const Scene& part) { return has(part.file, options); });
  };
  const bool isAnimated = !(options.time || options.animation) || anyHas(hasAnimation);
  // The first model alone says best what is missing.
  if (!isAnimated || (options.variant && !anyHas(hasVariant))) openModel(arguments.models.front(), arguments.load);
  return parts;
}

} // namespace

Scene openScene(const SceneArguments& arguments, const Progress& progress) {
  Scene scene;
  if (arguments.scene.empty()) {
    scene = mergeScenes(openModels(arguments, progress), arguments.models);
    if (scene.draws.empty()) std::erase(scene.warnings, nothingDrawnWarning()); // the picture's own warning says it
  } else {
    scene = openBuiltin(arguments.scene, {arguments.count, arguments.seed.value_or(BuiltinOptions{}.seed)});
  }
  scene.pointSize = arguments.pointSize.value_or(scene.pointSize);
  placeScene(arguments, scene);
  nameDraws(scene);
  try {
    chooseObjects(scene, arguments.objects);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  return scene;
}

std::string nameOfScene(const SceneArguments& arguments) {
  if (!arguments.scene.empty()) return arguments.scene;
  std::vector<std::string> names;
  for (const std::string& model : arguments.models) names.push_back(std::filesystem::path(model).filename().string());
  return fmt::format("{}", fmt::join(names, ", "));
}

RenderOptions pictureOf(const SceneArguments& arguments, const Scene& scene) {
  RenderOptions options;
  options.width = arguments.width;
  options.height = arguments.height;
  const float aspect = static_cast<float>(arguments.width) / static_cast<float>(arguments.height);
  options.view = viewOf(arguments, scene, aspect, arguments.models.size() < 2);
  options.background = arguments.background.value_or(scene.background.value_or(Background{}));
  return options;
}

Seen seenOf(const RenderOptions& picture, std::optional<float> opacity) {
  return {picture.view, picture.width, picture.height, opacity};
}

bool warnIfUnseen(const Scene& scene, const Seen& seen, std::vector<std::string>& warnings) {
  if (!whyNothingIsSeen(scene, seen)) return false;
  warnings.push_back(nothingSeenWarning(scene, seen));
  return true;
}

} // namespace vitrail::tool
