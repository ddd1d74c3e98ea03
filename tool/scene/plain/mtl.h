// Reads the material libraries of OBJ files.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <glm/glm.hpp>

namespace vitrail::tool {

// What a library says of one material, in its own terms: colours as they are stated, without any that it does not
// state.
struct MtlMaterial {
  std::optional<glm::vec3> diffuse; // Kd
  glm::vec3 emissive{0.0F};         // Ke
  float opacity = 1.0F;             // d, or else 1 - Tr
  std::string diffuseMap;           // map_Kd: the file's name, empty: none
  bool clamp = false;               // map_Kd -clamp on
};

// Adds the materials of a library's text to `materials` by name. A statement that makes no sense is passed over: models
// are often handed on with libraries of other programs.
void readMtl(std::string_view text, std::map<std::string, MtlMaterial, std::less<>>& materials);

} // namespace vitrail::tool
