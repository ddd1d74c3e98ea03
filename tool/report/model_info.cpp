#include "model_info.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "../scene/message.h"
#include "../scene/texture_slots.h"
#include "json.h"
#include "names.h"

namespace vitrail::tool {

namespace {

constexpr std::size_t kMostNamed = 20; // of each kind, in the text

// ---- What is counted

struct Counts {
  std::uint64_t triangles = 0;
  std::uint64_t lines = 0;
  std::uint64_t points = 0;
  std::uint64_t vertices = 0;

  void add(const Mesh& mesh) {
    std::uint64_t& count = mesh.primitive == Primitive::Triangles ? triangles
                           : mesh.primitive == Primitive::Lines   ? lines
                                                                  : points;
    count += mesh.indices.size() / cornersOf(mesh.primitive);
    vertices += mesh.vertexCount();
  }
};

Counts countsOf(const Scene& scene) {
  Counts counts;
  for (const Mesh& mesh : scene.meshes) counts.add(mesh);
  return counts;
}

// What all draws together put on the screen.
Counts drawnCountsOf(const Scene& scene) {
  Counts counts;
  for (const Draw& draw : scene.draws) counts.add(scene.meshes[draw.mesh]);
  return counts;
}

// The box in the file's own coordinates.
std::pair<glm::dvec3, glm::dvec3> boxOf(const Scene& scene) {
  const Bounds bounds = worldBounds(scene);
  return {glm::dvec3(bounds.min) + scene.origin, glm::dvec3(bounds.max) + scene.origin};
}

const char* wordOf(AlphaMode mode) {
  return mode == AlphaMode::Blend ? "blend" : mode == AlphaMode::Mask ? "mask" : "opaque";
}

const char* wordOf(Light::Kind kind) {
  return kind == Light::Kind::Directional ? "directional" : kind == Light::Kind::Spot ? "spot" : "point";
}

// The textures of a material: what each is for, and its image.
std::vector<std::pair<const char*, std::int32_t>> texturesOf(const Material& material) {
  std::vector<std::pair<const char*, std::int32_t>> textures;
  forEachSlot(material, [&](const char* use, const TextureSlot& slot) {
    if (slot.image >= 0) textures.emplace_back(use, slot.image);
  });
  return textures;
}

// What a material has beside its alpha mode and textures.
std::vector<std::string> materialTraits(const Material& material) {
  std::vector<std::string> traits;
  const auto add = [&](bool has, std::string text) {
    if (has) traits.push_back(std::move(text));
  };
  add(material.alphaMode == AlphaMode::Mask, fmt::format("cutoff {:.3g}", material.alphaCutoff));
  add(material.baseColor.a != 1.0F, fmt::format("alpha {:.3g}", material.baseColor.a));
  add(material.alphaMode == AlphaMode::Blend && material.blend == BlendMode::Additive, "additive");
  add(material.doubleSided, "double-sided");
  add(material.unlit, "unlit");
  add(material.transmission > 0.0F, fmt::format("transmission {:.3g}", material.transmission));
  add(material.thickness > 0.0F, "volume");
  add(material.emissive != glm::vec3(0.0F), "emissive");
  add(material.clearcoat > 0.0F, "clearcoat");
  add(material.sheenColor != glm::vec3(0.0F), "sheen");
  return traits;
}

// ---- Text

std::string bytesText(std::uint64_t bytes) {
  const auto size = static_cast<double>(bytes);
  if (size < 1e3) return fmt::format("{} bytes", bytes);
  return size < 1e6 ? fmt::format("{:.1f} kB", size / 1e3) : fmt::format("{:.1f} MB", size / 1e6);
}

std::string quoted(const std::string& name) { return name.empty() ? "" : fmt::format(" \"{}\"", oneLine(name)); }

class Text {
 public:
  void line(const char* label, const std::string& text) { text_ += fmt::format("     {:<15}{}\n", label, text); }
  void item(const std::string& text) { text_ += fmt::format("       {}\n", text); }
  void append(const std::string& text) { text_ += text; }

