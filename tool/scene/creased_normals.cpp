// Normals of surfaces that are smooth but for their edges.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "mesh_build.h"
#include "threads.h"
#include "weld.h"

namespace vitrail::tool {
namespace {

// A triangle's plane.
struct Facing {
  glm::vec3 normal{0.0F};
  float area = 0.0F; // in the square of the model's size, so that those of small models do not vanish
};

// The place of each vertex, numbered in the order of their first vertices.
struct Places {
  std::vector<std::uint32_t> ofVertex; // empty: each has its own
  std::size_t count = 0;

  std::uint32_t of(std::uint32_t vertex) const { return ofVertex.empty() ? vertex : ofVertex[vertex]; }
};

Places findPlaces(const Mesh& mesh) {
  Places places;
  Welder welder(mesh.vertexCount());
  places.ofVertex.reserve(mesh.vertexCount());
  for (const glm::vec3& position : mesh.positions) places.ofVertex.push_back(welder.add(position));
  places.count = welder.size();
  return places;
}

// The corners at each place: those of place i are corners[begins[i]] to corners[begins[i + 1]], in their order.
struct CornersAtPlaces {
  std::vector<std::uint32_t> begins;
  std::vector<std::uint32_t> corners;
};

CornersAtPlaces sortCorners(const Mesh& mesh, const Places& places) {
  CornersAtPlaces sorted;
  sorted.begins.assign(places.count + 1, 0);
  for (const std::uint32_t index : mesh.indices) ++sorted.begins[places.of(index)];
  // Each place's end, which moves down to its begin as it is filled from behind.
  std::partial_sum(sorted.begins.begin(), sorted.begins.end(), sorted.begins.begin());
  sorted.corners.resize(mesh.indices.size());
  for (std::size_t corner = mesh.indices.size(); corner-- > 0;)
    sorted.corners[--sorted.begins[places.of(mesh.indices[corner])]] = static_cast<std::uint32_t>(corner);
  return sorted;
}

std::vector<Facing> facingsOf(const Mesh& mesh, std::size_t parts) {
  glm::vec3 low = mesh.positions[0];
  glm::vec3 high = low;
  for (const glm::vec3& position : mesh.positions) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low);
  const double scale = 1.0 / std::max({size.x, size.y, size.z, std::numeric_limits<double>::min()});
  std::vector<Facing> facings(mesh.indices.size() / 3);
  inParts(parts, [&](std::size_t part) {
    for (std::size_t i = facings.size() * part / parts; i < facings.size() * (part + 1) / parts; ++i) {
      const glm::dvec3 a(mesh.positions[mesh.indices[3 * i]]);
      const glm::dvec3 b(mesh.positions[mesh.indices[3 * i + 1]]);
      const glm::dvec3 c(mesh.positions[mesh.indices[3 * i + 2]]);
      const glm::dvec3 area = glm::cross((b - a) * scale, (c - a) * scale);
      const double length = std::sqrt(glm::dot(area, area));
      if (length > 0.0) facings[i] = {glm::vec3(area / length), static_cast<float>(length)};
    }
  });
  return facings;
}

// What a part of the places becomes: its vertices are numbered from 0.
struct NewVertices {
  std::vector<std::uint32_t> originals;
  std::vector<std::uint32_t> normals; // packed
};

// Which of the corners at a place are inclined to one of them by less than the crease.
constexpr std::size_t mostCorners = 256;
using Neighbours = std::array<std::uint64_t, mostCorners / 64>;

class CornerNormals {
 public:
  CornerNormals(const Mesh& mesh, std::span<const Facing> facings, float crease)
      : mesh_(mesh), facings_(facings), cosine_(std::cos(crease)) {}

  // Adds the vertices of the corners at one place, and numbers the corners by them.
  void add(std::span<const std::uint32_t> corners, NewVertices& made, std::vector<std::uint32_t>& indices) {
    const std::size_t first = made.originals.size();
    // All pairs are compared; where thousands of triangles meet, each keeps the normal of its plane.
    const bool compared = corners.size() <= mostCorners;
    own_.clear();
    for (const std::uint32_t corner : corners) own_.push_back(facings_[corner / 3]);
    compareAll(compared);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t original = mesh_.indices[corners[i]];
      const std::uint32_t normal = normals_[i];
      std::size_t found = compared ? first : made.originals.size();
      while (found < made.originals.size() && (made.originals[found] != original || made.normals[found] != normal))
        ++found;
      if (found == made.originals.size()) {
        made.originals.push_back(original);
        made.normals.push_back(normal);
      }
      indices[corners[i]] = static_cast<std::uint32_t>(found);
    }
  }

