#include "scene_options.h"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "errors.h"
#include "option_values.h"

namespace vitrail::tool {

namespace {

constexpr std::string_view kSceneHelp =
    R"(What to draw:
  MODEL                 a .gltf, .glb, .obj, .ply or .stl file
  --scene NAME          a built-in scene (vitrail scenes lists them)
  --count N             how many spheres, planes, ... the scene has
  --seed S              another arrangement of the same scene (default 1)
@load@

How to look at it:
  --size WxH            pixels (default 1280x720)
  --camera N            camera N of the file, from 0 (default: the file's first camera;
                        without one the whole model is seen from a three-quarter view)
  --orbit AZ,EL[,ZOOM]  look from azimuth and elevation in degrees: 0,0 is the front, 90,0 the right,
                        0,90 the top; ZOOM 2 shows it twice as large
  --point-size N        how many pixels the points of point clouds are across (default 3)
  --opacity A           X-ray: makes every material translucent, 0.004 to 1
  --background B        a colour as #rrggbb (sRGB), sky, or transparent (a PNG with alpha))";

Orbit orbitOf(const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  std::array<float, 3> values = {0.0F, 0.0F, 1.0F};
  bool good = parts.size() == 2 || parts.size() == 3;
  for (std::size_t i = 0; good && i < parts.size(); ++i) {
    const auto value = numberOf<float>(parts[i]);
    good = value.has_value() && std::isfinite(*value);
    if (good) values[i] = *value;
  }
  if (!good) {
    throw CLI::ValidationError("--orbit",
                               fmt::format("'{}' is not AZIMUTH,ELEVATION[,ZOOM], such as 35,20 or 0,90,2", text));
  }
  if (std::abs(values[1]) > 90.0F) throw CLI::ValidationError("--orbit", "the elevation is between -90 and 90");
  if (values[2] < 0.01F || values[2] > 100.0F)
    throw CLI::ValidationError("--orbit", "the zoom is between 0.01 and 100");
  return {std::remainder(values[0], 360.0F), values[1], values[2]};
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

View chooseView(const SceneArguments& arguments, const Scene& scene) {
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

} // namespace

void addSceneOptions(CLI::App& command, SceneArguments& arguments) {
  command.add_option("--scene", arguments.scene);
  addCount(command, "--count", arguments.count);
  addCount(command, "--seed", arguments.seed);
  addCount(command, "--camera", arguments.camera);
  addSize(command, arguments.width, arguments.height);
  addOpacity(command, arguments.opacity);
  addPointSize(command, arguments.pointSize);
  addLoadOptions(command, arguments.load);
  command.add_option_function<std::string>("--orbit",
                                           [&arguments](const std::string& text) { arguments.orbit = orbitOf(text); });
  command.add_option_function<std::string>(
      "--background", [&arguments](const std::string& text) { arguments.background = backgroundOf(text); });
}

const std::string_view kLoadHelp =
    R"(  --time T              shows the file's animation at T seconds (default: the rest pose)
  --animation N         which animation: its name, or its number from 0 (default: the first)
  --variant NAME        with the materials of one of the file's variants (default: its default ones))";

std::string withSceneHelp(const std::string& page) {
  return withText(withText(page, "@scene@", kSceneHelp), "@load@", kLoadHelp);
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
  if (arguments.model.empty() == arguments.scene.empty()) {
    throw UsageError(
        arguments.model.empty()
            ? fmt::format("nothing to draw: name a model file or a --scene (see vitrail {} --help)", command)
            : "a model file and --scene exclude each other: name one of them");
  }
  if (arguments.scene.empty() && (arguments.count || arguments.seed)) {
    throw UsageError("--count and --seed are for built-in scenes: add --scene NAME");
  }
  checkLoadOptions(arguments.load, !arguments.model.empty());
  if (arguments.camera && arguments.orbit)
    throw UsageError("--camera and --orbit exclude each other: give one of them");
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

Scene openScene(const SceneArguments& arguments) {
  Scene scene = arguments.scene.empty()
                    ? openModel(arguments.model, arguments.load)
                    : openBuiltin(arguments.scene, {arguments.count, arguments.seed.value_or(BuiltinOptions{}.seed)});
  scene.pointSize = arguments.pointSize.value_or(scene.pointSize);
  return scene;
}

RenderOptions pictureOf(const SceneArguments& arguments, const Scene& scene) {
  RenderOptions options;
  options.width = arguments.width;
  options.height = arguments.height;
  options.view = chooseView(arguments, scene);
  options.background = arguments.background.value_or(scene.background.value_or(Background{}));
  return options;
}

void closeValidated(Gpu& gpu) {
  gpu.close(); // what was not destroyed by now is a validation error
  const std::vector<std::string> errors = gpu.validationErrors();
  if (errors.empty()) return;
  throw std::runtime_error(
      fmt::format("the validation layer reports {} errors, the first: {}", errors.size(), errors[0]));
}

} // namespace vitrail::tool
