#include "raster/clip.h"

#include <algorithm>
#include <cmath>

namespace vitrail::raster {

namespace {

constexpr std::size_t kMostCorners = kMostPieces + 2;

// As ClipVertex, in doubles: where an edge comes from far away, a corner that is made on it is rounded by as much of
// that distance as a number has bits, and floats have not enough of them.
struct Vertex {
  std::array<double, 4> position{};
  std::array<double, 8> distances{};
  double second = 0.0;
  double third = 0.0;

  Vertex() = default;
  explicit Vertex(const ClipVertex& v) : second(double{v.second}), third(double{v.third}) {
    for (std::size_t i = 0; i < position.size(); ++i) position[i] = double{v.position[i]};
    for (std::size_t i = 0; i < distances.size(); ++i) distances[i] = double{v.distances[i]};
  }
  std::array<float, 4> rounded() const {
    return {static_cast<float>(position[0]), static_cast<float>(position[1]), static_cast<float>(position[2]),
            static_cast<float>(position[3])};
  }
};

struct Polygon {
  std::array<Vertex, kMostCorners> corners;
  std::size_t count = 0;

  void add(const Vertex& corner) {
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
template <class Real>
Real nearDistance(const Viewport& viewport, const std::array<Real, 4>& p) {
  return viewport.depthFromMinusW ? p[3] + p[2] : p[2];
}
template <class Real>
Real farDistance(const std::array<Real, 4>& p) {
  return p[3] - p[2];
}

// The corner between one that is inside a plane and one that is outside, at distances of opposite sign. Always from the
// inside: both triangles at an edge get the same one.
Vertex between(const Vertex& inside, double in, const Vertex& outside, double out, std::uint32_t planes) {
  const double t = in / (in - out);
  const auto mix = [t](double a, double b) { return a + t * (b - a); };
  Vertex made;
  for (std::size_t i = 0; i < 4; ++i) made.position[i] = mix(inside.position[i], outside.position[i]);
  for (std::size_t i = 0; i < planes; ++i) made.distances[i] = mix(inside.distances[i], outside.distances[i]);
  made.second = mix(inside.second, outside.second);
  made.third = mix(inside.third, outside.third);
  return made;
}

template <class Distance>
void clip(Polygon& polygon, std::uint32_t planes, Distance distance) {
  std::array<double, kMostCorners> distances;
  bool isCut = false;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    distances[i] = distance(polygon.corners[i]);
    isCut = isCut || !(distances[i] >= 0.0); // or a NaN
  }
  if (!isCut) return;
  Polygon left;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const std::size_t next = (i + 1) % polygon.count;
    const Vertex& from = polygon.corners[i];
    const Vertex& to = polygon.corners[next];
    const double a = distances[i];
    const double b = distances[next];
    const bool fromInside = a >= 0.0; // not for a NaN
    const bool toInside = b >= 0.0;
    if (fromInside) left.add(from);
    if (fromInside && !toInside) left.add(between(from, a, to, b, planes));
    if (!fromInside && toInside) left.add(between(to, b, from, a, planes));
  }
  polygon = left;
}

void clipAll(const Viewport& viewport, Polygon& polygon, std::uint32_t planes) {
  const Band band = bandOf(viewport);
  // A corner that needs no clipping by floats needs none here either: neighbours that are not clipped have the same
  // one.
  constexpr double kMore = 1.0 + 0x1.0p-20;
  const double bandX = double{band.x} * kMore;
  const double bandY = double{band.y} * kMore;
  clip(polygon, planes, [&](const Vertex& v) { return nearDistance(viewport, v.position); });
  clip(polygon, planes, [&](const Vertex& v) { return farDistance(v.position); });
  clip(polygon, planes, [&](const Vertex& v) { return bandX * v.position[3] - v.position[0]; });
  clip(polygon, planes, [&](const Vertex& v) { return bandX * v.position[3] + v.position[0]; });
  clip(polygon, planes, [&](const Vertex& v) { return bandY * v.position[3] - v.position[1]; });
  clip(polygon, planes, [&](const Vertex& v) { return bandY * v.position[3] + v.position[1]; });
  for (std::uint32_t plane = 0; plane < planes; ++plane) {
    clip(polygon, planes, [&](const Vertex& v) { return v.distances[plane]; });
  }
}

// Whether a corner can be divided by its w: one at w = 0 is left over where all of a triangle lies in the eye's plane.
// Nor one with coordinates that are not finite.
bool hasPlace(const Vertex& v) {
  const auto& p = v.position;
  return p[3] >= double{kLeastW} && p[3] <= double{kMostW} && std::isfinite(p[0]) && std::isfinite(p[1]) &&
         std::isfinite(p[2]);
}

Pieces fanOf(const Viewport& viewport, const Polygon& polygon) {
  Pieces made;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    if (!hasPlace(polygon.corners[i])) return made;
  }
  for (std::size_t i = 2; i < polygon.count && made.count < kMostPieces; ++i) {
    Piece& piece = made.pieces[made.count++];
    const std::array<const Vertex*, 3> corners{&polygon.corners[0], &polygon.corners[i - 1], &polygon.corners[i]};
    for (std::size_t c = 0; c < 3; ++c) {
      piece.corners[c] = placed(viewport, corners[c]->rounded());
      piece.second[c] = static_cast<float>(corners[c]->second);
      piece.third[c] = static_cast<float>(corners[c]->third);
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
  for (const ClipVertex& corner : triangle) polygon.add(Vertex(corner));
  clipAll(viewport, polygon, planes);
  return fanOf(viewport, polygon);
}

Pieces lineOf(const Viewport& viewport, const std::array<ClipVertex, 2>& line, std::uint32_t planes) {
  Polygon polygon; // of two corners: what a plane leaves of it is again two, or four of which two are the same
  polygon.add(Vertex(line[0]));
  polygon.add(Vertex(line[1]));
  clipAll(viewport, polygon, planes);
  if (polygon.count < 2) return {};
  // The ends of what is left: those with the smallest and the largest weight.
  const std::span<const Vertex> ends(polygon.corners.data(), polygon.count);
  const auto [first, last] =
      std::minmax_element(ends.begin(), ends.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (!hasPlace(*first) || !hasPlace(*last)) return {};
  const Place a = placeOf(viewport, first->rounded());
  const Place b = placeOf(viewport, last->rounded());
  const bool isSteep = std::fabs(b.y - a.y) > std::fabs(b.x - a.x);
  const float dx = isSteep ? 0.5F : 0.0F;
  const float dy = isSteep ? 0.0F : 0.5F;
  const auto secondOf = [](const Vertex& v) { return static_cast<float>(v.second); };
  const auto moved = [](Place place, float x, float y) {
    return Place{place.x + x, place.y + y, place.depth, place.inverseW};
  };
  return quadOf(viewport, {moved(a, -dx, -dy), moved(b, -dx, -dy), moved(b, dx, dy), moved(a, dx, dy)},
                {secondOf(*first), secondOf(*last), secondOf(*last), secondOf(*first)});
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
