// How bright a surface can be: what VitrailCpuDraw::brightest asks for.
#pragma once

#include <array>
#include <map>
#include <vector>

#include <glm/glm.hpp>

#include "shade.h"

namespace vitrail::tool {

// A light that comes from one direction for all of a picture, and how far from it the way to the eye is.
struct DistantLight {
  glm::vec3 strength{2.0F};
  double halfAngle = 0.0; // radians: no half vector is further than that from the way to the eye; at most pi / 2
};

// The lights of a view.
struct LightBounds {
  bool bounded = true; // false: point and spot lights, near which surfaces are as bright as may be
  std::vector<DistantLight> lights;
  // The largest highlights that have been worked out: many surfaces have the same. By the least and the largest
  // roughness and the light's halfAngle.
  std::map<std::array<double, 3>, double> highlights;
};

LightBounds lightBoundsOf(const ShadeFrame& frame);

// The largest of red, green and blue of what a surface shades in a view, before alpha, and at most LARGEST_HALF. An
// upper bound, not a guess. `largestVertex`: the largest vertex colour, per channel; 1 where there are none.
float brightestOf(const ShadeSurface& surface, const glm::vec4& largestVertex, LightBounds& lights);

// The largest alpha of what a surface shades.
float largestAlphaOf(const ShadeSurface& surface, const glm::vec4& largestVertex);

} // namespace vitrail::tool
