// Makes meshes that keep the promises of scene.h.
#include "mesh_build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "load.h"
#include "threads.h"

namespace vitrail::tool {
namespace {

bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Twice the area, along the normal. In double precision, where no product of finite floats overflows or vanishes.
glm::dvec3 areaVector(const Mesh& mesh, std::size_t firstIndex) {
  const auto corner = [&](std::size_t i) { return glm::dvec3(mesh.positions[mesh.indices[firstIndex + i]]); };
  const glm::dvec3 a = corner(0);
  return glm::cross(corner(1) - a, corner(2) - a);
}

// Zero where the vector has no direction.
glm::vec3 unit(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? glm::vec3(v / length) : glm::vec3(0.0F);
}

// The sum of the area vectors around each vertex, in the square of the model's size, so that floats hold those of any
// model.
std::vector<glm::vec3> sumAreas(const Mesh& mesh) {
  std::vector<glm::vec3> sums(mesh.vertexCount(), glm::vec3(0.0F));
  if (mesh.indices.empty()) return sums;
  glm::vec3 low = mesh.positions[mesh.indices[0]];
  glm::vec3 high = low;
  for (const std::uint32_t index : mesh.indices) {
    low = glm::min(low, mesh.positions[index]);
    high = glm::max(high, mesh.positions[index]);
  }
  const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low);
  const double scale = 1.0 / std::max({size.x, size.y, size.z, std::numeric_limits<double>::min()});
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3 area(areaVector(mesh, i) * scale * scale);
    for (std::size_t c = 0; c < 3; ++c) sums[mesh.indices[i + c]] += area;
  }
  return sums;
}

// Packs normals of any length. The triangles around a vertex can cancel each other out, which leaves none: then any one
// of them gives the normal.
void setNormals(Mesh& mesh, std::vector<glm::vec3> normals) {
  if (std::ranges::find(normals, glm::vec3(0.0F)) != normals.end())
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      for (std::size_t c = 0; c < 3; ++c) {
        glm::vec3& normal = normals[mesh.indices[i + c]];
        if (normal == glm::vec3(0.0F)) normal = unit(areaVector(mesh, i));
      }
  mesh.normals.resize(normals.size());
  for (std::size_t i = 0; i < normals.size(); ++i)
    mesh.normals[i] =
        packDirection(normals[i] == glm::vec3(0.0F) ? glm::vec3(0.0F, 0.0F, 1.0F) : unit(glm::dvec3(normals[i])));
}

glm::vec3 anyOrthogonal(const glm::vec3& normal) {
  const glm::vec3 axis = std::abs(normal.x) < 0.5F ? glm::vec3(1.0F, 0.0F, 0.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
  return glm::normalize(axis - normal * glm::dot(axis, normal));
}

// The tangent made orthogonal to the normal; any orthogonal direction where too little of it is left.
glm::vec3 orthogonalTangent(const glm::dvec3& tangent, const glm::vec3& normal) {
  const glm::dvec3 n(normal);
  const glm::vec3 direction = unit(tangent);
  const glm::dvec3 rest = glm::dvec3(direction) - n * glm::dot(glm::dvec3(direction), n);
  return glm::length(rest) > 1e-4 ? unit(rest) : anyOrthogonal(normal);
}

glm::vec2 slotCoordinates(const Mesh& mesh, std::uint32_t vertex, const TextureSlot& slot) {
  const std::vector<glm::vec2>& set = slot.texCoord == 0 ? mesh.texCoords0 : mesh.texCoords1;
  return glm::vec2(slot.transform * glm::vec3(set.empty() ? glm::vec2(0.0F) : set[vertex], 1.0F));
}

struct TriangleTangent {
  glm::dvec3 direction; // along growing u, weighted by area
  float sign;           // w: -1 where the picture is mirrored
};

TriangleTangent triangleTangent(const Mesh& mesh, std::size_t firstIndex, const TextureSlot& slot) {
  const std::uint32_t a = mesh.indices[firstIndex];
  const std::uint32_t b = mesh.indices[firstIndex + 1];
  const std::uint32_t c = mesh.indices[firstIndex + 2];
  const glm::dvec3 edge1 = glm::dvec3(mesh.positions[b]) - glm::dvec3(mesh.positions[a]);
  const glm::dvec3 edge2 = glm::dvec3(mesh.positions[c]) - glm::dvec3(mesh.positions[a]);
  const glm::dvec2 uv1 = glm::dvec2(slotCoordinates(mesh, b, slot)) - glm::dvec2(slotCoordinates(mesh, a, slot));
  const glm::dvec2 uv2 = glm::dvec2(slotCoordinates(mesh, c, slot)) - glm::dvec2(slotCoordinates(mesh, a, slot));
  const double determinant = uv1.x * uv2.y - uv2.x * uv1.y;
  // v grows down the image, and glTF's bitangent w * cross(normal, tangent) points up it: the picture is unmirrored,
  // and w is +1, where u and v turn clockwise.
  const double growth = determinant < 0.0 ? -1.0 : 1.0;
  const glm::dvec3 direction = glm::dvec3(unit((edge1 * uv2.y - edge2 * uv1.y) * growth));
  return {direction * glm::length(areaVector(mesh, firstIndex)), determinant > 0.0 ? -1.0F : 1.0F};
}

} // namespace

