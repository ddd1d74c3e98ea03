// Makes meshes of the elements of an OBJ file.
#include "obj_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "../load.h"
#include "../mesh_build.h"
#include "origin.h"
#include "polygon.h"

namespace vitrail::tool {

ObjMesh ObjMeshMaker::faces(const std::vector<ObjRun>& runs) {
  std::size_t triangles = 0;
  forEach(runs, objFaces, [&](const ObjCorner*, std::uint32_t count) { triangles += count < 3 ? 0 : count - 2; });
  begin(triangles);
  forEach(runs, objFaces, [this](const ObjCorner* corner, std::uint32_t count) {
    if (count == 3)
      addIndices({vertexOf(corner[0]), vertexOf(corner[1]), vertexOf(corner[2])});
    else
      addOutline(corner, count);
  });
  return end();
}

Mesh ObjMeshMaker::lines(const std::vector<ObjRun>& runs) {
  begin(0);
  raw_.mesh.primitive = Primitive::Lines;
  forEach(runs, objLines, [this](const ObjCorner* corner, std::uint32_t count) {
    for (std::uint32_t i = 1; i < count; ++i) addIndices({vertexOf(corner[i - 1]), vertexOf(corner[i])});
  });
  return end().mesh;
}

Mesh ObjMeshMaker::points(const std::vector<ObjRun>& runs) {
  begin(0);
  raw_.mesh.primitive = Primitive::Points;
  forEach(runs, objPoints, [this](const ObjCorner* corner, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i)
      if (text_.isFinite(corner[i])) addIndices({vertexOf(corner[i])});
  });
  return end().mesh;
}

Mesh ObjMeshMaker::cloud() {
  begin(0);
  raw_.mesh.primitive = Primitive::Points;
  for (std::size_t i = 0; i < text_.positions.size(); ++i) {
    ObjCorner corner;
    corner.position = static_cast<std::int32_t>(i);
    if (text_.isFinite(corner)) addIndices({vertexOf(corner)});
  }
  return end().mesh;
}

void ObjMeshMaker::begin(std::size_t triangles) {
  raw_ = {};
  raw_.mesh.indices.reserve(3 * triangles);
  const std::size_t likely = std::min(3 * triangles, text_.positions.size());
  raw_.mesh.positions.reserve(likely);
  corners_.reserve(likely);
  older_.reserve(likely);
}

ObjMesh ObjMeshMaker::end() {
  for (const ObjCorner& corner : corners_) newest_[static_cast<std::size_t>(corner.position)] = none;
  addAttributes();
  corners_ = {};
  older_ = {};
  return std::move(raw_);
}

void ObjMeshMaker::addIndices(std::initializer_list<std::uint32_t> indices) {
  raw_.mesh.indices.insert(raw_.mesh.indices.end(), indices);
}

void ObjMeshMaker::addOutline(const ObjCorner* corner, std::uint32_t count) {
  if (count < 3) {
    hasSlivers_ = true;
    return;
  }
  outline_.clear();
  for (std::uint32_t i = 0; i < count; ++i) outline_.push_back(vertexOf(corner[i]));
  addPolygon(outline_, raw_.mesh.positions, raw_.mesh.indices);
}

std::uint32_t ObjMeshMaker::vertexOf(const ObjCorner& corner) {
  std::uint32_t& newest = newest_[static_cast<std::size_t>(corner.position)];
  // Where a file makes them many, some become vertices twice.
  std::uint32_t looks = 64;
  for (std::uint32_t i = newest; i != none && looks > 0; i = older_[i], --looks)
    if (corners_[i].texCoord == corner.texCoord && corners_[i].normal == corner.normal) return i;
  if (corners_.size() >= none) throw LoadError("more vertices than 32-bit indices can name");
  const auto index = static_cast<std::uint32_t>(corners_.size());
  older_.push_back(newest);
  newest = index;
  corners_.push_back(corner);
  raw_.mesh.positions.emplace_back(text_.positions[static_cast<std::size_t>(corner.position)] - origin_);
  return index;
}

