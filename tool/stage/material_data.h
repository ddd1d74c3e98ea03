// A material as the shaders take it.
#pragma once

#include <cstdint>
#include <optional>

#include "../scene/scene.h"
#include "surface_shared.h"

namespace vitrail::tool {

// With `opacity`, every material is blended with that factor.
shaders::MaterialData makeMaterialData(const Material& material, std::optional<float> opacity);

// What the pipeline of a mesh with a material is specialized for (surface_shared.h).
std::uint32_t featuresOf(const Scene& scene, const Material& material, const Mesh& mesh);

} // namespace vitrail::tool
