// Where a model lies in its file's own coordinates.
#pragma once

#include <limits>

#include <glm/glm.hpp>

#include "origin.h"

namespace vitrail::tool {

struct FileBounds {
  glm::dvec3 min{std::numeric_limits<double>::infinity()};
  glm::dvec3 max{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec3& place) {
    min = glm::min(min, place);
    max = glm::max(max, place);
  }

  // The Scene::origin of such a model.
  glm::dvec3 origin() const { return originOf(min, max); }
};

} // namespace vitrail::tool