std::vector<std::uint32_t> triangleList(std::span<const std::uint32_t> indices, Topology topology) {
  std::vector<std::uint32_t> list;
  const auto add = [&list](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) list.insert(list.end(), {a, b, c});
  };
  if (indices.size() < 3) return list;
  list.reserve(topology == Topology::Triangles ? indices.size() : (indices.size() - 2) * 3);
  switch (topology) {
    case Topology::Triangles:
      for (std::size_t i = 0; i + 2 < indices.size(); i += 3) add(indices[i], indices[i + 1], indices[i + 2]);
      break;
    case Topology::Strip:
      for (std::size_t i = 0; i + 2 < indices.size(); ++i)
        add(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
      break;
    case Topology::Fan:
      for (std::size_t i = 1; i + 1 < indices.size(); ++i) add(indices[i], indices[i + 1], indices[0]);
      break;
  }
  return list;
}

std::vector<std::uint32_t> lineList(std::span<const std::uint32_t> indices, LineTopology topology) {
  std::vector<std::uint32_t> list;
  const auto add = [&list](std::uint32_t a, std::uint32_t b) {
    if (a != b) list.insert(list.end(), {a, b});
  };
  const std::size_t step = topology == LineTopology::Lines ? 2 : 1;
  for (std::size_t i = 0; i + 1 < indices.size(); i += step) add(indices[i], indices[i + 1]);
  if (topology == LineTopology::Loop && indices.size() > 2) add(indices.back(), indices.front());
  return list;
}

void dropDegenerateTriangles(Mesh& mesh) {
  // Few meshes have any, and those that have none need not be written again.
  constexpr std::size_t leastTriangles = 20'000;
  const std::size_t triangles = mesh.indices.size() / 3;
  const std::size_t parts = partsFor(triangles, leastTriangles);
  std::vector<char> found(parts, 0);
  inParts(parts, [&](std::size_t part) {
    for (std::size_t i = triangles * part / parts; found[part] == 0 && i < triangles * (part + 1) / parts; ++i)
      found[part] = areaVector(mesh, 3 * i) == glm::dvec3(0.0) ? 1 : 0;
  });
  if (mesh.indices.size() % 3 == 0 && std::ranges::find(found, 1) == found.end()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    if (areaVector(mesh, i) == glm::dvec3(0.0)) continue;
    for (std::size_t c = 0; c < 3; ++c) mesh.indices[kept + c] = mesh.indices[i + c];
    kept += 3;
  }
  mesh.indices.resize(kept);
}

void dropUnusedVertices(Mesh& mesh) {
  // Most meshes have none, and find out at the cost of a bit a vertex.
  std::vector<bool> used(mesh.vertexCount(), false);
  for (const std::uint32_t index : mesh.indices) used[index] = true;
  if (std::ranges::find(used, false) == used.end()) return;
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> newIndex(mesh.vertexCount(), unused);
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < newIndex.size(); ++i)
    if (used[i]) newIndex[i] = kept++;
  forEachAttribute(mesh, [&](auto& values) {
    for (std::size_t i = 0; i < newIndex.size(); ++i)
      if (newIndex[i] != unused) values[newIndex[i]] = values[i];
    values.resize(kept);
  });
  for (std::uint32_t& index : mesh.indices) index = newIndex[index];
}

void separateTriangles(Mesh& mesh) {
  forEachAttribute(mesh, [&](auto& values) {
    std::decay_t<decltype(values)> separate(mesh.indices.size());
    for (std::size_t i = 0; i < separate.size(); ++i) separate[i] = values[mesh.indices[i]];
    values = std::move(separate);
  });
  std::iota(mesh.indices.begin(), mesh.indices.end(), 0U);
}

void makeFlatNormals(Mesh& mesh) {
  separateTriangles(mesh);
  std::vector<glm::vec3> normals(mesh.indices.size());
  for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = unit(areaVector(mesh, i / 3 * 3));
  setNormals(mesh, std::move(normals));
}

