// How much light a transparent surface of a scene can send to the eye: what may be left out of a pixel follows from it.
#pragma once

#include "../../scene/scene.h"
#include "../../stage/scene_draws.h"

namespace vitrail::tool {

// An upper bound of every channel of what docs/shading.md calls the colour of a surface, over all transparent draws; at
// most the largest 16-bit float, to which colours are clamped.
float mostLight(const Scene& scene, const SceneDraws& draws);

} // namespace vitrail::tool
