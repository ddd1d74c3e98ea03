// The views of a scene that turns before the camera.
#pragma once

#include <cstdint>
#include <vector>

#include "camera.h"

namespace vitrail::tool {

// `count` views around the vertical axis through the middle of the scene, which has at least one draw, in equal steps
// to the right: the first is at the orbit's azimuth. All are from one distance, from which the whole scene is in each
// of the pictures: it neither grows nor sways.
std::vector<View> turntable(const Scene& scene, const Orbit& orbit, float aspect, std::uint32_t count);

// The same around the point that a camera looks at.
std::vector<View> turntable(const Scene& scene, const LookAt& look, std::uint32_t count);

} // namespace vitrail::tool
