// Loads PLY: text and binary of both byte orders, as scanners, photogrammetry and mesh programs write it. Faces are
// polygons or triangle strips with colours of vertices, faces or corners and with textures; a file without faces is
// drawn as points, edges as lines.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../load.h"
#include "../mesh_build.h"
#include "../message.h"
#include "model.h"
#include "ply_data.h"
#include "polygon.h"

namespace vitrail::tool {
namespace {

std::vector<glm::vec2> finiteTexCoords(std::vector<glm::vec2> texCoords) {
  for (glm::vec2& place : texCoords)
    if (!std::isfinite(place.x) || !std::isfinite(place.y)) place = glm::vec2(0.0F);
  return texCoords;
}

bool isDirection(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && v != glm::vec3(0.0F);
}

// What a vertex is beside its place: of the file's vertex itself, or of a corner of a face.
struct Look {
  std::uint64_t color = 0; // packed; of no meaning where there are none
  glm::vec2 texCoord{0.0F};

  bool operator==(const Look&) const = default;
};

// A triangle's corners as places in PlyData::corners, and the face that it is of.
struct CornerTriangles {
  std::vector<std::uint32_t> corners;
  std::vector<std::uint32_t> faces;
};

class PlyScene {
 public:
  PlyScene(const PlyHeader& header, PlyData data, const std::filesystem::path& base)
      : header_(header), data_(std::move(data)), textures_(base) {}

  Scene build(const glm::dvec3& origin) {
    scene_.origin = origin;
    scene_.file.format = header_.encoding == PlyEncoding::Text ? "PLY (text)" : "PLY (binary)";
    scene_.file.generator = printable(header_.generator);
    for (std::string& line : data_.warnings) warn(scene_, std::move(line));
    // Programs write zeros where they have no normals.
    if (std::ranges::none_of(data_.normals, isDirection)) data_.normals.clear();
    const bool anyFace = !data_.corners.empty();
    if (anyFace) addFaces();
    if (!data_.edges.empty()) addEdges();
    if (!anyFace && data_.edges.empty()) addPoints();
    if (scene_.draws.empty() && data_.notFinite > 0)
      throw LoadError("everything in it has a vertex that is not finite");
    return std::move(scene_);
  }

 private:
  bool isFinite(std::uint32_t vertex) const { return !std::isnan(data_.positions[vertex].x); }

  // --- Faces.

  // What faces need of their corners, and of the file's textures. Textures hide colours: the programs that write both
  // take the one for the likeness of the other.
  void chooseLooks() {
    const bool anyTexCoords = !data_.cornerTexCoords.empty() || !data_.texCoords.empty();
    for (const std::string& name : header_.textures) {
      if (anyTexCoords)
        slots_.push_back(textures_.read(scene_, name));
      else
        warn(scene_,
             fmt::format("TextureFile {}: is not drawn, since the file has no texture coordinates", oneLine(name)));
    }
    textured_ = std::ranges::any_of(slots_, [](const TextureSlot& slot) { return slot.image >= 0; });
    const bool anyColors = !data_.colors.empty() || !data_.faceColors.empty() || !data_.cornerColors.empty();
    if (textured_ && anyColors) warn(scene_, "the colours of vertices and faces are not drawn: the texture is");
    const bool fainter = data_.onlyAlpha && (!data_.faceColors.empty() || !data_.cornerColors.empty());
    if (!textured_ && fainter) warn(scene_, "the alpha of vertices is not drawn: the colours of faces are");
    vertexColors_ = !textured_ && !data_.colors.empty() && !fainter;
    cornerColors_ = !textured_ && !vertexColors_ && !data_.cornerColors.empty();
    faceColors_ = !textured_ && !vertexColors_ && !cornerColors_ && !data_.faceColors.empty();
    if (vertexColors_ && (!data_.faceColors.empty() || !data_.cornerColors.empty()))
      warn(scene_, "the colours of faces are not drawn: those of vertices are");
    cornerTexCoords_ = textured_ && !data_.cornerTexCoords.empty();
    if (header_.textures.empty() && !data_.cornerTexCoords.empty())
      warn(scene_, "the texture is not drawn: the file has texture coordinates of faces, but names no TextureFile");
    if (data_.oddTexCoords > 0)
      warn(scene_,
           fmt::format(
               "passed over, since they do not have two numbers a corner: the texture coordinates of {} of {} faces",
               data_.oddTexCoords, data_.faceCount));
  }

  Look lookOf(std::uint32_t corner, std::uint32_t face) const {
    const std::uint32_t vertex = data_.corners[corner];
    Look look;
    if (vertexColors_) look.color = data_.colors[vertex];
    if (cornerColors_) look.color = data_.cornerColors[corner];
    if (faceColors_) look.color = data_.faceColors[face];
    if (cornerTexCoords_)
      look.texCoord = data_.cornerTexCoords[corner];
    else if (textured_)
      look.texCoord = data_.texCoords[vertex];
    return look;
  }

