// The rules by which every rasteriser of ours decides what a triangle covers: those of graphics hardware, as Direct3D
// 11
// ("Rasterization Rules") and Vulkan (26.11 and 26.8, "Standard sample locations") state them. No API, no vectors.
//
//   - Corners are rounded to 1/256 pixel, ties to even.
//   - An edge function is exact (Pineda 1988): an integer at every sample.
//   - A sample on an edge belongs to the triangle of which that is a top or a left edge, so that of triangles which
//   share
//     an edge exactly one covers it.
//   - Samples lie where Vulkan's standard sample locations are, on a grid of 16 x 16 in the pixel.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace vitrail::raster {

constexpr int kSubpixelBits = 8;
constexpr std::int32_t kSubpixels = 1 << kSubpixelBits; // in a pixel

// How far from the picture's middle a corner may lie, in pixels: what reaches farther is clipped. Differences of
// coordinates then fit in 25 bits, and edge functions in a double without rounding.
constexpr std::int32_t kGuardBand = 32767;

// The least w of clip space that a corner may have: one over it is still finite.
constexpr float kLeastW = 1.1754944e-38F;

// The largest: guard bands times it are still finite. What is cut off at one that is larger is not drawn.
constexpr float kMostW = 1.2676506e30F; // 2^100

// A corner's place in the picture in subpixels, y down, and what is interpolated without perspective: depth, and one
// over the w of clip space.
struct Corner {
  std::int32_t x = 0;
  std::int32_t y = 0;
  float depth = 0.0F;
  float inverseW = 0.0F;
};

// The x of a corner that has to be clipped first; the rest of it is of no meaning.
constexpr std::int32_t kNeedsClipping = INT32_MIN;

// Pixels to subpixels, in the processor's rounding mode: to the nearest, ties to even. Where clipping has left nothing
// but noise, a place twice as far as any that can be rasterised.
inline std::int32_t snap(float pixels) {
  constexpr auto kMost = static_cast<float>(2 * kGuardBand);
  const float within = pixels > -kMost ? (pixels < kMost ? pixels : kMost) : -kMost; // a NaN, too
  return static_cast<std::int32_t>(std::nearbyintf(within * static_cast<float>(kSubpixels)));
}

// Where a sample lies in its pixel, in sixteenths from the upper left corner.
struct SamplePlace {
  std::int32_t x;
  std::int32_t y;
};

constexpr std::uint32_t kMaxSamples = 8;
inline constexpr std::array<std::array<SamplePlace, kMaxSamples>, 4> kSamplePlaces = {{
    {{{8, 8}}},
    {{{12, 12}, {4, 4}}},
    {{{6, 2}, {14, 6}, {2, 10}, {10, 14}}},
    {{{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}}},
}};

// Of 1, 2, 4 or 8 samples a pixel.
constexpr const std::array<SamplePlace, kMaxSamples>& samplePlaces(std::uint32_t samples) {
  return kSamplePlaces[samples == 8 ? 3 : samples / 2];
}

// An edge function a * x + b * y + c over subpixels, not negative on the inside.
struct Edge {
  std::int64_t a;
  std::int64_t b;
  std::int64_t c;

  // Whether a sample on the edge is the triangle's: on a left edge, or on a top one.
  constexpr bool owns() const { return a > 0 || (a == 0 && b > 0); }
  constexpr std::int64_t at(std::int64_t x, std::int64_t y) const { return a * x + b * y + c; }
  constexpr bool covers(std::int64_t x, std::int64_t y) const { return at(x, y) >= (owns() ? 0 : 1); }
};

// A triangle as its three edges, edge i across from corner i, turned so that the inside is positive.
struct Edges {
  std::array<Edge, 3> edge{};
  std::int64_t area = 0; // twice its area in square subpixels; 0: it covers nothing
  bool front = false;    // its corners run counter-clockwise in the picture

  constexpr bool covers(std::int64_t x, std::int64_t y) const {
    return area > 0 && edge[0].covers(x, y) && edge[1].covers(x, y) && edge[2].covers(x, y);
  }
};

constexpr Edges edgesOf(const Corner& p0, const Corner& p1, const Corner& p2) {
  const std::array<Corner, 3> corners{p0, p1, p2};
  Edges edges;
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner& p = corners[(i + 1) % 3];
    const Corner& q = corners[(i + 2) % 3];
    Edge& edge = edges.edge[i];
    edge.a = std::int64_t{p.y} - q.y;
    edge.b = std::int64_t{q.x} - p.x;
    edge.c = -(edge.a * p.x + edge.b * p.y);
  }
  edges.area = edges.edge[0].at(p0.x, p0.y);
  edges.front = edges.area < 0;
  if (!edges.front) return edges;
  edges.area = -edges.area;
  for (Edge& edge : edges.edge) edge = {-edge.a, -edge.b, -edge.c};
  return edges;
}

// The samples of pixel (x, y) that a triangle covers, a bit each.
constexpr std::uint32_t coverage(const Edges& edges, std::int64_t x, std::int64_t y, std::uint32_t samples) {
  std::uint32_t covered = 0;
  for (std::uint32_t s = 0; s < samples; ++s) {
    const SamplePlace place = samplePlaces(samples)[s];
    const std::int64_t subX = x * kSubpixels + place.x * (kSubpixels / 16);
    const std::int64_t subY = y * kSubpixels + place.y * (kSubpixels / 16);
    if (edges.covers(subX, subY)) covered |= 1U << s;
  }
  return covered;
}

} // namespace vitrail::raster
