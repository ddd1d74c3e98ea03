// The order in which transparent geometry is submitted. The picture must not depend on it; tests ask for several.
#pragma once

#include <cstdint>
#include <vector>

#include "../scene/scene.h"

namespace vitrail::tool {

// The order in which transparent draws, and the triangles inside each, are submitted.
enum class DrawOrder { Forward, Reversed, Shuffled };

// The numbers 0 to count - 1 in that order. Shuffled is the same on every machine, and differs between salts.
std::vector<std::uint32_t> submissionOrder(std::uint32_t count, DrawOrder order, std::uint64_t salt);

// A mesh's indices with the triangles (lines, points) in that order; each keeps its own vertex order.
std::vector<std::uint32_t> reorderPrimitives(const Mesh& mesh, DrawOrder order, std::uint64_t salt);

} // namespace vitrail::tool
