// A material as the shaders take it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "../scene/scene.h"
#include "surface_shared.h"

namespace vitrail::tool {

// With `opacity`, every material is blended with that factor.
shaders::MaterialData makeMaterialData(const Material& material, std::optional<float> opacity);

// A material's slots in the order of surface_shared.h.
std::array<const TextureSlot*, shaders::SLOT_COUNT> slotsOf(const Material& material);

// What the pipeline of a mesh with a material is specialized for (surface_shared.h). `premultiplied`: the material's
// base colour texture is.
std::uint32_t featuresOf(const Scene& scene, const Material& material, const Mesh& mesh, bool premultiplied);

} // namespace vitrail::tool