void makeSmoothNormals(Mesh& mesh) { setNormals(mesh, sumAreas(mesh)); }

void turnTrianglesToNormals(Mesh& mesh) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    glm::dvec3 normals(0.0);
    for (std::size_t c = 0; c < 3; ++c) normals += glm::dvec3(unpackDirection(mesh.normals[mesh.indices[i + c]]));
    if (glm::dot(areaVector(mesh, i), normals) < 0.0) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  }
}

void setRepairedNormals(Mesh& mesh, std::vector<glm::vec3> normals) {
  bool complete = true;
  for (glm::vec3& normal : normals) {
    normal = isFinite(normal) ? unit(glm::dvec3(normal)) : glm::vec3(0.0F);
    complete = complete && normal != glm::vec3(0.0F);
  }
  if (!complete) {
    const std::vector<glm::vec3> sums = sumAreas(mesh);
    for (std::size_t i = 0; i < normals.size(); ++i)
      if (normals[i] == glm::vec3(0.0F)) normals[i] = sums[i];
  }
  setNormals(mesh, std::move(normals));
}

void makeTangents(Mesh& mesh, const TextureSlot& slot) {
  // The first vertexCount() sums are those of triangles that are not mirrored, the others those of mirrored ones.
  const std::size_t count = mesh.vertexCount();
  std::vector<glm::dvec3> sums(2 * count, glm::dvec3(0.0));
  std::vector<std::uint32_t> mirroredCopy(count, 0); // 0: none
  std::vector<bool> hasPlain(count, false);
  std::vector<float> signs(mesh.indices.size() / 3);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const TriangleTangent tangent = triangleTangent(mesh, i, slot);
    signs[i / 3] = tangent.sign;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t index = mesh.indices[i + c];
      if (tangent.sign > 0.0F) hasPlain[index] = true;
      sums[index + (tangent.sign > 0.0F ? 0 : count)] += tangent.direction;
    }
  }
  const auto tangentOf = [&](const glm::dvec3& sum, std::size_t vertex, float sign) {
    return packTangent(glm::vec4(orthogonalTangent(sum, unpackDirection(mesh.normals[vertex])), sign));
  };
  mesh.tangents.resize(count);
  for (std::size_t i = 0; i < count; ++i) mesh.tangents[i] = tangentOf(sums[i], i, 1.0F);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    if (signs[i / 3] > 0.0F) continue;
    std::uint32_t& index = mesh.indices[i];
    const std::size_t original = index;
    if (mirroredCopy[original] == 0 && hasPlain[original]) {
      mirroredCopy[original] = static_cast<std::uint32_t>(mesh.vertexCount());
      forEachAttribute(mesh, [original](auto& values) { values.push_back(values[original]); });
    }
    if (mirroredCopy[original] != 0) index = mirroredCopy[original];
    mesh.tangents[index] = tangentOf(sums[original + count], index, -1.0F);
  }
}

void setRepairedTangents(Mesh& mesh, std::span<const glm::vec4> tangents) {
  mesh.tangents.resize(tangents.size());
  for (std::size_t i = 0; i < tangents.size(); ++i) {
    const glm::vec3 tangent(tangents[i]);
    const glm::dvec3 usable = isFinite(tangent) ? glm::dvec3(tangent) : glm::dvec3(0.0);
    const glm::vec3 direction = orthogonalTangent(usable, unpackDirection(mesh.normals[i]));
    mesh.tangents[i] = packTangent(glm::vec4(direction, tangents[i].w < 0.0F ? -1.0F : 1.0F));
  }
}

void requireReach(const glm::dvec3& place) {
  // The squares of lengths up to here are still well inside the range of a 32-bit float.
  constexpr double farthest = 1e15;
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(place[axis]) <= farthest))
      throw LoadError(fmt::format("the model reaches to {:.3g}, farther than {:.0e}", place[axis], farthest));
}

void requireDrawable(const Scene& scene) {
  std::vector<Bounds> boxes(scene.meshes.size());
  for (std::size_t i = 0; i < scene.meshes.size(); ++i)
    if (!scene.meshes[i].indices.empty()) boxes[i] = boundsOf(scene.meshes[i]);
  bool anything = false;
  for (const Draw& draw : scene.draws) {
    anything = anything || !scene.meshes[draw.mesh].indices.empty();
    const Bounds& box = boxes[draw.mesh];
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec4 local((corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                             (corner & 4) != 0 ? box.max.z : box.min.z, 1.0);
      requireReach(glm::dvec3(glm::dmat4(draw.transform) * local));
    }
  }
  if (!anything) throw LoadError("the file holds no triangles, lines or points");
}

} // namespace vitrail::tool
