// Where a scene's own origin lies, for formats whose coordinates are read in double precision.
#pragma once

#include <glm/glm.hpp>

namespace vitrail::tool {

// The point that a model whose coordinates reach from `min` to `max` is made relative to, before they become 32-bit
// floats: its middle where it lies far from the file's origin for its size, as models in map coordinates do; otherwise
// (0, 0, 0), so that the numbers of other files stay as they are.
glm::dvec3 originOf(const glm::dvec3& min, const glm::dvec3& max);

} // namespace vitrail::tool
