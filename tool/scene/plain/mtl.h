// Reads the material libraries of OBJ files.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace vitrail::tool {

// A picture that a material names, with the options before its name.
struct MtlMap {
  std::string name; // of the file; empty: none
  glm::vec2 scale{1.0F};
  glm::vec2 offset{0.0F};
  bool clamp = false;
  char channel = '\0'; // -imfchan: r, g, b, m (alpha), l (luminance) or z; none: by the picture
  float base = 0.0F;   // -mm: values become base + gain * value
  float gain = 1.0F;
  float strength = 1.0F; // -bm
};

// What a library says of one material, in its own terms: colours as they are stated. What it does not state is empty.
struct MtlMaterial {
  std::string name;
  std::optional<glm::vec3> diffuse;        // Kd
  std::optional<glm::vec3> specular;       // Ks
  std::optional<glm::vec3> emissive;       // Ke
  std::optional<glm::vec3> filter;         // Tf
  std::optional<float> shininess;          // Ns
  std::optional<float> dissolve;           // d
  std::optional<float> transparency;       // Tr
  std::optional<float> refraction;         // Ni
  std::optional<float> roughness;          // Pr
  std::optional<float> metallic;           // Pm
  std::optional<float> sheen;              // Ps
  std::optional<float> clearcoat;          // Pc
  std::optional<float> clearcoatRoughness; // Pcr
  std::optional<int> illumination;         // illum
  MtlMap diffuseMap;                       // map_Kd
  MtlMap opacityMap;                       // map_d
  MtlMap emissiveMap;                      // map_Ke
  MtlMap roughnessMap;                     // map_Pr
  MtlMap metallicMap;                      // map_Pm
  MtlMap normalMap;                        // norm
  MtlMap bumpMap;                          // map_Bump, bump: heights, or a normal map under that name
};

struct MtlLibrary {
  std::map<std::string, MtlMaterial, std::less<>> materials;
  bool transparencyIsOpacity = false; // Tr means what d does: see opacityOf()
  std::vector<std::string> warnings;  // once a cause: what of it is not drawn

  // The material of that name; where there is none the one whose name differs by a comment after it alone.
  const MtlMaterial* find(std::string_view name) const;

  std::map<std::string, std::string, std::less<>> withoutComment; // names that hold a #, by what is before it
};

// Reads a library's text. A statement that makes no sense is passed over: models are often handed on with libraries of
// other programs.
MtlLibrary readMtl(std::string_view text);

// The share of light that a material stops: d where it is stated. Tr stands for 1 - d in the files of most programs and
// for d in those of MeshLab (to 2023), OpenMVS, mvs-texturing and others, which write "Tr 1" for what is opaque. So,
// without a d: 0 and 1 are opaque; other values mean d where a material of the same library is "Tr 1" and none "Tr 0",
// or where a comment in it names one of those programs; otherwise they mean 1 - d. Without either, the mean of Tf is
// taken as d unless it is 0, as Maya writes it.
float opacityOf(const MtlMaterial& material, const MtlLibrary& library);

// The text before " #", without blanks at its end: names may hold a #, and comments may follow a name.
std::string_view beforeComment(std::string_view text);

} // namespace vitrail::tool
