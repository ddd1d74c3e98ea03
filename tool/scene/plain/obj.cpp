// Loads OBJ: polygons with texture coordinates, normals, vertex colours (v x y z r g b, with a seventh number as alpha)
// and the materials of its libraries. Each material becomes one mesh. Curves, lines, points and groups are passed over.
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../load.h"
#include "../mesh_build.h"
#include "../message.h"
#include "../read_file.h"
#include "model.h"
#include "mtl.h"
#include "polygon.h"
#include "text_reader.h"

namespace vitrail::tool {
namespace {

using Materials = std::map<std::string, MtlMaterial, std::less<>>;

// A line may go on after a backslash. Blanks in their place keep the rest as it is.
std::string joinedLines(std::string_view text) {
  std::string joined(text);
  for (std::size_t i = joined.find('\\'); i != std::string::npos; i = joined.find('\\', i + 1)) {
    const std::size_t end = i + 1 < joined.size() && joined[i + 1] == '\r' ? i + 2 : i + 1;
    if (end >= joined.size() || joined[end] != '\n') continue;
    for (std::size_t c = i; c <= end; ++c) joined[c] = ' ';
  }
  return joined;
}

// What the faces refer to.
struct ObjAttributes {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec4> colors; // linear; as many as positions, or none at all
  std::vector<glm::vec2> texCoords;
  std::vector<glm::vec3> normals;
};

void readPosition(TextLines& lines, ObjAttributes& attributes) {
  glm::vec3 position;
  for (int c = 0; c < 3; ++c) position[c] = lines.number();
  std::vector<float> rest;
  while (lines.more() && rest.size() < 4) rest.push_back(lines.number());
  attributes.positions.push_back(position);
  // A single number is a weight, which polygons do not have.
  if (rest.size() < 3 && attributes.colors.empty()) return;
  attributes.colors.resize(attributes.positions.size(), glm::vec4(1.0F));
  if (rest.size() < 3) return;
  const float alpha = rest.size() > 3 ? std::clamp(rest[3], 0.0F, 1.0F) : 1.0F;
  attributes.colors.back() = glm::vec4(linearFromSrgb({rest[0], rest[1], rest[2]}), alpha);
}

ObjAttributes readAttributes(std::string_view text) {
  ObjAttributes attributes;
  TextLines lines(text);
  while (lines.next()) {
    const std::string_view word = lines.word();
    if (word == "v") {
      readPosition(lines, attributes);
    } else if (word == "vt") {
      const float u = lines.number();
      // v grows upwards in OBJ and downwards in glTF.
      attributes.texCoords.emplace_back(u, lines.more() ? 1.0F - lines.number() : 1.0F);
    } else if (word == "vn") {
      const float x = lines.number();
      const float y = lines.number();
      attributes.normals.emplace_back(x, y, lines.number());
    }
  }
  return attributes;
}

// Indices from 0; -1: none.
struct Corner {
  std::int64_t position = -1;
  std::int64_t texCoord = -1;
  std::int64_t normal = -1;

  bool operator==(const Corner&) const = default;
};

struct CornerHash {
  std::size_t operator()(const Corner& corner) const {
    const auto mixed = static_cast<std::uint64_t>(corner.position) * 0x9e3779b97f4a7c15ULL ^
                       static_cast<std::uint64_t>(corner.texCoord) * 0xc2b2ae3d27d4eb4fULL ^
                       static_cast<std::uint64_t>(corner.normal) * 0x165667b19e3779f9ULL;
    return static_cast<std::size_t>(mixed ^ (mixed >> 32U));
  }
};

// The faces of one material.
struct Part {
  Mesh mesh;
  std::unordered_map<Corner, std::uint32_t, CornerHash> vertices;
  bool hasNormals = false;
  std::vector<glm::vec3> normals; // of the vertices
};

class ObjReader {
 public:
  ObjReader(std::string_view text, std::filesystem::path base)
      : text_(text), attributes_(readAttributes(text)), base_(std::move(base)) {}

  Scene read() {
    readStatements();
    Scene scene;
    TextureFiles textures(base_);
    for (const std::string& name : order_) {
      Part& part = parts_.at(name);
      addPlainMesh(scene, std::move(part.mesh), part.hasNormals ? NormalsFrom::File : NormalsFrom::Places,
                   materialOf(name, scene, textures), std::move(part.normals));
    }
    requireDrawable(scene);
    return scene;
  }

 private:
  void readStatements() {
    TextLines lines(text_);
    Part* part = nullptr;
    std::string material;
    while (lines.next()) {
      const std::string_view word = lines.word();
      // Negative indices count from what has been stated so far.
      if (word == "v") ++positionsSoFar_;
      if (word == "vt") ++texCoordsSoFar_;
      if (word == "vn") ++normalsSoFar_;
      if (word == "mtllib") readLibrary(std::string(lines.rest()));
      if (word == "usemtl") {
        material = lines.rest();
        part = nullptr;
      }
      if (word != "f") continue;
      if (part == nullptr) part = partOf(material);
      readFace(lines, *part);
    }
  }

