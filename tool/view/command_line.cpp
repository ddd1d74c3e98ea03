#include "command_line.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "../methods/methods.h"

namespace vitrail::tool {

namespace {

// For a POSIX shell.
std::string quoted(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_-./,:=+%@").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!word.empty() && word.front() != '-' && std::ranges::all_of(word, plain)) return word;
  std::string result = "'";
  for (const char c : word) {
    if (c == '\'') {
      result += "'\\''";
    } else {
      result += c;
    }
  }
  return result + "'";
}

class Words {
 public:
  void add(const std::string& word) { text_ += (text_.empty() ? "" : " ") + quoted(word); }
  void option(std::string_view name, const std::string& value) {
    text_ += fmt::format(" {}{}{}", name, value.starts_with('-') ? "=" : " ", quoted(value));
  }
  template <typename Value>
  void option(std::string_view name, const std::optional<Value>& value) {
    if (value) option(name, fmt::format("{}", *value));
  }
  void place(std::string_view name, const std::optional<glm::dvec3>& place) {
    if (place) raw(name, fmt::format("{},{},{}", place->x, place->y, place->z));
  }
  // A value that may begin with a minus.
  void raw(std::string_view name, const std::string& value) {
    text_ += fmt::format(" {}{}{}", name, value.starts_with('-') ? "=" : " ", value);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_ = "vitrail render";
};

std::string textOf(const Background& background) {
  if (background.kind == Background::Kind::Sky) return "sky";
  if (background.kind == Background::Kind::Transparent) return "transparent";
  const auto code = [](float value) { return std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F); };
  return fmt::format("#{:02x}{:02x}{:02x}", code(background.srgb.r), code(background.srgb.g), code(background.srgb.b));
}

void addScene(Words& words, const RenderArguments& arguments) {
  for (const std::string& model : arguments.models) words.add(model.starts_with('-') ? "./" + model : model);
  if (!arguments.scene.empty()) words.option("--scene", arguments.scene);
  words.option("--count", arguments.count);
  words.option("--seed", arguments.seed);
  words.option("--time", arguments.load.time);
  if (arguments.load.animation) words.option("--animation", *arguments.load.animation);
  if (arguments.load.variant) words.option("--variant", *arguments.load.variant);
  for (const std::string& name : arguments.objects.isolate) words.option("--isolate", name);
  for (const std::string& name : arguments.objects.hide) words.option("--hide", name);
  for (const std::string& name : arguments.objects.show) words.option("--show", name);
  for (const auto& [name, opacity] : arguments.objects.fade) {
    words.option("--fade", fmt::format("{}={}", name, opacity));
  }
}

void addLook(Words& words, const RenderArguments& arguments) {
  words.raw("--size", fmt::format("{}x{}", arguments.width, arguments.height));
  words.option("--camera", arguments.camera);
  if (const auto& orbit = arguments.orbit) {
    words.raw("--orbit", fmt::format("{},{},{}", orbit->azimuth, orbit->elevation, orbit->zoom));
  }
  words.place("--eye", arguments.eye);
  words.place("--look-at", arguments.lookAt);
  words.option("--fov", arguments.fov);
  if (arguments.up != UpAxis::Y) words.raw("--up", arguments.up == UpAxis::Z ? "z" : "x");
  for (const glm::dvec4& plane : arguments.clipPlanes) {
    words.raw("--clip-plane", fmt::format("{},{},{},{}", plane.x, plane.y, plane.z, plane.w));
  }
  words.option("--point-size", arguments.pointSize);
  words.option("--opacity", arguments.opacity);
  if (arguments.background) words.option("--background", textOf(*arguments.background));
}

void addMethod(Words& words, const RenderArguments& arguments) {
  const MethodOptions& method = arguments.method;
  const MethodOptions defaults;
  words.raw("--method", method.name);
  if (method.api != defaults.api && !traitsOf(method.name).onProcessor)
    words.raw("--api", std::string(nameOf(method.api)));
  if (method.samples != defaults.samples) words.raw("--samples", fmt::format("{}", method.samples));
  if (method.nodes != defaults.nodes) words.raw("--nodes", std::string(nameOf(method.nodes)));
  if (method.resolve != defaults.resolve) words.raw("--resolve", std::string(nameOf(method.resolve)));
  if (method.listBuild != defaults.listBuild) words.raw("--list-build", std::string(nameOf(method.listBuild)));
  if (method.msaaResolve != defaults.msaaResolve) words.raw("--msaa-resolve", std::string(nameOf(method.msaaResolve)));
  if (method.maxLayers != 0) words.raw("--layers", fmt::format("{}", method.maxLayers));
  if (!method.sorted) words.raw("--sorting", "off");
  if (method.passes != 0) words.raw("--passes", fmt::format("{}", method.passes));
  words.option("--memory-budget", arguments.memoryBudget);
  words.option("--peel", arguments.peel);
  const bool isElsewhere = traitsOf(method.name).onProcessor && !isProcessor(arguments.device);
  if (!arguments.device.empty() && !isElsewhere) words.option("--device", arguments.device);
}

} // namespace

std::string renderCommand(const RenderArguments& arguments, const std::string& output) {
  Words words;
  addScene(words, arguments);
  addLook(words, arguments);
  addMethod(words, arguments);
  words.option("-o", output);
  return words.text();
}

} // namespace vitrail::tool
