// Loads STL, text and binary, with the colours that two binary dialects keep in a facet's 16 spare bits: Materialise
// Magics (a header with "COLOR=" or "MATERIAL=") and VisCAM. Normals are made from the corners, since what files state
// is often zero or wrong.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../bytes.h"
#include "../load.h"
#include "../mesh_build.h"
#include "../threads.h"
#include "letters.h"
#include "model.h"
#include "stl_facets.h"
#include "text_encoding.h"

namespace vitrail::tool {
namespace {

constexpr std::size_t headerBytes = 80;
constexpr std::size_t facetsBegin = headerBytes + 4;
constexpr std::size_t facetBytes = 50; // normal, 3 corners, 16 spare bits
constexpr std::size_t mostFacets = 0xfffffffe / 3;

glm::vec4 fiveBitColor(std::uint32_t r, std::uint32_t g, std::uint32_t b, float alpha) {
  const glm::vec3 srgb =
      glm::vec3(static_cast<float>(r & 31U), static_cast<float>(g & 31U), static_cast<float>(b & 31U)) / 31.0F;
  return {linearFromSrgb(srgb), alpha};
}

// The colours of a binary file.
class FacetColors {
 public:
  explicit FacetColors(std::span<const std::byte> file) {
    const std::string_view header(reinterpret_cast<const char*>(file.data()), headerBytes);
    // A material's first colour is preferred to the plain one; it has no transparency of its own.
    magics_ = readColor(file, header, "COLOR=", default_);
    glm::vec4 diffuse = default_;
    if (readColor(file, header, "MATERIAL=", diffuse)) {
      default_ = glm::vec4(glm::vec3(diffuse), magics_ ? default_.a : 1.0F);
      magics_ = true;
    }
  }

  // What tells the colours of facets apart, and 0 where the spare bits mean nothing.
  std::uint32_t tagOf(std::uint32_t bits) const {
    const bool marked = (bits & 0x8000U) != 0;
    if (magics_) return marked ? 0x8000U : bits;
    return marked ? bits : 0;
  }

  glm::vec4 of(std::uint32_t tag) const {
    const bool marked = (tag & 0x8000U) != 0;
    if (magics_) return marked ? default_ : fiveBitColor(tag, tag >> 5U, tag >> 10U, default_.a);
    return marked ? fiveBitColor(tag >> 10U, tag >> 5U, tag, 1.0F) : default_;
  }

  // Whether colours are stated where facets have these tags.
  bool any(const std::vector<Welder::Key>& keys) const {
    return magics_ || std::ranges::any_of(keys, [](const Welder::Key& key) { return key.tag != 0; });
  }

 private:
  static bool readColor(std::span<const std::byte> file, std::string_view header, std::string_view tag,
                        glm::vec4& color) {
    const std::size_t found = header.find(tag);
    if (found == std::string_view::npos || found + tag.size() + 4 > headerBytes) return false;
    glm::vec4 rgba;
    for (std::size_t c = 0; c < 4; ++c)
      rgba[static_cast<int>(c)] =
          static_cast<float>(std::to_integer<std::uint32_t>(file[found + tag.size() + c])) / 255.0F;
    color = glm::vec4(linearFromSrgb(glm::vec3(rgba)), rgba.a);
    return true;
  }

  glm::vec4 default_{0.8F, 0.8F, 0.8F, 1.0F}; // what a file without colours looks like
  bool magics_ = false;
};

// --- Binary files.

glm::dvec3 placeAt(std::span<const std::byte> file, std::size_t begin) {
  glm::dvec3 place;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::uint32_t bits = littleEndian(file, begin + c * 4, 4);
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof bits);
    place[static_cast<int>(c)] = static_cast<double>(value);
  }
  return place;
}

StlFacets readBinaryStl(std::span<const std::byte> file, std::size_t facets, const FacetColors& colors,
                        const glm::dvec3& origin) {
  constexpr std::size_t leastFacets = 20'000;
  const std::size_t count = partsFor(facets, leastFacets);
  std::vector<StlFacets> parts(count);
  inParts(count, [&](std::size_t part) {
    const std::size_t first = facets * part / count;
    const std::size_t last = facets * (part + 1) / count;
    parts[part].indices.reserve(3 * (last - first));
    // A closed surface has half as many vertices as triangles.
    parts[part].vertices = Welder((last - first) / 2);
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t begin = facetsBegin + i * facetBytes;
      parts[part].add({placeAt(file, begin + 12), placeAt(file, begin + 24), placeAt(file, begin + 36)}, origin,
                      colors.tagOf(littleEndian(file, begin + 48, 2)));
    }
  });
  for (std::size_t part = 1; part < count; ++part) parts[0].append(std::move(parts[part]));
  return std::move(parts[0]);
}

