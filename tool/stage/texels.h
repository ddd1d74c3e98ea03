// How the images of a scene are kept for the texture slots that sample them: no graphics API.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "../scene/scene.h"

namespace vitrail::tool {

// An image's texels: its numbers; on the sRGB curve, colours; those in linear light times alpha.
enum class Texels { Linear, Srgb, Premultiplied };

bool isFilled(const Scene& scene, const TextureSlot& slot);

// One bit a slot, as in surface_shared.h: which slots a material fills.
std::uint32_t filledSlots(const Scene& scene, const Material& material);

// Whether some alpha of an image is not 1.
bool isTranslucent(const Image& image);

// How a slot of a material keeps its image. `premultiplied`: the material's base colour texture is: its alpha counts
// and is not 1 everywhere.
Texels texelsOf(const Material& material, std::uint32_t slot, bool premultiplied);

// The materials that a scene's draws have, in rising order.
std::vector<std::uint32_t> usedMaterials(const Scene& scene);

// Those of some materials, each named once, whose base colour texture is kept premultiplied: where its alpha counts and
// is not 1 everywhere.
std::set<std::uint32_t> premultipliedMaterials(const Scene& scene, const std::vector<std::uint32_t>& materials);

// Texels in linear light, times alpha, as 16-bit floats: 8 bits on the sRGB curve would leave little of the colours at
// low alpha.
std::vector<std::uint16_t> premultiply(const Image& image);

} // namespace vitrail::tool
