// How near and how far the transparent surfaces of a view are: what methods fit their functions of depth to.
#pragma once

#include "../../stage/surfaces.h"

namespace vitrail::tool {

// Distances from the camera's plane. With perspective both are positive.
struct DepthRange {
  float nearest = 1.0F;
  float farthest = 2.0F;
};

// Of the boxes around the surfaces, so the range may be wider than theirs, but is not narrower.
DepthRange transparentDepths(const Surfaces& surfaces);

} // namespace vitrail::tool
