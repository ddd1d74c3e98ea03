// Edges are counted in a table, and the absorption between two surfaces is that in the middle between them.
#include "media.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace vitrail::tool::reference {

namespace {

using Place = std::array<float, 3>;

Place placeOf(const Mesh& mesh, std::size_t index) {
  const glm::vec3& p = mesh.positions[mesh.indices[index]];
  return {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F};
}

// 0 where an edge has not as many triangles on its one side as on the other.
int turnOf(const Mesh& mesh) {
  std::map<std::pair<Place, Place>, int> passages;
  double volume = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    std::array<glm::dvec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const Place a = placeOf(mesh, i + k);
      const Place b = placeOf(mesh, i + (k + 1) % 3);
      ++passages[{a, b}];
      --passages[{b, a}];
      p[k] = glm::dvec3(mesh.positions[mesh.indices[i + k]]);
    }
    volume += glm::determinant(glm::dmat3(p[0], p[1], p[2]));
  }
  const bool closed = std::all_of(passages.begin(), passages.end(), [](const auto& edge) { return edge.second == 0; });
  if (!closed || volume == 0.0) return 0;
  return volume > 0.0 ? 1 : -1;
}

} // namespace

glm::dvec3 absorptionOf(const Material& material) {
  if (material.unlit || material.transmission <= 0.0F || material.thickness <= 0.0F ||
      material.attenuationDistance <= 0.0F) {
    return glm::dvec3(0.0);
  }
  const glm::dvec3 color = glm::clamp(glm::dvec3(material.attenuationColor), std::exp2(-24.0), 1.0);
  return -glm::log(color) / double{material.attenuationDistance};
}

SolidDraws::SolidDraws(const Scene& scene, double opacity) {
  for (const Draw& draw : scene.draws) {
    const Material& material = scene.materials[draw.material];
    absorption_.push_back(opacity * absorptionOf(material));
    const bool may = absorptionOf(material) != glm::dvec3(0.0) && material.alphaMode != AlphaMode::Mask;
    turns_.push_back(may ? turnOf(scene.meshes[draw.mesh]) : 0);
  }
}

// The absorption at a distance: each exit beyond it says that it is inside, each entry that it was not before that.
glm::dvec3 SolidDraws::at(std::span<const Crossing> crossings, double distance) const {
  glm::dvec3 sum(0.0);
  for (const Crossing& crossing : crossings) {
    if (crossing.at <= distance) continue;
    sum += (crossing.entering ? -1.0 : 1.0) * absorption_[crossing.draw];
  }
  return glm::max(sum, 0.0);
}

glm::dvec3 SolidDraws::left(std::span<const Crossing> crossings, double start, double end) const {
  std::vector<double> cuts{start, end};
  for (const Crossing& crossing : crossings) {
    if (crossing.at > start && crossing.at < end) cuts.push_back(crossing.at);
  }
  std::sort(cuts.begin(), cuts.end());
  glm::dvec3 depth(0.0);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    depth += (cuts[i + 1] - cuts[i]) * at(crossings, 0.5 * (cuts[i] + cuts[i + 1]));
  }
  return glm::exp(-depth);
}

} // namespace vitrail::tool::reference