  void addFaces() {
    chooseLooks();
    const bool severalTextures = textured_ && slots_.size() > 1 && !data_.faceTextures.empty();
    const bool shared = !cornerColors_ && !faceColors_ && !cornerTexCoords_ && !severalTextures;
    if (shared && data_.sizes.empty() && data_.notFinite == 0) {
      addSharedVertices(std::move(data_.corners));
      return;
    }
    CornerTriangles triangles = splitFaces();
    if (shared) {
      for (std::uint32_t& corner : triangles.corners) corner = data_.corners[corner];
      addSharedVertices(std::move(triangles.corners));
      return;
    }
    if (data_.normals.empty()) makeVertexNormals(triangles);
    std::map<std::int32_t, CornerTriangles> groups; // by texture
    if (severalTextures) {
      for (std::size_t i = 0; i < triangles.faces.size(); ++i) {
        CornerTriangles& group = groups[textureOf(triangles.faces[i])];
        group.faces.push_back(triangles.faces[i]);
        for (std::size_t c = 0; c < 3; ++c) group.corners.push_back(triangles.corners[3 * i + c]);
      }
    } else {
      groups[slots_.empty() ? -1 : 0] = std::move(triangles);
    }
    for (const auto& [texture, group] : groups) addSplitVertices(group, texture);
  }

  // -1: none.
  std::int32_t textureOf(std::uint32_t face) const {
    const std::int32_t number = data_.faceTextures[face];
    return number >= 0 && static_cast<std::size_t>(number) < slots_.size() ? number : -1;
  }

  // Splits faces into triangles, and leaves out those with a corner that is not finite.
  CornerTriangles splitFaces() {
    CornerTriangles triangles;
    triangles.corners.reserve(data_.corners.size());
    triangles.faces.reserve(data_.faceCount);
    std::vector<glm::vec3> outline;
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> pieces;
    std::size_t left = 0;
    std::uint32_t begin = 0;
    for (std::uint32_t face = 0; face < data_.faceCount; ++face) {
      const std::uint32_t size = data_.sizes.empty() ? 3 : data_.sizes[face];
      const auto corners = std::span(data_.corners).subspan(begin, size);
      if (data_.notFinite > 0 && !std::ranges::all_of(corners, [&](std::uint32_t i) { return isFinite(i); })) {
        ++left;
      } else if (size == 3) {
        triangles.corners.insert(triangles.corners.end(), {begin, begin + 1, begin + 2});
        triangles.faces.push_back(face);
      } else if (size > 3) {
        outline.resize(size);
        order.resize(size);
        pieces.clear();
        for (std::uint32_t i = 0; i < size; ++i) {
          outline[i] = data_.positions[corners[i]];
          order[i] = i;
        }
        addPolygon(order, outline, pieces);
        for (const std::uint32_t piece : pieces) triangles.corners.push_back(begin + piece);
        triangles.faces.insert(triangles.faces.end(), pieces.size() / 3, face);
      }
      begin += size;
    }
    if (left > 0)
      warn(scene_, fmt::format("left out, since a vertex is not finite: {} of {} faces", left, data_.faceCount));
    return triangles;
  }

  // The file's vertices as they are, and not again what of them later steps do not need.
  void addSharedVertices(std::vector<std::uint32_t> indices) {
    Mesh mesh;
    mesh.indices = std::move(indices);
    mesh.positions = data_.edges.empty() ? std::move(data_.positions) : data_.positions;
    if (vertexColors_) mesh.colors = data_.edges.empty() ? std::move(data_.colors) : data_.colors;
    if (textured_ && !data_.texCoords.empty()) mesh.texCoords0 = finiteTexCoords(std::move(data_.texCoords));
    const NormalsFrom normals = data_.normals.empty() ? NormalsFrom::SharedCorners : NormalsFrom::File;
    addPlainMesh(scene_, std::move(mesh), normals, material(0), std::move(data_.normals));
  }

  // Before vertices are split, so that faces of two colours still share their normals.
  void makeVertexNormals(const CornerTriangles& triangles) {
    Mesh mesh;
    mesh.positions = data_.positions;
    for (const std::uint32_t corner : triangles.corners) mesh.indices.push_back(data_.corners[corner]);
    makeSmoothNormals(mesh);
    for (const std::uint32_t normal : mesh.normals) data_.normals.push_back(unpackDirection(normal));
  }

  // A vertex for each look that a vertex of the file has in the faces around it.
  void addSplitVertices(const CornerTriangles& triangles, std::int32_t texture) {
    constexpr std::uint32_t noVertex = 0xffffffff;
    constexpr int mostLooks = 32; // what a hostile file makes of it stays linear
    std::vector<std::uint32_t> newest(data_.positions.size(), noVertex);
    std::vector<std::uint32_t> older; // of the mesh's vertices: the one before of the same vertex of the file
    std::vector<Look> looks;
    std::vector<glm::vec3> normals;
    Mesh mesh;
    for (std::size_t i = 0; i < triangles.corners.size(); ++i) {
      const std::uint32_t corner = triangles.corners[i];
      const std::uint32_t vertex = data_.corners[corner];
      const Look look = lookOf(corner, triangles.faces[i / 3]);
      std::uint32_t found = newest[vertex];
      for (int n = 0; found != noVertex && looks[found] != look; ++n) found = n < mostLooks ? older[found] : noVertex;
      if (found == noVertex) {
        found = static_cast<std::uint32_t>(looks.size());
        older.push_back(newest[vertex]);
        newest[vertex] = found;
        looks.push_back(look);
        normals.push_back(data_.normals[vertex]);
        mesh.positions.push_back(data_.positions[vertex]);
        if (colored()) mesh.colors.push_back(look.color);
        if (textured_) mesh.texCoords0.push_back(look.texCoord);
      }
      mesh.indices.push_back(found);
    }
    if (textured_) mesh.texCoords0 = finiteTexCoords(std::move(mesh.texCoords0));
    addPlainMesh(scene_, std::move(mesh), NormalsFrom::File, material(texture), std::move(normals));
  }

