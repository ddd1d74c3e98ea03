#include "volume.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace vitrail::tool {

namespace {

// Less than that of the light is not seen: colours of 0 would absorb infinitely.
constexpr double kLeastLeft = 0x1p-24;

// Steele, Lea, Flood, "Fast splittable pseudorandom number generators" (2014): the finalizer of SplitMix64.
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

// The cells of a grid over a mesh, by which places that differ by rounding are one: the seams of spheres, for one,
// seldom meet to the last bit.
struct Grid {
  glm::dvec3 low{0.0};
  double perCell = 0.0; // one over a cell's side; 0: places are told apart by all their bits
  double offset = 0.0;

  // A place as a number that differs from other places' but by chance.
  std::uint64_t numberOf(const glm::vec3& place) const {
    std::uint64_t number = 0x9e3779b97f4a7c15U;
    for (int i = 0; i < 3; ++i) {
      const float coordinate = place[i] == 0.0F ? 0.0F : place[i]; // -0 is 0
      const double cell = std::floor((double{coordinate} - low[i]) * perCell + offset);
      number = mix(number + (perCell > 0.0 ? static_cast<std::uint64_t>(static_cast<std::int64_t>(cell))
                                           : std::uint64_t{std::bit_cast<std::uint32_t>(coordinate)}));
    }
    return number;
  }
};

// Adds up passages of edges: those from a to b and from b to a cancel, whatever their order. No table of edges is kept,
// which would be several times as large as the mesh. Two sums with different numbers, so that chance needs 128 bits.
class Passages {
 public:
  void add(std::uint64_t from, std::uint64_t to) {
    if (from == to) return;
    const std::uint64_t low = std::min(from, to);
    const std::uint64_t edge = mix(low * 3U + std::max(from, to));
    const std::uint64_t other = mix(edge + 0x9e3779b97f4a7c15U);
    first_ += from < to ? edge : 0U - edge;
    second_ += from < to ? other : 0U - other;
  }
  bool cancel() const { return first_ == 0 && second_ == 0; }

 private:
  std::uint64_t first_ = 0;
  std::uint64_t second_ = 0;
};

// Whether each edge is as often passed one way as the other.
bool isClosed(const Mesh& mesh, const Grid& grid) {
  Passages passages;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    std::uint64_t number[3];
    for (std::size_t k = 0; k < 3; ++k) number[k] = grid.numberOf(mesh.positions[mesh.indices[i + k]]);
    for (std::size_t k = 0; k < 3; ++k) passages.add(number[k], number[(k + 1) % 3]);
  }
  return passages.cancel();
}

// By all bits, or else in cells of a 4096th of the mesh. Places on both sides of a cell's edge are not one: several
// grids are tried, in one of which none is likely to lie there.
bool isClosed(const Mesh& mesh) {
  if (isClosed(mesh, {})) return true;
  const Bounds box = boundsOf(mesh);
  const glm::dvec3 size = glm::dvec3(box.max) - glm::dvec3(box.min);
  const double largest = std::max({size.x, size.y, size.z});
  if (!(largest > 0.0)) return false;
  const Grid grid{glm::dvec3(box.min), 4096.0 / largest, 0.0};
  for (const double offset : {0.5, 0.17, 0.83}) {
    Grid moved = grid;
    moved.offset = offset;
    if (isClosed(mesh, moved)) return true;
  }
  return false;
}

} // namespace

glm::vec3 absorption(const Material& material) {
  const bool passes = material.transmission > 0.0F && !material.unlit;
  if (!passes || !(material.thickness > 0.0F) || !(material.attenuationDistance > 0.0F)) return glm::vec3(0.0F);
  glm::vec3 result(0.0F);
  for (int i = 0; i < 3; ++i) {
    const double left = std::clamp(double{material.attenuationColor[i]}, kLeastLeft, 1.0);
    const double perLength = -std::log(left) / double{material.attenuationDistance};
    result[i] = static_cast<float>(std::min(perLength, double{std::numeric_limits<float>::max()} / 1024.0));
  }
  return result;
}

Facing facingOf(const Mesh& mesh) {
  if (mesh.primitive != Primitive::Triangles || mesh.indices.empty() || !isClosed(mesh)) return Facing::Open;
  double volume = 0.0; // six times what is enclosed
  const glm::dvec3 origin(mesh.positions[mesh.indices[0]]);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    glm::dvec3 corner[3];
    for (std::size_t k = 0; k < 3; ++k) corner[k] = glm::dvec3(mesh.positions[mesh.indices[i + k]]) - origin;
    volume += glm::dot(corner[0], glm::cross(corner[1], corner[2]));
  }
  if (volume == 0.0) return Facing::Open;
  return volume > 0.0 ? Facing::Outward : Facing::Inward;
}

Solids::Solids(const Scene& scene, bool cut)
    : absorbing_(scene.materials.size()), meshes_(scene.meshes.size(), Facing::Open), boxes_(scene.meshes.size()) {
  if (cut) return;
  std::vector<bool> known(scene.meshes.size());
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    absorbing_[i] = material.alphaMode != AlphaMode::Mask && absorption(material) != glm::vec3(0.0F);
  }
  for (const Draw& draw : scene.draws) {
    if (!absorbing_[draw.material]) continue;
    if (!known[draw.mesh]) meshes_[draw.mesh] = facingOf(scene.meshes[draw.mesh]);
    if (meshes_[draw.mesh] == Facing::Open && !open_) open_ = draw.material;
    if (known[draw.mesh]) continue;
    known[draw.mesh] = true;
    if (meshes_[draw.mesh] == Facing::Open) continue;
    boxes_[draw.mesh] = boundsOf(scene.meshes[draw.mesh]);
    any_ = true;
  }
}

} // namespace vitrail::tool
