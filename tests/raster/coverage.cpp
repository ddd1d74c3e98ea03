#include "coverage.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vitrail::tests::raster {

namespace {

using vitrail::raster::Corner;
using vitrail::raster::Edges;
using vitrail::raster::Piece;
using vitrail::raster::Viewport;

// A triangle's number in two colours, each an integer that a float holds.
constexpr std::uint32_t kLowBits = 12;

void shadeNumber(void* /*user*/, VitrailCpuFragments* f) {
  for (std::size_t i = 0; i < VITRAIL_CPU_LANES; ++i) {
    f->color[0][i] = static_cast<float>(f->triangle[i] & ((1U << kLowBits) - 1));
    f->color[1][i] = static_cast<float>(f->triangle[i] >> kLowBits);
    f->color[2][i] = 1.0F;
    f->color[3][i] = 0.0F;
  }
}

struct Taker {
  Sums* sums;
  std::uint32_t width;
  std::uint32_t origin;
};

int takeList(void* user, std::uint32_t x, std::uint32_t y, const VitrailLayer* layers, std::uint32_t count,
             float* /*color*/) {
  const Taker& taker = *static_cast<Taker*>(user);
  PixelSum& sum = (*taker.sums)[std::size_t{y - taker.origin} * taker.width + (x - taker.origin)];
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto low = static_cast<std::uint32_t>(layers[i].color[0]);
    const auto high = static_cast<std::uint32_t>(layers[i].color[1]);
    sum.add(high << kLowBits | low, layers[i].coverage);
  }
  return 0;
}

void addCovered(const CoverageFrame& frame, std::uint32_t number, const std::array<Corner, 3>& corners, Sums& sums) {
  const Edges edges = vitrail::raster::edgesOf(corners[0], corners[1], corners[2]);
  if (edges.area == 0) return;
  const auto [x0, x1] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
  const auto [y0, y1] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  // A pixel more than needed on all sides, within the picture.
  const auto first = [](std::int32_t low) { return std::max((low >> 8) - 1, 0); };
  const auto last = [](std::int32_t high, std::uint32_t size) {
    return std::min((high >> 8) + 1, static_cast<std::int32_t>(size) - 1);
  };
  for (std::int32_t y = first(y0); y <= last(y1, frame.height); ++y) {
    for (std::int32_t x = first(x0); x <= last(x1, frame.width); ++x) {
      const std::uint32_t covered = vitrail::raster::coverage(edges, x, y, frame.samples);
      if (covered == 0) continue;
      sums[static_cast<std::size_t>(y) * frame.width + static_cast<std::size_t>(x)].add(number, covered);
    }
  }
}

// ---- Kinds. Places are in pixels from the frame's corner, and reach out of it, but not out of the picture, where
// drivers clip. Those that are multiples of 1/256 stay so in clip space, since sides are powers of 2.

constexpr std::uint32_t kCoverageSide = 128;

CoverageFrame empty(std::uint32_t samples, std::uint32_t picture = 1024) {
  return {kCoverageSide, kCoverageSide, samples, {}, picture, (picture - kCoverageSide) / 2};
}

void addAt(CoverageFrame& frame, double x, double y, float w = 1.0F) {
  frame.positions.push_back(inPixels(frame.picture, frame.picture, x + frame.origin, y + frame.origin, 0.5F, w));
}

double onGrid(double v) { return std::nearbyint(v * 256.0) / 256.0; }

// Three corners within `size` of a random place.
CoverageFrame around(Random& random, std::uint32_t samples, std::size_t count, double size, double step) {
  // Off the grid, how a driver rounds depends on where its coordinates begin: then the frame is the picture.
  CoverageFrame frame = step == 0.0 ? empty(samples, kCoverageSide) : empty(samples);
  const double margin = step == 0.0 ? -size : 4.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.real(-margin, kCoverageSide + margin);
    const double y = random.real(-margin, kCoverageSide + margin);
    const auto place = [&](double v) {
      const double p = v + random.real(-size, size);
      return step == 0.0 ? p : std::nearbyint(p / step) * step;
    };
    for (int corner = 0; corner < 3; ++corner) {
      const double cornerX = place(x);
      addAt(frame, cornerX, place(y));
    }
  }
  return frame;
}

