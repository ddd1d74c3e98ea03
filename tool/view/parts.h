// The objects of a scene in a panel: which are drawn, and choosing them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drawer.h"

namespace vitrail::tool {

class Parts {
 public:
  // Of another scene, or of another choice.
  void set(const std::shared_ptr<const SceneFacts>& scene, const ObjectChoice& choice);

  // Draws the tree, and changes the choice where the user does. Whether that was so.
  bool draw(ObjectChoice& choice);

  // Draws the object, or leaves it out, with all below it.
  void show(ObjectChoice& choice, std::uint32_t object, bool shown) const;

 private:
  void fade(ObjectChoice& choice, std::uint32_t object, float opacity) const;
  bool drawObject(ObjectChoice& choice, std::uint32_t object);
  bool drawAll(ObjectChoice& choice, std::uint32_t first);

  std::shared_ptr<const SceneFacts> scene_;
  ObjectChoice choice_;
  std::vector<bool> shown_;
  std::vector<float> opacities_;
  // The tree from above; ObjectTree::none ends a list.
  std::uint32_t firstRoot_ = ObjectTree::none;
  std::vector<std::uint32_t> firstChild_;
  std::vector<std::uint32_t> nextSibling_;
};

} // namespace vitrail::tool
