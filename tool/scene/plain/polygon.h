// Splits polygons into triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace vitrail::tool {

// Adds the triangles of a polygon to a triangle list, with the polygon's winding. `corners` are indices into
// `positions`. Convex polygons become fans; others are clipped ear by ear (Meisters, "Polygons have ears", 1975) in the
// plane that they lie in best. What is no simple polygon still becomes some triangles.
void addPolygon(std::span<const std::uint32_t> corners, std::span<const glm::vec3> positions,
                std::vector<std::uint32_t>& triangles);

} // namespace vitrail::tool
