// `vitrail pick`: the surfaces under one pixel of a picture.
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "../image/encode.h"
#include "../render/pick.h"
#include "../scene/message.h"
#include "../scene/turn.h"
#include "commands.h"
#include "errors.h"
#include "option_values.h"
#include "progress.h"
#include "scene_options.h"

namespace vitrail::tool {

namespace {

constexpr const char* kPickHelp =
    R"(Lists the surfaces under a pixel of a picture, front to back.

Usage:
  vitrail pick MODEL... --at X,Y [options]
  vitrail pick --scene NAME --at X,Y [options]

  --at X,Y              the pixel, from the upper left corner; of the picture that vitrail render
                        draws with the same options
  --json                as JSON, for programs

@scene@

Of each surface: the object, its material, the distance from the camera, the point in the file's
coordinates, the colour (sRGB, as in a picture, and linear in JSON) and alpha. The last one is the
nearest opaque surface, if there is one. Clear glass has a filter, too, by which the light behind it
is multiplied.

Examples:
  vitrail pick engine.glb --opacity 0.25 --at 640,360
  vitrail pick --scene spheres --size 1920x1080 --at 960,540 --json
)";

struct PickArguments : SceneArguments {
  std::optional<glm::uvec2> at;
  bool json = false;
};

// What is found, in words and in the file's coordinates.
struct Found {
  std::string object;
  std::string material;
  glm::dvec3 point;
  const PickedLayer& layer;
};

void addAt(CLI::App& command, std::optional<glm::uvec2>& at) {
  command.add_option_function<std::string>("--at", [&at](const std::string& text) {
    const std::size_t comma = text.find(',');
    const auto x = numberOf<std::uint32_t>(text.substr(0, comma));
    const auto y = comma == std::string::npos ? std::nullopt : numberOf<std::uint32_t>(text.substr(comma + 1));
    if (!x || !y) throw CLI::ValidationError("--at", fmt::format("'{}' is not a pixel X,Y, such as 640,360", text));
    at = glm::uvec2(*x, *y);
  });
}

std::string materialName(const Scene& scene, std::uint32_t material) {
  const std::string& name = scene.materials[material].name;
  return name.empty() ? fmt::format("material {}", material) : name;
}

std::string colorText(const PickedLayer& layer) {
  const float linear[4] = {layer.color.r, layer.color.g, layer.color.b, 1.0F};
  std::uint8_t codes[4] = {};
  encodePixels(linear, 1, codes);
  return fmt::format("#{:02x}{:02x}{:02x}", codes[0], codes[1], codes[2]);
}

nlohmann::json toJson(const Found& found) {
  const PickedLayer& layer = found.layer;
  nlohmann::json json = {{"object", found.object},
                         {"material", found.material},
                         {"depth", layer.distance},
                         {"point", {found.point.x, found.point.y, found.point.z}},
                         {"color", {layer.color.r, layer.color.g, layer.color.b}},
                         {"alpha", layer.alpha},
                         {"blend", layer.blend}};
  if (layer.filter != glm::vec3(1.0F)) json["filter"] = {layer.filter.r, layer.filter.g, layer.filter.b};
  return json;
}

void runPick(const PickArguments& arguments) {
  checkSceneArguments(arguments, "pick");
  if (!arguments.at) throw UsageError("which pixel? add --at X,Y");
  const glm::uvec2 at = *arguments.at;
  if (at.x >= arguments.width || at.y >= arguments.height) {
    throw UsageError(fmt::format("--at {},{}: the picture has {}x{} pixels, the last one is {},{}", at.x, at.y,
                                 arguments.width, arguments.height, arguments.width - 1, arguments.height - 1));
  }
  const Progress progress(!arguments.quiet, Progress::Shown::AfterASecond);
  const Scene scene = openScene(arguments, progress);
  progress.show("");
  reportWarnings(scene.warnings, arguments);
  const View view = pictureOf(arguments, scene).view;
  const std::vector<PickedLayer> layers =
      Picker(scene, arguments.opacity).at(view, arguments.width, arguments.height, at.x, at.y);
  const glm::dmat3 toFile = glm::transpose(turnOf(arguments.up));
  std::vector<Found> found;
  for (const PickedLayer& layer : layers) {
    found.push_back({scene.objects.path(layer.object), materialName(scene, layer.material),
                     toFile * (layer.point + scene.origin), layer});
  }
  if (arguments.json) {
    nlohmann::json json = {{"x", at.x},
                           {"y", at.y},
                           {"width", arguments.width},
                           {"height", arguments.height},
                           {"layers", nlohmann::json::array()}};
    for (const Found& one : found) json["layers"].push_back(toJson(one));
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  if (found.empty()) fmt::print("nothing is there but the background\n");
  for (std::size_t i = 0; i < found.size(); ++i) {
    const PickedLayer& layer = found[i].layer;
    fmt::print("{:>3}  depth {:<10.6g} {} alpha {:<6.4g} {:<13} {} ({}) at {:.6g},{:.6g},{:.6g}\n", i + 1,
               layer.distance, colorText(layer), layer.alpha, layer.blend, printable(found[i].object),
               printable(found[i].material), found[i].point.x, found[i].point.y, found[i].point.z);
  }
}

} // namespace

void addPickCommand(CLI::App& app, std::function<void()>& run) {
  CLI::App* command = app.add_subcommand("pick");
  setHelpPage(*command, withSceneHelp(kPickHelp));
  const auto arguments = std::make_shared<PickArguments>();
  command->add_option("MODEL", arguments->models);
  addSceneOptions(*command, *arguments);
  addAt(*command, arguments->at);
  command->add_flag("--json", arguments->json);
  addWarningOptions(*command, *arguments);
  command->callback([arguments, &run] { run = [arguments] { runPick(*arguments); }; });
}

} // namespace vitrail::tool
