#include "raster/clip.h"

#include <algorithm>
#include <cmath>

namespace vitrail::raster {

namespace {

constexpr std::size_t kMostCorners = kMostPieces + 2;

struct Polygon {
  std::array<ClipVertex, kMostCorners> corners{};
  std::size_t count = 0;

  void add(const ClipVertex& corner) {
    if (count < kMostCorners) corners[count++] = corner;
  }
};

// Bounds of x / w and y / w within which a corner lies in the guard band.
struct Band {
  float x;
  float y;
};

Band bandOf(const Viewport& viewport) {
  // A pixel less than the band, for what rounding adds.
  constexpr auto kPixels = static_cast<float>(kGuardBand - 1);
  return {2.0F * kPixels / static_cast<float>(viewport.width), 2.0F * kPixels / static_cast<float>(viewport.height)};
}

// How far inside the depth range, near and far.
float nearDistance(const Viewport& viewport, const std::array<float, 4>& p) {
  return viewport.depthFromMinusW ? p[3] + p[2] : p[2];
}
float farDistance(const std::array<float, 4>& p) { return p[3] - p[2]; }

// The corner between one that is inside a plane and one that is outside, at distances of opposite sign. Always from the
// inside: both triangles at an edge get the same one.
ClipVertex between(const ClipVertex& inside, float in, const ClipVertex& outside, float out) {
  const float t = in / (in - out);
  const auto mix = [t](float a, float b) { return a + t * (b - a); };
  ClipVertex made;
  for (std::size_t i = 0; i < 4; ++i) made.position[i] = mix(inside.position[i], outside.position[i]);
  for (std::size_t i = 0; i < made.distances.size(); ++i) {
    made.distances[i] = mix(inside.distances[i], outside.distances[i]);
  }
  made.second = mix(inside.second, outside.second);
  made.third = mix(inside.third, outside.third);
  return made;
}

template <class Distance>
void clip(Polygon& polygon, Distance distance) {
  Polygon left;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const ClipVertex& from = polygon.corners[i];
    const ClipVertex& to = polygon.corners[(i + 1) % polygon.count];
    const float a = distance(from);
    const float b = distance(to);
    const bool fromInside = a >= 0.0F; // not for a NaN
    const bool toInside = b >= 0.0F;
    if (fromInside) left.add(from);
    if (fromInside && !toInside) left.add(between(from, a, to, b));
    if (!fromInside && toInside) left.add(between(to, b, from, a));
  }
  polygon = left;
}

void clipAll(const Viewport& viewport, Polygon& polygon, std::uint32_t planes) {
  const Band band = bandOf(viewport);
  clip(polygon, [&](const ClipVertex& v) { return nearDistance(viewport, v.position); });
  clip(polygon, [&](const ClipVertex& v) { return farDistance(v.position); });
  clip(polygon, [&](const ClipVertex& v) { return band.x * v.position[3] - v.position[0]; });
  clip(polygon, [&](const ClipVertex& v) { return band.x * v.position[3] + v.position[0]; });
  clip(polygon, [&](const ClipVertex& v) { return band.y * v.position[3] - v.position[1]; });
  clip(polygon, [&](const ClipVertex& v) { return band.y * v.position[3] + v.position[1]; });
  for (std::uint32_t plane = 0; plane < planes; ++plane) {
    clip(polygon, [&](const ClipVertex& v) { return v.distances[plane]; });
  }
}

// Whether a corner can be divided by its w: one at w = 0 is left over where all of a triangle lies in the eye's plane.
// Nor one with coordinates that are not finite.
bool hasPlace(const ClipVertex& v) {
  const auto& p = v.position;
  return p[3] >= kLeastW && p[3] <= kMostW && std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

Pieces fanOf(const Viewport& viewport, const Polygon& polygon) {
  Pieces made;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    if (!hasPlace(polygon.corners[i])) return made;
  }
  for (std::size_t i = 2; i < polygon.count && made.count < kMostPieces; ++i) {
    Piece& piece = made.pieces[made.count++];
    const std::array<const ClipVertex*, 3> corners{&polygon.corners[0], &polygon.corners[i - 1], &polygon.corners[i]};
    for (std::size_t c = 0; c < 3; ++c) {
      piece.corners[c] = placed(viewport, corners[c]->position);
      piece.second[c] = corners[c]->second;
      piece.third[c] = corners[c]->third;
    }
  }
  return made;
}

// In pixels of the part that is drawn, not rounded.
struct Place {
  float x;
  float y;
  float depth;
  float inverseW;
};

Place placeOf(const Viewport& viewport, const std::array<float, 4>& p) {
  const float inverse = 1.0F / p[3];
  const float halfWidth = 0.5F * static_cast<float>(viewport.width);
  const float halfHeight = 0.5F * static_cast<float>(viewport.height);
  const float x = p[0] * inverse;
  const float y = viewport.yUp ? -(p[1] * inverse) : p[1] * inverse;
  const float z = p[2] * inverse;
  return {x * halfWidth + halfWidth, y * halfHeight + halfHeight, viewport.depthFromMinusW ? z * 0.5F + 0.5F : z,
          inverse};
}

Corner cornerOf(const Viewport& viewport, const Place& place) {
  return {snap(place.x) - viewport.originX * kSubpixels, snap(place.y) - viewport.originY * kSubpixels, place.depth,
          place.inverseW};
}

// A parallelogram a, b, c, d around it; `weights` are the second weights of the four.
Pieces quadOf(const Viewport& viewport, const std::array<Place, 4>& places, const std::array<float, 4>& weights) {
  constexpr std::array<std::array<std::size_t, 3>, 2> kTriangles{{{0, 1, 2}, {0, 2, 3}}};
  Pieces made;
  made.count = 2;
  for (std::size_t t = 0; t < 2; ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t corner = kTriangles[t][c];
      made.pieces[t].corners[c] = cornerOf(viewport, places[corner]);
      made.pieces[t].second[c] = weights[corner];
    }
  }
  return made;
}

} // namespace