  bool colored() const { return vertexColors_ || cornerColors_ || faceColors_; }

  Material material(std::int32_t texture) const {
    TextureSlot slot;
    if (texture >= 0 && static_cast<std::size_t>(texture) < slots_.size())
      slot = slots_[static_cast<std::size_t>(texture)];
    Material result = plainMaterial(colored() || slot.image >= 0);
    result.baseColorTexture = slot;
    return result;
  }

  // --- Edges and points.

  void addEdges() {
    vertexColors_ = !data_.colors.empty();
    Mesh mesh;
    mesh.primitive = Primitive::Lines;
    const bool own = !data_.edgeColors.empty();
    std::size_t left = 0;
    for (std::size_t i = 0; i < data_.edges.size(); i += 2) {
      if (!isFinite(data_.edges[i]) || !isFinite(data_.edges[i + 1])) {
        ++left;
        continue;
      }
      for (std::size_t c = 0; c < 2; ++c) {
        const std::uint32_t vertex = data_.edges[i + c];
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(data_.positions[vertex]);
        if (own || vertexColors_) mesh.colors.push_back(own ? data_.edgeColors[i / 2] : data_.colors[vertex]);
      }
    }
    if (left > 0)
      warn(scene_, fmt::format("left out, since an end is not finite: {} of {} edges", left, data_.edges.size() / 2));
    addUnlitMesh(scene_, std::move(mesh), plainMaterial(own || vertexColors_));
  }

  void addPoints() {
    vertexColors_ = !data_.colors.empty();
    if (data_.splats)
      warn(scene_,
           "the vertices are Gaussian splats: their centres are drawn as points in their first colour; their extent "
           "(scale, rot) and what depends on the view (f_rest) are not drawn");
    if (data_.notFinite > 0)
      warn(scene_, fmt::format("left out, since they are not finite: {} of {} points", data_.notFinite,
                               data_.positions.size()));
    Mesh mesh;
    mesh.primitive = Primitive::Points;
    if (data_.notFinite > 0) keepFinitePoints();
    mesh.positions = std::move(data_.positions);
    if (vertexColors_) mesh.colors = std::move(data_.colors);
    for (const glm::vec3& normal : data_.normals)
      mesh.normals.push_back(packDirection(isDirection(normal) ? glm::vec3(glm::normalize(glm::dvec3(normal)))
                                                               : glm::vec3(0.0F, 0.0F, 1.0F)));
    mesh.indices.resize(mesh.positions.size());
    std::iota(mesh.indices.begin(), mesh.indices.end(), 0U);
    addUnlitMesh(scene_, std::move(mesh), plainMaterial(vertexColors_));
  }

  void keepFinitePoints() {
    std::size_t kept = 0;
    for (std::uint32_t i = 0; i < data_.positions.size(); ++i) {
      if (!isFinite(i)) continue;
      data_.positions[kept] = data_.positions[i];
      if (!data_.colors.empty()) data_.colors[kept] = data_.colors[i];
      if (!data_.normals.empty()) data_.normals[kept] = data_.normals[i];
      ++kept;
    }
    data_.positions.resize(kept);
    if (!data_.colors.empty()) data_.colors.resize(kept);
    if (!data_.normals.empty()) data_.normals.resize(kept);
  }

  const PlyHeader& header_;
  PlyData data_;
  TextureFiles textures_;
  Scene scene_;
  std::vector<TextureSlot> slots_; // of the header's textures; an image of -1: it could not be read
  bool textured_ = false;
  bool vertexColors_ = false;
  bool cornerColors_ = false;
  bool faceColors_ = false;
  bool cornerTexCoords_ = false;
};

} // namespace

Scene loadPly(std::span<const std::byte> file, const std::filesystem::path& base) {
  const PlyHeader header = parsePlyHeader({reinterpret_cast<const char*>(file.data()), file.size()});
  const std::span<const std::byte> body = file.subspan(header.bodyOffset);
  PlyData data = readPlyBody(header, body, glm::dvec3(0.0));
  // Few models are far away; those are read a second time rather than all kept in double precision.
  const glm::dvec3 origin = data.bounds.origin();
  if (origin != glm::dvec3(0.0)) {
    data = {};
    data = readPlyBody(header, body, origin);
  }
  Scene scene = PlyScene(header, std::move(data), base).build(origin);
  requireDrawable(scene);
  return scene;
}

} // namespace vitrail::tool
