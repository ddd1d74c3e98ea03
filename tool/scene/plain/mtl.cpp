// Reads the material libraries of OBJ files.
#include "mtl.h"

#include <algorithm>
#include <array>
#include <utility>

#include "text_reader.h"

namespace vitrail::tool {
namespace {

std::optional<float> readNumber(TextLines& lines) {
  float value = 0.0F;
  if (!parseFloat(lines.word(), value)) return std::nullopt;
  return value;
}

// None for other ways to state a colour, such as a spectral curve.
std::optional<glm::vec3> readColor(TextLines& lines) {
  glm::vec3 color;
  for (int c = 0; c < 3; ++c) {
    const std::optional<float> value = readNumber(lines);
    if (!value) return std::nullopt;
    color[c] = *value;
  }
  return color;
}

// Passes over the options in front of a map's file name, which may hold spaces.
void readMap(TextLines& lines, MtlMaterial& material) {
  // Options that are followed by up to so many numbers or words; the first one always is.
  constexpr std::array<std::pair<std::string_view, int>, 4> several{{{"-mm", 2}, {"-o", 3}, {"-s", 3}, {"-t", 3}}};
  while (lines.rest().starts_with('-')) {
    const std::string_view option = lines.word();
    const std::string_view value = lines.word();
    if (option == "-clamp") material.clamp = value == "on";
    const auto* found = std::ranges::find(several, option, &std::pair<std::string_view, int>::first);
    for (int i = 1; found != several.end() && i < found->second; ++i) {
      float number = 0.0F;
      const std::string_view rest = lines.rest();
      if (!parseFloat(rest.substr(0, rest.find_first_of(" \t")), number)) break;
      lines.word();
    }
  }
  material.diffuseMap = lines.rest();
}

} // namespace

void readMtl(std::string_view text, std::map<std::string, MtlMaterial, std::less<>>& materials) {
  MtlMaterial* material = nullptr;
  bool hasDissolve = false;
  TextLines lines(text);
  while (lines.next()) {
    const std::string_view word = lines.word();
    if (word == "newmtl") {
      material = &materials[std::string(lines.rest())];
      *material = {};
      hasDissolve = false;
    } else if (material == nullptr) {
      continue;
    } else if (word == "Kd") {
      if (const auto color = readColor(lines)) material->diffuse = color;
    } else if (word == "Ke") {
      if (const auto color = readColor(lines)) material->emissive = *color;
    } else if (word == "d") {
      if (const auto opacity = readNumber(lines)) {
        material->opacity = std::clamp(*opacity, 0.0F, 1.0F);
        hasDissolve = true;
      }
    } else if (word == "Tr" && !hasDissolve) {
      if (const auto transparency = readNumber(lines)) material->opacity = std::clamp(1.0F - *transparency, 0.0F, 1.0F);
    } else if (word == "map_Kd") {
      readMap(lines, *material);
    }
  }
}

} // namespace vitrail::tool
