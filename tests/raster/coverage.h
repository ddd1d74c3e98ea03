// Which triangles cover which samples of a picture, in sums that can be compared: of the rasteriser, and by the scalar
// rules of raster/rules.h.
#pragma once

#include <cstdint>
#include <functional>
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
  // The side of the square picture that the frame is a part of, and where it begins; 0: it is the picture.
  std::uint32_t picture = 0;
  std::uint32_t origin = 0;

  std::size_t triangles() const { return positions.size() / 3; }
  std::size_t pixels() const { return std::size_t{width} * height; }
};

using Sums = std::vector<PixelSum>;

// What the rasteriser covers, as its list hook tells.
Sums coveredBy(Raster& raster, const CoverageFrame& frame);

// What the scalar rules say of corners that scalar code has rounded, pixel by pixel.
Sums coveredByRules(const CoverageFrame& frame);

// How many pixels differ.
std::size_t differences(const Sums& a, const Sums& b);

// Triangles of every kind that is hard, by the name of the kind. None needs clipping.
struct TriangleKind {
  const char* name;
  CoverageFrame (*make)(Random& random, std::uint32_t samples);
  bool isInView; // all lie within the picture: no driver clips them
};
const std::vector<TriangleKind>& triangleKinds();

// Triangles that do.
CoverageFrame throughTheNearPlane(Random& random);
CoverageFrame beyondTheGuardBand(Random& random);

// A triangle in exact arithmetic, near enough: a place is in it where its three homogeneous edge functions (Olano and
// Greer 1997) have the sign of the triangle's volume, and its depth lies between the planes.
class TrueTriangle {
 public:
  TrueTriangle(const Position* p, std::uint32_t side);

  bool isEmpty() const { return isEmpty_; }
  // How far inside a place is, in pixels, by the nearest of its edges; negative outside.
  long double inside(long double x, long double y) const;

 private:
  std::uint32_t side_;
  bool isEmpty_ = false;
  std::array<std::array<long double, 3>, 5> lines_{};
};

// How far what is drawn of triangles, one by one, is from the truth.
struct Distances {
  std::uint64_t triangles = 0;
  std::uint64_t samples = 0;
  std::uint64_t wrong = 0;
  double farthest = 0.0; // of a wrong sample from the true edge, in pixels

  void print(const char* what) const;
};
// `cover` draws a frame of one triangle.
Distances distancesOf(const CoverageFrame& frame, const std::function<Sums(const CoverageFrame&)>& cover);

} // namespace vitrail::tests::raster