Corner placed(const Viewport& viewport, const std::array<float, 4>& position) {
  return cornerOf(viewport, placeOf(viewport, position));
}

bool needsClipping(const Viewport& viewport, const std::array<float, 4>& position) {
  const Band band = bandOf(viewport);
  const float w = position[3];
  const bool inside = w >= kLeastW && w <= kMostW && nearDistance(viewport, position) >= 0.0F &&
                      farDistance(position) >= 0.0F && std::fabs(position[0]) <= band.x * w &&
                      std::fabs(position[1]) <= band.y * w;
  return !inside;
}

Pieces clipped(const Viewport& viewport, const std::array<ClipVertex, 3>& triangle, std::uint32_t planes) {
  Polygon polygon;
  for (const ClipVertex& corner : triangle) polygon.add(corner);
  clipAll(viewport, polygon, planes);
  return fanOf(viewport, polygon);
}

Pieces lineOf(const Viewport& viewport, const std::array<ClipVertex, 2>& line, std::uint32_t planes) {
  Polygon polygon; // of two corners: what a plane leaves of it is again two, or four of which two are the same
  polygon.add(line[0]);
  polygon.add(line[1]);
  clipAll(viewport, polygon, planes);
  if (polygon.count < 2) return {};
  // The ends of what is left: those with the smallest and the largest weight.
  const std::span<const ClipVertex> ends(polygon.corners.data(), polygon.count);
  const auto [first, last] =
      std::minmax_element(ends.begin(), ends.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (!hasPlace(*first) || !hasPlace(*last)) return {};
  const Place a = placeOf(viewport, first->position);
  const Place b = placeOf(viewport, last->position);
  const bool isSteep = std::fabs(b.y - a.y) > std::fabs(b.x - a.x);
  const float dx = isSteep ? 0.5F : 0.0F;
  const float dy = isSteep ? 0.0F : 0.5F;
  const auto moved = [](Place place, float x, float y) {
    return Place{place.x + x, place.y + y, place.depth, place.inverseW};
  };
  return quadOf(viewport, {moved(a, -dx, -dy), moved(b, -dx, -dy), moved(b, dx, dy), moved(a, dx, dy)},
                {first->second, last->second, last->second, first->second});
}

Pieces pointOf(const Viewport& viewport, const ClipVertex& point, std::uint32_t planes, float size) {
  if (needsClipping(viewport, point.position)) return {};
  for (std::uint32_t plane = 0; plane < planes; ++plane) {
    if (!(point.distances[plane] >= 0.0F)) return {};
  }
  const Place p = placeOf(viewport, point.position);
  const float half = 0.5F * size;
  const auto moved = [&](float x, float y) { return Place{p.x + x, p.y + y, p.depth, p.inverseW}; };
  return quadOf(viewport, {moved(-half, -half), moved(half, -half), moved(half, half), moved(-half, half)}, {});
}

} // namespace vitrail::raster
