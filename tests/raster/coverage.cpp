#include "coverage.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

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
};

int takeList(void* user, std::uint32_t x, std::uint32_t y, const VitrailLayer* layers, std::uint32_t count,
             float* /*color*/) {
  const Taker& taker = *static_cast<Taker*>(user);
  PixelSum& sum = (*taker.sums)[std::size_t{y} * taker.width + x];
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

// ---- Kinds. Places are in pixels; those that are multiples of 1/256 stay so in clip space, since sides are powers of 2.

constexpr std::uint32_t kSide = 128;

CoverageFrame empty(std::uint32_t samples) { return {kSide, kSide, samples, {}}; }

void addAt(CoverageFrame& frame, double x, double y, float w = 1.0F) {
  frame.positions.push_back(inPixels(frame.width, frame.height, x, y, 0.5F, w));
}

double onGrid(double v) { return std::nearbyint(v * 256.0) / 256.0; }

// Three corners within `size` of a random place.
CoverageFrame around(Random& random, std::uint32_t samples, std::size_t count, double size, double step) {
  CoverageFrame frame = empty(samples);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.real(-4.0, kSide + 4.0);
    const double y = random.real(-4.0, kSide + 4.0);
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
CoverageFrame onSamples(Random& random, std::uint32_t samples) { return around(random, samples, 20000, 3.0, 1.0 / 16.0); }
CoverageFrame onCentres(Random& random, std::uint32_t samples) { return around(random, samples, 20000, 4.0, 0.5); }

// Two corners a few steps of the grid apart, the third far away, in every direction.
CoverageFrame slivers(Random& random, std::uint32_t samples) {
  CoverageFrame frame = empty(samples);
  for (std::size_t i = 0; i < 8000; ++i) {
    const double x = onGrid(random.real(-8.0, kSide + 8.0));
    const double y = onGrid(random.real(-8.0, kSide + 8.0));
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
    const double x = random.whole(0, kSide * 16) / 16.0;
    const double y = random.whole(0, kSide * 16) / 16.0;
    const int dx = random.whole(-64, 64);
    const int dy = random.whole(-64, 64);
    const int times = random.whole(-3, 3);
    addAt(frame, x, y);
    addAt(frame, x + dx / 16.0, y + dy / 16.0);
    addAt(frame, x + times * dx / 16.0 + (i % 3 == 0 ? 1.0 / 256.0 : 0.0), y + times * dy / 16.0);
  }
  return frame;
}

// Corners up to the guard band, so that numbers are as large as they get.
CoverageFrame huge(Random& random, std::uint32_t samples) {
  CoverageFrame frame = empty(samples);
  for (std::size_t i = 0; i < 120; ++i) {
    const double reach = std::pow(10.0, random.real(2.0, 4.51));
    for (int corner = 0; corner < 3; ++corner) {
      const double x = kSide / 2.0 + random.real(-reach, reach);
      addAt(frame, onGrid(x), onGrid(kSide / 2.0 + random.real(-reach, reach)));
    }
  }
  return frame;
}

// Long thin ones through the picture whose corners are far out of it.
CoverageFrame farSlivers(Random& random, std::uint32_t samples) {
  CoverageFrame frame = empty(samples);
  for (std::size_t i = 0; i < 1000; ++i) {
    const double angle = random.real(0.0, 6.283185307179586);
    const double reach = random.real(200.0, 30000.0);
    const double x = random.real(0.0, kSide);
    const double y = random.real(0.0, kSide);
    const double thin = random.real(0.0, 2.0);
    addAt(frame, onGrid(x + reach * std::cos(angle)), onGrid(y + reach * std::sin(angle)));
    addAt(frame, onGrid(x - reach * std::cos(angle)), onGrid(y - reach * std::sin(angle)));
    addAt(frame, onGrid(x - reach * std::cos(angle) + thin), onGrid(y - reach * std::sin(angle) - thin));
  }
  return frame;
}

// Different w at the corners, places that are not on the grid.
CoverageFrame inPerspective(Random& random, std::uint32_t samples) {
  CoverageFrame frame = empty(samples);
  for (std::size_t i = 0; i < 15000; ++i) {
    const double x = random.real(-4.0, kSide + 4.0);
    const double y = random.real(-4.0, kSide + 4.0);
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
    const double x = random.whole(-32, kSide * 16) / 16.0;
    const double y = random.whole(-32, kSide * 16) / 16.0;
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
      {"Small", smallTriangles},     {"Subpixel", subpixelTriangles}, {"OnSamples", onSamples},
      {"OnCentres", onCentres},      {"Slivers", slivers},            {"Degenerate", degenerate},
      {"Huge", huge},                {"FarSlivers", farSlivers},      {"Perspective", inPerspective},
      {"Boxes", boxes},
  };
  return kinds;
}

Sums coveredBy(Raster& raster, const CoverageFrame& coverage) {
  Sums sums(coverage.pixels());
  Taker taker{&sums, coverage.width};
  Picture picture(coverage.width, coverage.height);
  VitrailCpuFrame frame = picture.frame();
  frame.samples = coverage.samples;
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
  const Viewport viewport{frame.width, frame.height, 0, 0, false, false};
  for (std::size_t t = 0; t < frame.triangles(); ++t) {
    const Position* p = &frame.positions[3 * t];
    if (std::none_of(p, p + 3, [&](const Position& corner) { return vitrail::raster::needsClipping(viewport, corner); })) {
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

std::uint32_t roundsOfTests() {
  const char* rounds = std::getenv("VITRAIL_TEST_FRAMES");
  return rounds == nullptr ? 1 : static_cast<std::uint32_t>(std::max(1, std::atoi(rounds)));
}

std::size_t differences(const Sums& a, const Sums& b) {
  std::size_t count = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) count += static_cast<std::size_t>(!(a[i] == b[i]));
  return count;
}

} // namespace vitrail::tests::raster