CoverageFrame smallTriangles(Random& random, std::uint32_t samples) { return around(random, samples, 20000, 4.0, 0.0); }
CoverageFrame subpixelTriangles(Random& random, std::uint32_t samples) {
  return around(random, samples, 40000, 0.6, 1.0 / 256.0);
}
// Corners on samples' places, and so on the edges of others.
CoverageFrame onSamples(Random& random, std::uint32_t samples) {
  return around(random, samples, 20000, 3.0, 1.0 / 16.0);
}
CoverageFrame onCentres(Random& random, std::uint32_t samples) { return around(random, samples, 20000, 4.0, 0.5); }

// Two corners a few steps of the grid apart, the third far away, in every direction.
CoverageFrame slivers(Random& random, std::uint32_t samples) {
  CoverageFrame frame = empty(samples);
  for (std::size_t i = 0; i < 8000; ++i) {
    const double x = onGrid(random.real(-8.0, kCoverageSide + 8.0));
    const double y = onGrid(random.real(-8.0, kCoverageSide + 8.0));
    const double length = random.below(4) == 0 ? 200.0 : 20.0;
    addAt(frame, x, y);
    addAt(frame, x + random.whole(-3, 3) / 256.0, y + random.whole(-3, 3) / 256.0);
    addAt(frame, onGrid(x + random.real(-length, length)), onGrid(y + random.real(-length, length)));
  }
  return frame;
}

// Corners that fall together, or lie on one line: they cover nothing. Every third one is moved by one step.
CoverageFrame degenerate(Random& random, std::uint32_t samples) {
  CoverageFrame frame = empty(samples);
  for (std::size_t i = 0; i < 20000; ++i) {
    const double x = random.whole(0, kCoverageSide * 16) / 16.0;
    const double y = random.whole(0, kCoverageSide * 16) / 16.0;
    const int dx = random.whole(-64, 64);
    const int dy = random.whole(-64, 64);
    const int times = random.whole(-3, 3);
    addAt(frame, x, y);
    addAt(frame, x + dx / 16.0, y + dy / 16.0);
    addAt(frame, x + times * dx / 16.0 + (i % 3 == 0 ? 1.0 / 256.0 : 0.0), y + times * dy / 16.0);
  }
  return frame;
}

// Corners up to the guard band, so that numbers are as large as they get; or up to the border of a large picture.
CoverageFrame hugeOf(Random& random, std::uint32_t samples, std::uint32_t picture, double exponent) {
  CoverageFrame frame = empty(samples, picture);
  for (std::size_t i = 0; i < 120; ++i) {
    const double reach = std::pow(10.0, random.real(2.0, exponent));
    for (int corner = 0; corner < 3; ++corner) {
      const double x = kCoverageSide / 2.0 + random.real(-reach, reach);
      addAt(frame, onGrid(x), onGrid(kCoverageSide / 2.0 + random.real(-reach, reach)));
    }
  }
  return frame;
}

CoverageFrame huge(Random& random, std::uint32_t samples) { return hugeOf(random, samples, 1024, 4.51); }
CoverageFrame large(Random& random, std::uint32_t samples) { return hugeOf(random, samples, 16384, 3.9); }

// Long thin ones through the frame whose corners are far out of it.
CoverageFrame farSlivers(Random& random, std::uint32_t samples) {
  CoverageFrame frame = empty(samples, 16384);
  for (std::size_t i = 0; i < 1000; ++i) {
    const double angle = random.real(0.0, 6.283185307179586);
    const double reach = random.real(200.0, 8000.0);
    const double x = random.real(0.0, kCoverageSide);
    const double y = random.real(0.0, kCoverageSide);
    const double thin = random.real(0.0, 2.0);
    addAt(frame, onGrid(x + reach * std::cos(angle)), onGrid(y + reach * std::sin(angle)));
    addAt(frame, onGrid(x - reach * std::cos(angle)), onGrid(y - reach * std::sin(angle)));
    addAt(frame, onGrid(x - reach * std::cos(angle) + thin), onGrid(y - reach * std::sin(angle) - thin));
  }
  return frame;
}

