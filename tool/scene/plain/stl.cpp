// Loads STL, text and binary, with the colours that two binary dialects keep in a facet's 16 spare bits: Materialise
// Magics (a header with "COLOR=") and VisCAM. Facet normals are made from the corners, since what files state is often
// zero or wrong.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../bytes.h"
#include "../load.h"
#include "../mesh_build.h"
#include "model.h"
#include "text_reader.h"

namespace vitrail::tool {
namespace {

constexpr std::size_t headerBytes = 80;
constexpr std::size_t facetsBegin = headerBytes + 4;
constexpr std::size_t facetBytes = 50; // normal, 3 corners, 16 spare bits

void addCorner(Mesh& mesh, const glm::vec3& position, const glm::vec4& color) {
  for (int c = 0; c < 3; ++c)
    if (!std::isfinite(position[c]))
      throw LoadError(fmt::format("facet {}: a corner is not finite", mesh.vertexCount() / 3));
  Vertex vertex;
  vertex.position = position;
  vertex.color = color;
  mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertexCount()));
  mesh.add(vertex);
}

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
    constexpr std::string_view tag = "COLOR=";
    const std::size_t found = header.find(tag);
    magics_ = found != std::string_view::npos && found + tag.size() + 4 <= headerBytes;
    if (!magics_) return;
    glm::vec4 rgba;
    for (std::size_t c = 0; c < 4; ++c)
      rgba[static_cast<int>(c)] =
          static_cast<float>(std::to_integer<std::uint32_t>(file[found + tag.size() + c])) / 255.0F;
    default_ = glm::vec4(linearFromSrgb(glm::vec3(rgba)), rgba.a);
    any_ = true;
  }

  glm::vec4 of(std::uint32_t bits) {
    const bool marked = (bits & 0x8000U) != 0;
    if (magics_) return marked ? default_ : fiveBitColor(bits, bits >> 5U, bits >> 10U, default_.a);
    if (!marked) return default_;
    any_ = true;
    return fiveBitColor(bits >> 10U, bits >> 5U, bits, 1.0F);
  }

  // Whether any colour was stated so far.
  bool any() const { return any_; }

 private:
  glm::vec4 default_{0.8F, 0.8F, 0.8F, 1.0F}; // what a file without colours looks like
  bool magics_ = false;
  bool any_ = false;
};

Scene loadBinary(std::span<const std::byte> file, std::uint32_t facets) {
  FacetColors colors(file);
  Mesh mesh;
  mesh.positions.reserve(std::size_t{3} * facets);
  mesh.indices.reserve(std::size_t{3} * facets);
  for (std::size_t i = 0; i < facets; ++i) {
    const std::size_t begin = facetsBegin + i * facetBytes;
    const glm::vec4 color = colors.of(littleEndian(file, begin + 48, 2));
    for (std::size_t corner = 0; corner < 3; ++corner) {
      glm::vec3 position;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t bits = littleEndian(file, begin + 12 + corner * 12 + c * 4, 4);
        std::memcpy(&position[static_cast<int>(c)], &bits, sizeof bits);
      }
      addCorner(mesh, position, color);
    }
  }
  if (!colors.any()) mesh.colors.clear();
  Scene scene;
  addPlainMesh(scene, std::move(mesh), NormalsFrom::Places, plainMaterial(colors.any()));
  return scene;
}

Scene loadText(std::string_view text) {
  Mesh mesh;
  TextLines lines(text);
  std::size_t corners = 0; // of the loop that is open
  bool inLoop = false;
  while (lines.next()) {
    const std::string_view word = lines.word();
    if (word == "outer") {
      inLoop = true;
      corners = 0;
    } else if (word == "vertex") {
      if (!inLoop) lines.fail("a vertex stands outside of a loop");
      if (++corners > 3) lines.fail("a loop has more than 3 vertices");
      glm::vec3 position;
      for (int c = 0; c < 3; ++c) position[c] = lines.number();
      addCorner(mesh, position, glm::vec4(1.0F));
    } else if (word == "endloop") {
      if (!inLoop || corners != 3) lines.fail("a loop ends without 3 vertices");
      inLoop = false;
    }
  }
  if (inLoop) lines.fail("the file ends inside a loop");
  Scene scene;
  addPlainMesh(scene, std::move(mesh), NormalsFrom::Places, plainMaterial(false));
  return scene;
}

} // namespace

Scene loadStl(std::span<const std::byte> file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  const bool headed = file.size() >= facetsBegin;
  const std::uint32_t facets = headed ? littleEndian(file, headerBytes, 4) : 0;
  const std::size_t room = headed ? (file.size() - facetsBegin) / facetBytes : 0;
  // Binary files may begin with "solid" as well: the size tells.
  const bool exact = headed && facetsBegin + std::size_t{facets} * facetBytes == file.size();
  const std::size_t start = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  Scene scene;
  if (!exact && text.substr(start).starts_with("solid")) {
    scene = loadText(text);
  } else {
    if (!headed) throw LoadError(fmt::format("the file ends after {} bytes, in the STL header", file.size()));
    if (facets > room)
      throw LoadError(fmt::format("the STL header states {} facets, but the file has room for {}", facets, room));
    scene = loadBinary(file, facets);
  }
  requireDrawable(scene);
  return scene;
}

} // namespace vitrail::tool
