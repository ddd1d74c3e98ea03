#include "draw_groups.h"

#include <tuple>
#include <unordered_map>
#include <utility>

namespace vitrail::tool {

namespace {

template <typename Value>
void reorder(std::vector<Value>& values, DrawOrder order, std::uint64_t salt) {
  std::vector<Value> ordered;
  ordered.reserve(values.size());
  for (const std::uint32_t i : submissionOrder(static_cast<std::uint32_t>(values.size()), order, salt)) {
    ordered.push_back(std::move(values[i]));
  }
  values = std::move(ordered);
}

} // namespace

bool isMirrored(const glm::mat4& transform) { return glm::determinant(glm::dmat3(glm::dmat4(transform))) < 0.0; }

std::vector<DrawGroup> groupDraws(const Scene& scene, bool transparent, bool allTransparent) {
  std::vector<DrawGroup> groups;
  std::unordered_map<std::uint64_t, std::uint32_t> plain; // by mesh and material: the group's number
  std::unordered_map<std::uint64_t, std::uint32_t> mirrored;
  for (std::uint32_t i = 0; i < scene.draws.size(); ++i) {
    const Draw& draw = scene.draws[i];
    if (scene.meshes[draw.mesh].indices.empty()) continue;
    if ((allTransparent || isTransparent(scene.materials[draw.material])) != transparent) continue;
    const bool mirror = isMirrored(draw.transform);
    const std::uint64_t key = std::uint64_t{draw.mesh} << 32U | draw.material;
    const auto [place, isNew] = (mirror ? mirrored : plain).try_emplace(key, static_cast<std::uint32_t>(groups.size()));
    if (isNew) groups.push_back({draw.mesh, draw.material, mirror, {}});
    groups[place->second].draws.push_back(i);
  }
  return groups;
}

void reorderGroups(std::vector<DrawGroup>& groups, DrawOrder order) {
  if (order == DrawOrder::Forward) return;
  reorder(groups, order, 0);
  for (DrawGroup& group : groups) reorder(group.draws, order, group.draws.size());
}

} // namespace vitrail::tool