// Different w at the corners, places that are not on the grid.
CoverageFrame inPerspective(Random& random, std::uint32_t samples) {
  CoverageFrame frame = empty(samples, kCoverageSide);
  for (std::size_t i = 0; i < 15000; ++i) {
    const double x = random.real(7.0, kCoverageSide - 7.0);
    const double y = random.real(7.0, kCoverageSide - 7.0);
    for (int corner = 0; corner < 3; ++corner) {
      const double cornerX = x + random.real(-6.0, 6.0);
      addAt(frame, cornerX, y + random.real(-6.0, 6.0), static_cast<float>(std::exp(random.real(-8.0, 8.0))));
    }
  }
  return frame;
}

// Boxes whose sides are horizontal and vertical, on samples and beside them.
CoverageFrame boxes(Random& random, std::uint32_t samples) {
  CoverageFrame frame = empty(samples);
  for (std::size_t i = 0; i < 6000; ++i) {
    const double x = random.whole(-32, kCoverageSide * 16) / 16.0;
    const double y = random.whole(-32, kCoverageSide * 16) / 16.0;
    const double right = x + random.whole(0, 100) / 16.0;
    const double bottom = y + random.whole(0, 100) / 16.0;
    const std::array<std::array<double, 2>, 6> corners{
        {{x, y}, {right, y}, {right, bottom}, {x, y}, {right, bottom}, {x, bottom}}};
    for (const auto& corner : corners) addAt(frame, corner[0], corner[1]);
  }
  return frame;
}

} // namespace

const std::vector<TriangleKind>& triangleKinds() {
  static const std::vector<TriangleKind> kinds = {
      {"Small", smallTriangles, true},  {"Subpixel", subpixelTriangles, true},
      {"OnSamples", onSamples, true},   {"OnCentres", onCentres, true},
      {"Slivers", slivers, true},       {"Degenerate", degenerate, true},
      {"Large", large, true},           {"Huge", huge, false},
      {"FarSlivers", farSlivers, true}, {"Perspective", inPerspective, true},
      {"Boxes", boxes, true},
  };
  return kinds;
}

Sums coveredBy(Raster& raster, const CoverageFrame& coverage) {
  Sums sums(coverage.pixels());
  Taker taker{&sums, coverage.width, coverage.origin};
  Picture picture(coverage.width, coverage.height);
  VitrailCpuFrame frame = picture.frame();
  frame.samples = coverage.samples;
  frame.pictureWidth = frame.pictureHeight = coverage.picture;
  frame.originX = frame.originY = coverage.origin;
  frame.list = takeList;
  frame.listUser = &taker;
  VitrailCpuDraw draw = drawOf(coverage.positions);
  draw.blend = VITRAIL_BLEND_PREMULTIPLIED;
  draw.shade = shadeNumber;
  EXPECT_EQ(raster.render(frame, {&draw, 1}), VITRAIL_SUCCESS);
  return sums;
}

Sums coveredByRules(const CoverageFrame& frame) {
  Sums sums(frame.pixels());
  const auto origin = static_cast<std::int32_t>(frame.origin);
  const Viewport viewport{frame.picture == 0 ? frame.width : frame.picture,
                          frame.picture == 0 ? frame.height : frame.picture,
                          origin,
                          origin,
                          false,
                          false};
  for (std::size_t t = 0; t < frame.triangles(); ++t) {
    const Position* p = &frame.positions[3 * t];
    if (std::none_of(p, p + 3,
                     [&](const Position& corner) { return vitrail::raster::needsClipping(viewport, corner); })) {
      addCovered(frame, static_cast<std::uint32_t>(t),
                 {vitrail::raster::placed(viewport, p[0]), vitrail::raster::placed(viewport, p[1]),
                  vitrail::raster::placed(viewport, p[2])},
                 sums);
      continue;
    }
    std::array<vitrail::raster::ClipVertex, 3> triangle;
    for (std::size_t i = 0; i < 3; ++i) triangle[i].position = p[i];
    const vitrail::raster::Pieces pieces = vitrail::raster::clipped(viewport, triangle, 0);
    for (const Piece& piece : pieces.all()) addCovered(frame, static_cast<std::uint32_t>(t), piece.corners, sums);
  }
  return sums;
}

