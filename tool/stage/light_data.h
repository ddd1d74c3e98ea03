// A scene's own lights as the shaders take them.
#pragma once

#include <vector>

#include "../scene/scene.h"
#include "surface_shared.h"

namespace vitrail::tool {

// `origin` is the point of the world that is the GPU's (0, 0, 0).
std::vector<shaders::LightData> makeLightData(const Scene& scene, const glm::dvec3& origin);

} // namespace vitrail::tool
