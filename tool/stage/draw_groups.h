// Which draws of a scene are instances of one draw on the GPU.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "../scene/scene.h"
#include "draw_order.h"
#include "surface_shared.h"

namespace vitrail::tool {

// Draws that show one mesh with one material, all mirrored by their transforms or none.
struct DrawGroup {
  std::uint32_t mesh = 0;
  std::uint32_t material = 0;
  bool mirrored = false;
  std::vector<std::uint32_t> draws; // indices into Scene::draws
};

// The groups of those draws that are `transparent` or are not; `allTransparent`: all are. They come in the order of
// their first draws, and the draws of each in the scene's order. Draws of empty meshes are left out.
std::vector<DrawGroup> groupDraws(const Scene& scene, bool transparent, bool allTransparent);

// Puts groups, and the draws of each, into the order in which they are submitted.
void reorderGroups(std::vector<DrawGroup>& groups, DrawOrder order);

// Puts opaque draws into the order in which they are drawn. `keyOf` gives a pair of a draw's features
// (surface_shared.h) and of something that stands for its material: draws of one key bind the same things, and go
// together. Depth decides between opaque surfaces, and of those in one plane the last one is seen. So masked ones,
// which may be decals, come after the others, and groups in the order of the file.
template <typename AnyDraw, typename KeyOf>
void orderOpaque(std::vector<AnyDraw>& draws, KeyOf keyOf) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> first; // draw of each key
  for (std::size_t i = 0; i < draws.size(); ++i) first.try_emplace(keyOf(draws[i]), i);
  const auto placeOf = [&](const AnyDraw& draw) {
    const std::pair<std::uint32_t, std::uint32_t> key = keyOf(draw);
    return std::pair((key.first & shaders::FEATURE_MASK) != 0, first.at(key));
  };
  std::stable_sort(draws.begin(), draws.end(),
                   [&](const AnyDraw& a, const AnyDraw& b) { return placeOf(a) < placeOf(b); });
}

// Whether the transform turns counter-clockwise into clockwise.
bool isMirrored(const glm::mat4& transform);

} // namespace vitrail::tool
