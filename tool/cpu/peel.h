// Sorted layers of a pixel without the nearest of them, for the list hook of vitrail/cpu.h.
#pragma once

#include <cstdint>
#include <span>

#include <vitrail/cpu.h>

namespace vitrail::tool {

// Whether a layer is the second half of a fragment with a filter, which the one before it begins.
bool isFilterOf(const VitrailLayer& layer, const VitrailLayer& before);

// Blends all but the `peeled` nearest fragments of each sample over `color`, 4 floats (linear, premultiplied) times
// `samples`: what it holds is behind all layers. Layers are nearest first, as VitrailCpuList has them.
void blendPeeled(std::span<const VitrailLayer> layers, std::uint32_t peeled, std::uint32_t samples, float* color);

} // namespace vitrail::tool
