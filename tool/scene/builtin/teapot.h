// The Utah teapot: Martin Newell's 32 bicubic Bezier patches (University of Utah, 1975).
#pragma once

#include <cstdint>

#include "../scene.h"

namespace vitrail::tool {

// The teapot in Newell's own size: it stands on the XZ plane around the Y axis, 3.15 high and 6.525 long, with the
// spout towards +X. Each patch becomes steps * steps quads; steps is at least 2. Body and lid, handle and spout pass
// through each other or stand a little apart, as in the original: draw it double-sided.
Mesh teapot(std::uint32_t steps);

} // namespace vitrail::tool