  Part* partOf(const std::string& material) {
    const auto [place, isNew] = parts_.try_emplace(material);
    if (isNew) order_.push_back(material);
    return &place->second;
  }

  // A missing library leaves plain materials.
  void readLibrary(std::string name) {
    std::ranges::replace(name, '\\', '/');
    try {
      const std::vector<std::byte> file = readFileBeside(name, base_);
      readMtl({reinterpret_cast<const char*>(file.data()), file.size()}, materials_);
    } catch (const LoadError&) {
      return;
    }
  }

  void readFace(TextLines& lines, Part& part) {
    outline_.clear();
    while (lines.more()) outline_.push_back(vertexOf(readCorner(lines), part));
    addPolygon(outline_, part.mesh.positions, part.mesh.indices);
  }

  // "7", "7/2", "7/2/3" or "7//3".
  Corner readCorner(TextLines& lines) const {
    std::string_view word = lines.word();
    const auto next = [&word] {
      const std::size_t slash = std::min(word.find('/'), word.size());
      const std::string_view part = word.substr(0, slash);
      word.remove_prefix(std::min(slash + 1, word.size()));
      return part;
    };
    Corner corner;
    corner.position = index(next(), positionsSoFar_, attributes_.positions.size(), "vertex", lines);
    if (const auto part = next(); !part.empty())
      corner.texCoord = index(part, texCoordsSoFar_, attributes_.texCoords.size(), "texture coordinate", lines);
    if (const auto part = next(); !part.empty())
      corner.normal = index(part, normalsSoFar_, attributes_.normals.size(), "normal", lines);
    return corner;
  }

  static std::int64_t index(std::string_view word, std::int64_t soFar, std::size_t count, std::string_view what,
                            const TextLines& lines) {
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (word.empty() || error != std::errc{} || end != word.data() + word.size())
      lines.fail(fmt::format("\"{}\" is not the number of a {}", oneLine(word), what));
    if (number == 0 || number < -soFar || number > static_cast<std::int64_t>(count))
      lines.fail(fmt::format("a face names {} {}, but there are {}", what, number,
                             number < 0 ? soFar : static_cast<std::int64_t>(count)));
    return number > 0 ? number - 1 : soFar + number;
  }

  std::uint32_t vertexOf(const Corner& corner, Part& part) const {
    const auto [place, isNew] = part.vertices.try_emplace(corner, static_cast<std::uint32_t>(part.mesh.vertexCount()));
    if (!isNew) return place->second;
    Vertex vertex;
    vertex.position = attributes_.positions[static_cast<std::size_t>(corner.position)];
    if (!attributes_.colors.empty()) vertex.color = attributes_.colors[static_cast<std::size_t>(corner.position)];
    if (corner.texCoord >= 0) vertex.texCoord0 = attributes_.texCoords[static_cast<std::size_t>(corner.texCoord)];
    // A corner without a normal gets its face's, if others have one.
    part.normals.push_back(corner.normal >= 0 ? attributes_.normals[static_cast<std::size_t>(corner.normal)]
                                              : glm::vec3(0.0F));
    part.hasNormals = part.hasNormals || corner.normal >= 0;
    part.mesh.add(vertex);
    return place->second;
  }

  Material materialOf(const std::string& name, Scene& scene, TextureFiles& textures) const {
    const auto found = materials_.find(name);
    if (found == materials_.end()) {
      Material material = plainMaterial(!attributes_.colors.empty());
      material.name = name;
      return material;
    }
    const MtlMaterial& source = found->second;
    TextureSlot texture;
    if (!source.diffuseMap.empty()) texture = textures.read(scene, source.diffuseMap);
    if (source.clamp) texture.sampler.wrapU = texture.sampler.wrapV = Wrap::ClampToEdge;
    Material material = plainMaterial(texture.image >= 0 || !attributes_.colors.empty());
    material.name = name;
    material.baseColorTexture = texture;
    // Writers that rely on the texture alone leave its factor black.
    const bool black = source.diffuse == glm::vec3(0.0F);
    if (source.diffuse && !(black && texture.image >= 0))
      material.baseColor = glm::vec4(linearFromSrgb(*source.diffuse), 1.0F);
    material.baseColor.a = source.opacity;
    material.emissive = linearFromSrgb(source.emissive);
    return material;
  }

  std::string_view text_;
  ObjAttributes attributes_;
  std::filesystem::path base_;
  Materials materials_;
  std::map<std::string, Part, std::less<>> parts_; // by the name of their material
  std::vector<std::string> order_;                 // of the parts, as they come in the file
  std::vector<std::uint32_t> outline_;             // of the face that is read
  std::int64_t positionsSoFar_ = 0;
  std::int64_t texCoordsSoFar_ = 0;
  std::int64_t normalsSoFar_ = 0;
};

} // namespace

Scene loadObj(std::span<const std::byte> file, const std::filesystem::path& base) {
  const std::string text = joinedLines({reinterpret_cast<const char*>(file.data()), file.size()});
  return ObjReader(text, base).read();
}

} // namespace vitrail::tool
