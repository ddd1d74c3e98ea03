// Scenes of more triangles that show the same: what costs by the triangle alone is measured with them.
#pragma once

#include <cstdint>

#include "scene.h"

namespace vitrail::tool {

// Splits every triangle into four of its shape at the middles of its edges, `times` times over. Shared edges stay
// shared. Surfaces stay where they are; what vertices carry is interpolated.
Scene splitTriangles(Scene scene, std::uint32_t times);

} // namespace vitrail::tool
