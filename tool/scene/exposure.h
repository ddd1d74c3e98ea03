// How bright a scene's own lights are drawn: files state them in anything between the 1 of a hobbyist's lamp and the
// 54351 candela that Blender makes of its default one.
#pragma once

#include "scene.h"

namespace vitrail::tool {

// What the intensities of all lights of a scene are multiplied by, as docs/shading.md states under "Exposure": half of
// the light that falls on the scene's surfaces falls where the lights together are no brighter than the tool's own
// light. 1 where the lights reach no surface.
double lightExposure(const Scene& scene);

} // namespace vitrail::tool