 private:
  static glm::vec3 usable(const glm::vec3& normal) {
    return normal == glm::vec3(0.0F) ? glm::vec3(0.0F, 0.0F, 1.0F) : normal;
  }

  // The normal of each corner at the place.
  void compareAll(bool compared) {
    normals_.clear();
    near_.clear();
    for (std::size_t i = 0; i < own_.size(); ++i) {
      if (!compared) {
        normals_.push_back(packDirection(usable(own_[i].normal)));
        continue;
      }
      Neighbours near{};
      for (std::size_t j = 0; j < own_.size(); ++j)
        near[j / 64] |= std::uint64_t{glm::dot(own_[i].normal, own_[j].normal) > cosine_} << (j % 64);
      // Corners with the same neighbours have the same mean: on a smooth surface that is all of them.
      const auto same = std::ranges::find_if(near_, [&](const Neighbours& other) {
        std::uint64_t differ = 0; // a few words: not worth a call to compare memory
        for (std::size_t word = 0; word < near.size(); ++word) differ |= near[word] ^ other[word];
        return differ == 0;
      });
      normals_.push_back(same != near_.end() ? normals_[static_cast<std::size_t>(same - near_.begin())]
                                             : packDirection(meanOf(near, own_[i])));
      near_.push_back(near);
    }
  }

  glm::vec3 meanOf(const Neighbours& near, const Facing& facing) const {
    glm::dvec3 sum(0.0);
    for (std::size_t j = 0; j < own_.size(); ++j)
      if ((near[j / 64] >> (j % 64) & 1U) != 0) sum += glm::dvec3(own_[j].normal) * static_cast<double>(own_[j].area);
    const double length = glm::length(sum);
    return usable(length > 0.0 ? glm::vec3(sum / length) : facing.normal);
  }

  const Mesh& mesh_;
  std::span<const Facing> facings_;
  float cosine_;
  // Of the corners at the place:
  std::vector<Facing> own_;
  std::vector<Neighbours> near_;
  std::vector<std::uint32_t> normals_; // packed
};

} // namespace

void makeCreasedNormals(Mesh& mesh, float crease, bool ownPlaces) {
  if (mesh.indices.empty()) return;
  constexpr std::size_t leastIndices = 30'000;
  const std::size_t parts = partsFor(mesh.indices.size(), leastIndices);
  const Places places = ownPlaces ? Places{{}, mesh.vertexCount()} : findPlaces(mesh);
  const CornersAtPlaces sorted = sortCorners(mesh, places);
  const std::vector<Facing> facings = facingsOf(mesh, parts);

  const auto firstPlace = [&](std::size_t part) { return places.count * part / parts; };
  const auto cornersAt = [&](std::size_t place) {
    return std::span(sorted.corners).subspan(sorted.begins[place], sorted.begins[place + 1] - sorted.begins[place]);
  };
  std::vector<NewVertices> made(parts);
  std::vector<std::uint32_t> indices(mesh.indices.size());
  inParts(parts, [&](std::size_t part) {
    CornerNormals normals(mesh, facings, crease);
    for (std::size_t place = firstPlace(part); place < firstPlace(part + 1); ++place)
      normals.add(cornersAt(place), made[part], indices);
  });

  // The parts one behind the other: the result does not depend on how many there are.
  std::vector<std::size_t> offsets(parts, 0);
  for (std::size_t part = 1; part < parts; ++part) offsets[part] = offsets[part - 1] + made[part - 1].originals.size();
  inParts(parts, [&](std::size_t part) {
    for (std::size_t place = firstPlace(part); part > 0 && place < firstPlace(part + 1); ++place)
      for (const std::uint32_t corner : cornersAt(place)) indices[corner] += static_cast<std::uint32_t>(offsets[part]);
  });
  for (std::size_t part = 1; part < parts; ++part) {
    made[0].originals.insert(made[0].originals.end(), made[part].originals.begin(), made[part].originals.end());
    made[0].normals.insert(made[0].normals.end(), made[part].normals.begin(), made[part].normals.end());
  }
  mesh.normals.clear();
  forEachAttribute(mesh, [&](auto& values) {
    std::decay_t<decltype(values)> split;
    split.reserve(made[0].originals.size());
    for (const std::uint32_t original : made[0].originals) split.push_back(values[original]);
    values = std::move(split);
  });
  mesh.indices = std::move(indices);
  mesh.normals = std::move(made[0].normals);
}

} // namespace vitrail::tool
