// The plane that cuts a model, in the picture: its outline in the model's box, and a handle that is dragged.
#pragma once

#include <optional>

#include <glm/glm.hpp>

#include "../commands/render_options.h"
#include "../scene/camera.h"
#include "drawer.h"

struct ImDrawList;

namespace vitrail::tool {

class CutHandle {
 public:
  // Draws it over the picture of `view`, which fills a display of that size, where one plane cuts; moves the plane
  // where the mouse, whose left button went down last at `pressed`, drags the handle. Whether it did.
  bool draw(ImDrawList& list, RenderArguments& arguments, const SceneFacts& scene, const View& view,
            const glm::vec2& display, const glm::vec2& pressed);

  // Whether the mouse has hold of it.
  [[nodiscard]] bool isDragged() const { return isDragged_; }
  void letGo() { isDragged_ = false; }
  // Where it was drawn last; nothing where it was not.
  [[nodiscard]] const std::optional<glm::vec2>& place() const { return place_; }

 private:
  bool isDragged_ = false;
  glm::vec2 grip_{0.0F}; // of the mouse, from the handle
  std::optional<glm::vec2> place_;
};

} // namespace vitrail::tool
