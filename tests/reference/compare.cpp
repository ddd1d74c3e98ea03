// Differences are taken channel by channel on the 8-bit picture, alpha included.
#include "compare.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace vitrail::tool::reference {

Comparison compare(const Picture& rendered, const ReferencePicture& expected, const Reference& reference, int bound) {
  const Picture& picture = expected.picture;
  if (rendered.width != picture.width || rendered.height != picture.height || rendered.hasAlpha != picture.hasAlpha ||
      rendered.rgba.size() != picture.rgba.size()) {
    throw std::invalid_argument("the pictures are not of one kind");
  }
  Comparison result;
  std::size_t edges = 0;
  std::size_t edgesOver = 0;
  for (std::size_t i = 0; i < reference.edge.size(); ++i) {
    int difference = 0;
    for (std::size_t c = i * 4; c < i * 4 + 4; ++c) {
      difference = std::max(difference, std::abs(int{rendered.rgba[c]} - int{picture.rgba[c]}));
    }
    if (reference.edge[i] != 0) {
      ++edges;
      if (difference > bound) ++edgesOver;
      continue;
    }
    if (difference > bound) ++result.beyond;
    if (difference > result.away) {
      result.away = difference;
      result.awayX = static_cast<std::uint32_t>(i % picture.width);
      result.awayY = static_cast<std::uint32_t>(i / picture.width);
    }
  }
  const auto pixels = static_cast<double>(std::max<std::size_t>(1, reference.edge.size()));
  result.edgeShare = static_cast<double>(edges) / pixels;
  result.edgeOver = static_cast<double>(edgesOver) / pixels;
  return result;
}

std::ostream& operator<<(std::ostream& out, const Comparison& comparison) {
  return out << "away from edges at most " << comparison.away << "/255 (pixel " << comparison.awayX << ", "
             << comparison.awayY << "), " << comparison.beyond << " such pixels beyond the bound; edge pixels "
             << 100.0 * comparison.edgeShare << " %, beyond the bound " << 100.0 * comparison.edgeOver << " %";
}

LayerBounds layerBounds(const Reference& reference) {
  LayerBounds bounds;
  for (const LayerRange& range : reference.layerRanges) {
    bounds.fragmentsLeast += range.least;
    bounds.fragmentsMost += range.most;
    bounds.deepestLeast = std::max(bounds.deepestLeast, range.least);
    bounds.deepestMost = std::max(bounds.deepestMost, range.most);
  }
  return bounds;
}

} // namespace vitrail::tool::reference