  // The number of things, and each of them up to a sensible number.
  template <class Values, class Describe>
  void list(const char* label, const Values& values, Describe describe) {
    if (values.empty()) return;
    line(label, std::to_string(values.size()));
    for (std::size_t i = 0; i < std::min(values.size(), kMostNamed); ++i) item(describe(i));
    if (values.size() > kMostNamed) item(fmt::format("and {} more", values.size() - kMostNamed));
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string countsText(const Counts& counts) {
  std::vector<std::string> parts;
  if (counts.triangles > 0) parts.push_back(fmt::format("{} triangles", counts.triangles));
  if (counts.lines > 0) parts.push_back(fmt::format("{} lines", counts.lines));
  if (counts.points > 0) parts.push_back(fmt::format("{} points", counts.points));
  parts.push_back(fmt::format("{} vertices", counts.vertices));
  return fmt::format("{}", fmt::join(parts, ", "));
}

void addGeometry(Text& text, const Scene& scene) {
  const auto [low, high] = boxOf(scene);
  const glm::dvec3 size = high - low;
  text.line("size", fmt::format("{:.6g} x {:.6g} x {:.6g}", size.x, size.y, size.z));
  text.line("from", fmt::format("{:.9g}, {:.9g}, {:.9g}", low.x, low.y, low.z));
  text.line("to", fmt::format("{:.9g}, {:.9g}, {:.9g}", high.x, high.y, high.z));
  text.line("meshes", fmt::format("{}: {}", scene.meshes.size(), countsText(countsOf(scene))));
  const Counts drawn = drawnCountsOf(scene);
  if (scene.draws.size() != scene.meshes.size() || drawn.triangles != countsOf(scene).triangles) {
    text.line("drawn", fmt::format("{} times: {}", scene.draws.size(), countsText(drawn)));
  }
}

std::string materialText(const Scene& scene, std::size_t i) {
  const Material& material = scene.materials[i];
  std::vector<std::string> parts{wordOf(material.alphaMode)};
  for (std::string& trait : materialTraits(material)) parts.push_back(std::move(trait));
  for (const auto& [use, image] : texturesOf(material)) parts.push_back(fmt::format("{} of image {}", use, image));
  return fmt::format("{}{}: {}", i, quoted(material.name), fmt::join(parts, ", "));
}

std::string extensionText(const FileFacts::Extension& extension) {
  std::string text = fmt::format("{}: {}", oneLine(extension.name), extension.honoured ? "drawn" : "not drawn");
  if (extension.required) text += ", required";
  if (!extension.lost.empty()) text += fmt::format("; {}", extension.lost);
  return text;
}

std::string cameraText(const SceneCamera& camera, std::size_t i) {
  return camera.orthographic
             ? fmt::format("{}{}: orthographic, {:.4g} high", i, quoted(camera.name), 2.0F * camera.halfHeight)
             : fmt::format("{}{}: {:.3g} degrees", i, quoted(camera.name), glm::degrees(camera.verticalFov));
}

// ---- JSON

Json numbersOf(const glm::dvec3& place) { return {place.x, place.y, place.z}; }

Json jsonOf(const Counts& counts) {
  return {{"triangles", counts.triangles},
          {"lines", counts.lines},
          {"points", counts.points},
          {"vertices", counts.vertices}};
}

Json jsonOf(const Material& material) {
  Json textures = Json::object();
  for (const auto& [use, image] : texturesOf(material)) textures[use] = image;
  return {{"name", material.name},
          {"alpha_mode", wordOf(material.alphaMode)},
          {"traits", materialTraits(material)},
          {"textures", textures}};
}

template <class Values, class Describe>
Json listOf(const Values& values, Describe describe) {
  Json list = Json::array();
  for (const auto& value : values) list.push_back(describe(value));
  return list;
}

// What a file says of itself.
void addFacts(Json& json, const FileFacts& file) {
  json["format"] = orNull(file.format);
  json["generator"] = orNull(file.generator);
  json["extensions"] = listOf(file.extensions, [](const FileFacts::Extension& extension) {
    return Json{{"name", extension.name},
                {"required", extension.required},
                {"honoured", extension.honoured},
                {"lost", orNull(extension.lost)}};
  });
  json["animations"] = listOf(file.animations, [](const FileFacts::Animation& animation) {
    return Json{{"name", animation.name}, {"seconds", animation.seconds}};
  });
  json["variants"] = file.variants;
}

Json jsonOf(const ModelInfo& model) {
  const Scene& scene = model.scene;
  const auto [low, high] = boxOf(scene);
  Json json{{"file", model.file}, {"bytes", model.bytes}};
  addFacts(json, scene.file);
  json["bounds"] = {{"min", numbersOf(low)}, {"max", numbersOf(high)}};
  json["meshes"] = jsonOf(countsOf(scene));
  json["meshes"]["count"] = scene.meshes.size();
  json["draws"] = jsonOf(drawnCountsOf(scene));
  json["draws"]["count"] = scene.draws.size();
  json["materials"] = listOf(scene.materials, [](const Material& material) { return jsonOf(material); });
  json["images"] = listOf(scene.images, [](const Image& image) {
    return Json{{names::kWidth, image.width}, {names::kHeight, image.height}};
  });
  json["lights"] = listOf(scene.lights, [](const Light& light) {
    return Json{{"name", light.name}, {"kind", wordOf(light.kind)}};
  });
  json["cameras"] = listOf(scene.cameras, [](const SceneCamera& camera) {
    return Json{{"name", camera.name}, {"orthographic", camera.orthographic}};
  });
  json[names::kWarnings] = scene.warnings;
  return json;
}

} // namespace

std::string toText(const ModelInfo& model) {
  const Scene& scene = model.scene;
  const FileFacts& file = scene.file;
  Text text;
  text.append(fmt::format("{}\n", printable(model.file)));
  text.line("format", fmt::format("{}, {}", file.format, bytesText(model.bytes)));
  if (!file.generator.empty()) text.line("generator", oneLine(file.generator));
  addGeometry(text, scene);
  text.list("materials", scene.materials, [&](std::size_t i) { return materialText(scene, i); });
  text.list("images", scene.images,
            [&](std::size_t i) { return fmt::format("{}: {}x{}", i, scene.images[i].width, scene.images[i].height); });
  text.list("extensions", file.extensions, [&](std::size_t i) { return extensionText(file.extensions[i]); });
  text.list("lights", scene.lights, [&](std::size_t i) {
    return fmt::format("{}{}: {}", i, quoted(scene.lights[i].name), wordOf(scene.lights[i].kind));
  });
  text.list("cameras", scene.cameras, [&](std::size_t i) { return cameraText(scene.cameras[i], i); });
  text.list("animations", file.animations, [&](std::size_t i) {
    return fmt::format("{}{}: {:.3g} s", i, quoted(file.animations[i].name), file.animations[i].seconds);
  });
  text.list("variants", file.variants, [&](std::size_t i) { return oneLine(file.variants[i]); });
  text.list("warnings", scene.warnings, [&](std::size_t i) { return printable(scene.warnings[i]); });
  return text.text();
}

std::string toJson(std::span<const ModelInfo> models) {
  return documentOf({{"models", listOf(models, [](const ModelInfo& model) { return jsonOf(model); })}});
}

} // namespace vitrail::tool