void ObjMeshMaker::addAttributes() {
  const std::size_t count = corners_.size();
  if (std::ranges::any_of(corners_, [](const ObjCorner& corner) { return corner.texCoord >= 0; })) {
    raw_.mesh.texCoords0.resize(count, glm::vec2(0.0F));
    for (std::size_t i = 0; i < count; ++i)
      if (corners_[i].texCoord >= 0)
        raw_.mesh.texCoords0[i] = text_.texCoords[static_cast<std::size_t>(corners_[i].texCoord)];
  }
  // A corner without a normal gets its face's, if others have one.
  if (std::ranges::any_of(corners_, [](const ObjCorner& corner) { return corner.normal >= 0; })) {
    raw_.normals.resize(count, glm::vec3(0.0F));
    for (std::size_t i = 0; i < count; ++i)
      if (corners_[i].normal >= 0) raw_.normals[i] = text_.normals[static_cast<std::size_t>(corners_[i].normal)];
  }
  if (text_.colors.empty()) return;
  raw_.mesh.colors.reserve(count);
  for (const ObjCorner& corner : corners_)
    raw_.mesh.colors.push_back(packColor(text_.colors[static_cast<std::size_t>(corner.position)]));
}

void smoothObj(ObjMesh& raw, std::int64_t smoothing) {
  constexpr float crease = std::numbers::pi_v<float> / 4.0F;
  dropDegenerateTriangles(raw.mesh);
  if (raw.mesh.indices.empty()) { // vertices that nothing shows would have no normals
    raw = {};
    return;
  }
  if (smoothing == ObjSmoothing::off)
    makeFlatNormals(raw.mesh);
  else
    makeCreasedNormals(raw.mesh, smoothing == ObjSmoothing::unstated ? crease : std::numbers::pi_v<float>);
  raw.normals.clear();
  for (const std::uint32_t normal : raw.mesh.normals) raw.normals.push_back(unpackDirection(normal));
  raw.mesh.normals.clear();
}

void appendObj(ObjMesh& raw, const ObjMesh& more) {
  const std::size_t first = raw.mesh.vertexCount();
  const std::size_t count = first + more.mesh.vertexCount();
  const auto add = [](auto& values, const auto& others) { values.insert(values.end(), others.begin(), others.end()); };
  for (const std::uint32_t index : more.mesh.indices)
    raw.mesh.indices.push_back(static_cast<std::uint32_t>(first) + index);
  add(raw.mesh.positions, more.mesh.positions);
  add(raw.normals, more.normals);
  add(raw.mesh.colors, more.mesh.colors);
  if (raw.mesh.texCoords0.empty() && more.mesh.texCoords0.empty()) return;
  raw.mesh.texCoords0.resize(first, glm::vec2(0.0F));
  add(raw.mesh.texCoords0, more.mesh.texCoords0);
  raw.mesh.texCoords0.resize(count, glm::vec2(0.0F));
}

// The box around what elements use. Some files hold a stray vertex at the origin.
glm::dvec3 originOfObj(const ObjText& text) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  glm::dvec3 min(infinity);
  glm::dvec3 max(-infinity);
  const auto include = [&](const glm::dvec3& position) {
    if (std::isnan(position.x)) return;
    min = glm::min(min, position);
    max = glm::max(max, position);
  };
  for (const glm::dvec3& position : text.positions) include(position);
  const glm::dvec3 far = glm::max(glm::abs(min), glm::abs(max));
  // Nearer than this floats are fine enough for anything that one would look at.
  if (!(std::max({far.x, far.y, far.z}) > 1000.0)) return originOf(min, max);
  glm::dvec3 usedMin(infinity);
  std::swap(min, usedMin);
  glm::dvec3 usedMax(-infinity);
  std::swap(max, usedMax);
  bool any = false;
  for (const ObjPart& part : text.parts)
    for (const ObjElements& elements : part.elements)
      for (const ObjCorner& corner : elements.corners) {
        include(text.positions[static_cast<std::size_t>(corner.position)]);
        any = true;
      }
  return any ? originOf(min, max) : originOf(usedMin, usedMax);
}

} // namespace vitrail::tool