CoverageFrame throughTheNearPlane(Random& random) {
  CoverageFrame frame{32, 32, 1, {}, 0, 0};
  for (std::size_t i = 0; i < 800; ++i) {
    const double scale = std::pow(10.0, random.real(-2.0, 2.0));
    for (int corner = 0; corner < 3; ++corner) {
      const double w = random.real(-1.0, 1.5) * scale;
      frame.positions.push_back({random.single(-2.0 * scale, 2.0 * scale), random.single(-2.0 * scale, 2.0 * scale),
                                 static_cast<float>(w - 0.1 * scale), static_cast<float>(w)});
    }
  }
  return frame;
}

CoverageFrame beyondTheGuardBand(Random& random) {
  CoverageFrame frame{32, 32, 1, {}, 0, 0};
  for (std::size_t i = 0; i < 800; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const double reach = std::pow(10.0, random.real(1.0, 7.0));
      const double x = random.real(-reach, reach);
      frame.positions.push_back(inPixels(32, 32, x, random.real(-reach, reach)));
    }
  }
  return frame;
}

TrueTriangle::TrueTriangle(const Position* p, std::uint32_t side) : side_(side) {
  using Vector = std::array<long double, 3>;
  const auto cross = [](const Vector& a, const Vector& b) {
    return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  std::array<Vector, 3> corners{};
  for (std::size_t i = 0; i < 3; ++i) corners[i] = {p[i][0], p[i][1], p[i][3]};
  for (std::size_t i = 0; i < 3; ++i) lines_[i] = cross(corners[(i + 1) % 3], corners[(i + 2) % 3]);
  long double volume = 0.0L;
  for (std::size_t i = 0; i < 3; ++i) volume += lines_[0][i] * corners[0][i];
  isEmpty_ = volume == 0.0L;
  if (isEmpty_) return;
  for (std::size_t i = 0; i < 3; ++i) {
    for (long double& v : lines_[i]) v /= volume;
  }
  // Line i at (x, y, 1) is a barycentric coordinate over w. z and w - z over w are sums of those.
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      lines_[3][c] += lines_[i][c] * p[i][2];
      lines_[4][c] += lines_[i][c] * (static_cast<long double>(p[i][3]) - p[i][2]);
    }
  }
}

long double TrueTriangle::inside(long double x, long double y) const {
  const long double u = x / side_ * 2.0L - 1.0L;
  const long double v = y / side_ * 2.0L - 1.0L;
  constexpr long double kFar = 1e30L;
  long double least = kFar;
  for (const auto& line : lines_) {
    const long double slope = std::hypot(line[0], line[1]) * 2.0L / side_;
    const long double value = line[0] * u + line[1] * v + line[2];
    least = std::min(least, slope > 0.0L ? value / slope : value < 0.0L ? -kFar : kFar);
  }
  return least;
}

void Distances::print(const char* what) const {
  std::printf("  %s: of %llu triangles %llu of %llu samples differ, at most %.5f pixels from an edge\n", what,
              static_cast<unsigned long long>(triangles), static_cast<unsigned long long>(wrong),
              static_cast<unsigned long long>(samples), farthest);
}

Distances distancesOf(const CoverageFrame& frame, const std::function<Sums(const CoverageFrame&)>& cover) {
  Distances distances;
  for (std::size_t t = 0; t < frame.triangles(); ++t) {
    const Position* p = &frame.positions[3 * t];
    const TrueTriangle triangle(p, frame.width);
    if (triangle.isEmpty()) continue;
    const Sums sums = cover({frame.width, frame.height, 1, {p[0], p[1], p[2]}, 0, 0});
    ++distances.triangles;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const long double x = static_cast<long double>(i % frame.width) + 0.5L;
      const long double inside = triangle.inside(x, static_cast<long double>(i / frame.width) + 0.5L);
      ++distances.samples;
      if ((sums[i].count > 0) == (inside >= 0.0L)) continue;
      ++distances.wrong;
      distances.farthest = std::max(distances.farthest, static_cast<double>(std::fabs(inside)));
    }
  }
  return distances;
}

std::size_t differences(const Sums& a, const Sums& b) {
  std::size_t count = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) count += static_cast<std::size_t>(!(a[i] == b[i]));
  return count;
}

} // namespace vitrail::tests::raster