// How many facets are read. Exporters leave counts behind that are zero or too large; what the file has room for is
// then taken, if it looks like facets.
std::size_t facetCount(std::span<const std::byte> file, Scene& scene) {
  const std::size_t stated = littleEndian(file, headerBytes, 4);
  const std::size_t room = (file.size() - facetsBegin) / facetBytes;
  if (stated > 0 && stated <= room) {
    if (room > stated)
      warn(scene, fmt::format("the STL header states {} facets, but the file has room for {}: the others are left out",
                              stated, room));
    return stated;
  }
  constexpr double farthest = 1e15;
  bool sound = room > 0 && room <= mostFacets;
  for (std::size_t i = 0; sound && i < room; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const glm::dvec3 place = glm::abs(placeAt(file, facetsBegin + i * facetBytes + 12 + 12 * c));
      sound = sound && place.x <= farthest && place.y <= farthest && place.z <= farthest;
    }
  if (!sound && stated > 0)
    throw LoadError(fmt::format("the STL header states {} facets, but the file has room for {}", stated, room));
  if (sound)
    warn(scene,
         fmt::format("the STL header states {} facets, but the file has room for {}: those are drawn", stated, room));
  return sound ? room : 0;
}

// --- Either kind.

// Whether they have colours.
bool takeVertices(Mesh& mesh, const std::vector<Welder::Key>& keys, const FacetColors* colors) {
  const bool colored = colors != nullptr && colors->any(keys);
  mesh.positions.reserve(keys.size());
  for (const Welder::Key& key : keys) mesh.positions.push_back(key.position);
  if (colored)
    for (const Welder::Key& key : keys) mesh.colors.push_back(packColor(colors->of(key.tag)));
  return colored;
}

void addFacets(Scene& scene, StlFacets facets, const FacetColors* colors) {
  if (facets.cutOff)
    warn(scene, fmt::format("the file ends inside a facet: the {} before it are drawn", facets.indices.size() / 3));
  if (facets.notFinite > 0)
    warn(scene, fmt::format("left out, since a corner is not finite: {} of {} facets", facets.notFinite,
                            facets.notFinite + facets.indices.size() / 3));
  if (facets.notFinite > 0 && facets.indices.empty()) throw LoadError("every facet has a corner that is not finite");
  Mesh mesh;
  mesh.indices = std::move(facets.indices);
  const bool colored = takeVertices(mesh, facets.vertices.take(), colors);
  // Facets of two colours share places, but no vertices.
  addPlainMesh(scene, std::move(mesh), colored ? NormalsFrom::Places : NormalsFrom::OwnPlaces, plainMaterial(colored));
}

// Reads with `read(origin)`: models that turn out to be far from their origin a second time, relative to their middle.
template <typename Read>
StlFacets readCentred(Scene& scene, Read read) {
  StlFacets facets = read(glm::dvec3(0.0));
  scene.origin = facets.bounds.origin();
  if (scene.origin == glm::dvec3(0.0)) return facets;
  facets = StlFacets();
  return read(scene.origin);
}

void addBinaryStl(Scene& scene, std::span<const std::byte> file) {
  scene.file.format = "STL (binary)";
  if (file.size() < facetsBegin)
    throw LoadError(fmt::format("the file ends after {} bytes, in the STL header", file.size()));
  const FacetColors colors(file);
  const std::size_t count = facetCount(file, scene);
  addFacets(scene,
            readCentred(scene, [&](const glm::dvec3& origin) { return readBinaryStl(file, count, colors, origin); }),
            &colors);
}

// Binary files may begin with "solid" as well, and text files without: bytes that no text holds tell, since a binary
// file has zeros in its count or its normals.
bool isStlText(std::string_view text) {
  const std::string start = lowerCase(text.substr(0, 1024));
  if (start.find('\0') != std::string::npos) return false;
  const std::size_t begin = start.find_first_not_of(" \t\r\n");
  return begin != std::string::npos &&
         (start.compare(begin, 5, "solid") == 0 || start.find("facet") != std::string::npos);
}

// False: the file is no text.
bool addTextStl(Scene& scene, std::span<const std::byte> file) {
  const PlainText plain(file);
  const std::string_view text = plain.view();
  if (!isStlText(text)) return false;
  scene.file.format = "STL (text)";
  addFacets(scene, readCentred(scene, [&](const glm::dvec3& origin) { return readStlText(text, origin); }), nullptr);
  return true;
}

} // namespace

Scene loadStl(std::span<const std::byte> file) {
  const bool exact = file.size() >= facetsBegin &&
                     facetsBegin + std::size_t{littleEndian(file, headerBytes, 4)} * facetBytes == file.size();
  Scene scene;
  if (exact || !addTextStl(scene, file)) addBinaryStl(scene, file);
  requireDrawable(scene);
  return scene;
}

} // namespace vitrail::tool
