// Which triangles cover which samples of a picture, in sums that can be compared: of the rasteriser, and by the scalar
// rules of raster/rules.h.
#pragma once

#include <cstdint>
#include <vector>

#include "host.h"
#include "raster/clip.h"

namespace vitrail::tests::raster {

// Of one pixel: how many triangles touch it, and a sum of hashes of each triangle's number and the samples that it
// covers. Shaders add the same (shaders/coverage.frag).
struct PixelSum {
  std::uint32_t count = 0;
  std::uint32_t hash = 0;

  bool operator==(const PixelSum&) const = default;
  void add(std::uint32_t triangle, std::uint32_t samples) {
    ++count;
    std::uint32_t h = triangle * 0x9e3779b1U + samples * 0x85ebca6bU;
    h = (h ^ h >> 15U) * 0x2c1b3c6dU;
    hash += h ^ h >> 13U;
  }
};

struct CoverageFrame {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 1;
  std::vector<Position> positions; // three a triangle, clip space of Vulkan

  std::size_t triangles() const { return positions.size() / 3; }
  std::size_t pixels() const { return std::size_t{width} * height; }
};

using Sums = std::vector<PixelSum>;

// What the rasteriser covers, as its list hook tells.
Sums coveredBy(Raster& raster, const CoverageFrame& frame);

// What the scalar rules say of corners that scalar code has rounded, pixel by pixel.
Sums coveredByRules(const CoverageFrame& frame);

// How often random frames are drawn: VITRAIL_TEST_FRAMES, for long runs by hand.
std::uint32_t roundsOfTests();

// How many pixels differ.
std::size_t differences(const Sums& a, const Sums& b);

// Triangles of every kind that is hard, by the name of the kind.
struct TriangleKind {
  const char* name;
  CoverageFrame (*make)(Random& random, std::uint32_t samples);
};
const std::vector<TriangleKind>& triangleKinds();

} // namespace vitrail::tests::raster
