// A view as the shaders take it.
#pragma once

#include "../scene/camera.h"
#include "surface_shared.h"

namespace vitrail::tool {

// `origin` is the point of the world that is the GPU's (0, 0, 0).
shaders::FrameData makeFrameData(const View& view, std::uint32_t width, std::uint32_t height, const glm::dvec3& origin);

} // namespace vitrail::tool
