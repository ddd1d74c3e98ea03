// The node hierarchy of a glTF file: which nodes its scene draws, and where each is in the world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include <glm/glm.hpp>

#include "../scene.h"
#include "document.h"

namespace vitrail::tool {

struct GltfPlacedNode {
  std::uint32_t node = 0;
  glm::dmat4 world{1.0};
  std::uint32_t parent = GltfNodes::none; // the node that it is placed below
  bool visible = true;                    // false: KHR_node_visibility hides it, or one above it
};

// What is drawn is the default scene, scene 0 where none is named, every tree where there are no scenes.
//
// Files do not always hold the strict trees that the specification asks for. A node with several parents is drawn below
// each of them; what is listed twice in one place is drawn once. A root that a scene lists although another node has it
// as a child is drawn as a root, without that parent's transform, if the scene does not draw the parent, and below the
// parent if it does: what is drawn is what the scene lists, and each thing once.
class GltfHierarchy {
 public:
  // The document outlives it. Warns of what is not as it should be. Throws LoadError where a node is its own ancestor.
  GltfHierarchy(const GltfDocument& document, Scene& scene);

  // Calls `visit` for each node of the scene, parents before their children and children in the file's order. Throws
  // LoadError where a transform is none, or where nodes with several parents make too many copies.
  void visit(const std::function<void(const GltfPlacedNode&)>& visit) const;

  // The world transforms of some nodes, whether or not the scene draws them: joints of a skin may lie outside. A node
  // with several parents is where the first one puts it.
  [[nodiscard]] std::vector<glm::dmat4> worldOf(std::span<const int> nodes) const;

 private:
  void sortNodes();
  void chooseRoots(Scene& scene);
  void warnOfParents(Scene& scene) const;
  [[nodiscard]] std::vector<bool> belowListed(const std::vector<bool>& listed) const;
  glm::dmat4 placeOf(std::uint32_t node) const;

  const GltfDocument& document_;
  std::vector<std::uint32_t> roots_;
  std::vector<std::uint32_t> parents_; // the first of each; GltfNodes::none for roots
  std::vector<std::uint32_t> order_;   // all nodes, parents before children
  std::uint64_t shared_ = 0;           // how many nodes have more than one parent
  std::uint32_t firstShared_ = 0;      // and of the first of them, and two of its parents
  std::uint32_t sharing_[2] = {};
  mutable std::unordered_map<std::uint32_t, glm::dmat4> places_; // what worldOf() knows
};

// The matrix in single precision, relative to `origin`. Throws LoadError that names the node where that cannot hold it.
glm::mat4 nodeMatrix(const GltfDocument& document, std::uint32_t node, glm::dmat4 world, const glm::dvec3& origin);

} // namespace vitrail::tool
