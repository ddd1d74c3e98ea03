// Which draws of a scene are instances of one draw on the GPU.
#pragma once

#include <cstdint>
#include <vector>

#include "../scene/scene.h"
#include "draw_order.h"

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

// Whether the transform turns counter-clockwise into clockwise.
bool isMirrored(const glm::mat4& transform);

} // namespace vitrail::tool
