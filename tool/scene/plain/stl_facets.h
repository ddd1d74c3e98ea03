// The facets of an STL file, with equal corners made one vertex as they come.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "../weld.h"
#include "file_bounds.h"

namespace vitrail::tool {

struct StlFacets {
  Welder vertices; // their tags are the facets' colours
  std::vector<std::uint32_t> indices;
  FileBounds bounds;         // in the file's coordinates
  std::size_t notFinite = 0; // facets left out, since a corner is not finite
  bool cutOff = false;       // the text ends inside a facet, which is left out

  // Corners in the file's coordinates.
  void add(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& origin, std::uint32_t color);
  // Adds another part of the same file behind this one.
  void append(StlFacets part);
};

// Reads a text file whose facets are written between `facet` and `endfacet`, in upper or lower case. Throws LoadError.
StlFacets readStlText(std::string_view text, const glm::dvec3& origin);

} // namespace vitrail::tool
