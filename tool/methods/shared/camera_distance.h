// How far a point is from the camera: what methods sort by.
#pragma once

#include "../../stage/surface_shared.h"

namespace vitrail::tool {

// The distance of a point, in the GPU's space, from the eye; without perspective, from the camera's plane.
inline double distanceFromCamera(const shaders::FrameData& view, const glm::dvec3& point) {
  const glm::dvec3 offset = point - glm::dvec3(view.eye);
  const bool orthographic = view.eye.w > 0.5F;
  return orthographic ? -glm::dot(offset, glm::dvec3(view.cameraToWorld[2])) : glm::length(offset);
}

} // namespace vitrail::tool
