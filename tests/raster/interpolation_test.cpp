// Depth, weights and derivatives against extended precision, with the errors that vitrail/cpu.h states.
#include <algorithm>
#include <cmath>
#include <string>

#include "coverage.h"

namespace vitrail::tests::raster {
namespace {

using vitrail::raster::Corner;
using vitrail::raster::Edges;

constexpr std::uint32_t kWeightsSide = 128;

struct Values {
  long double depth = 0.0L;
  long double second = 0.0L;
  long double third = 0.0L;
};

class TrueValues {
 public:
  TrueValues(const std::array<Corner, 3>& corners)
      : corners_(corners), edges_(vitrail::raster::edgesOf(corners[0], corners[1], corners[2])) {}

  Values at(std::uint32_t x, std::uint32_t y) const {
    return at(std::int64_t{x} * 256 + 128, std::int64_t{y} * 256 + 128);
  }
  // At a place in 1/256 of a pixel.
  Values at(std::int64_t x, std::int64_t y) const {
    std::array<long double, 3> share{};
    long double sum = 0.0L;
    Values values;
    for (std::size_t i = 0; i < 3; ++i) {
      share[i] = static_cast<long double>(edges_.edge[i].at(x, y)) / static_cast<long double>(edges_.area);
      values.depth += share[i] * corners_[i].depth;
      sum += share[i] * corners_[i].inverseW;
    }
    values.second = share[1] * corners_[1].inverseW / sum;
    values.third = share[2] * corners_[2].inverseW / sum;
    return values;
  }
  // How values change from pixel to pixel where they are so.
  Values slope(std::uint32_t px, std::uint32_t py, bool down) const {
    const Values here = at(px, py);
    long double sum = 0.0L;
    long double change = 0.0L;
    std::array<long double, 3> slopes{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& edge = edges_.edge[i];
      slopes[i] = static_cast<long double>(down ? edge.b : edge.a) * 256.0L / static_cast<long double>(edges_.area);
      const long double share =
          static_cast<long double>(edge.at(std::int64_t{px} * 256 + 128, std::int64_t{py} * 256 + 128)) /
          static_cast<long double>(edges_.area);
      sum += share * corners_[i].inverseW;
      change += slopes[i] * corners_[i].inverseW;
    }
    return {0.0L, (slopes[1] * corners_[1].inverseW - here.second * change) / sum,
            (slopes[2] * corners_[2].inverseW - here.third * change) / sum};
  }
  float largestDepth() const { return std::max({corners_[0].depth, corners_[1].depth, corners_[2].depth}); }
  // How much larger the w of one corner is than that of another.
  float perspective() const {
    const auto [least, most] = std::minmax({corners_[0].inverseW, corners_[1].inverseW, corners_[2].inverseW});
    return most / least;
  }
  // The steepest weight straight on the picture, a pixel.
  long double steepest() const {
    long double most = 0.0L;
    for (const auto& edge : edges_.edge) {
      most = std::max({most, std::fabs(static_cast<long double>(edge.a)), std::fabs(static_cast<long double>(edge.b))});
    }
    return most * 256.0L / static_cast<long double>(edges_.area);
  }

 private:
  std::array<Corner, 3> corners_;
  Edges edges_;
};

// The largest errors, as multiples of what is allowed.
struct Errors {
  const std::vector<Position>* positions = nullptr;
  double depth = 0.0;  // of 2^-22 of the largest depth
  double weight = 0.0; // of 2^-20, times how much the corners' w differ
  double slope = 0.0;  // of 2^-19 of the steepest weight, times the square of that
  double plain = 0.0;  // of 2^-20, where all w are alike
  std::uint64_t fragments = 0;

  void add(const VitrailCpuFragments& f, std::size_t i);
};

void Errors::add(const VitrailCpuFragments& f, std::size_t i) {
  const vitrail::raster::Viewport viewport{kWeightsSide, kWeightsSide, 0, 0, false, false};
  const Position* p = &(*positions)[std::size_t{3} * f.triangle[i]];
  const TrueValues truth({vitrail::raster::placed(viewport, p[0]), vitrail::raster::placed(viewport, p[1]),
                          vitrail::raster::placed(viewport, p[2])});
  const auto x = static_cast<std::uint32_t>(f.x + i % 4);
  const auto y = static_cast<std::uint32_t>(f.y + i / 4);
  const Values values = truth.at(x, y);
  const auto grow = [](double& most, long double error) {
    most = std::max(most, static_cast<double>(std::fabs(error)));
  };
  grow(depth, (f.depth[i] - values.depth) / (0x1.0p-22L * truth.largestDepth()));
  const long double perspective = truth.perspective();
  for (const long double error : {f.second[i] - values.second, f.third[i] - values.third}) {
    grow(weight, error / (0x1.0p-20L * perspective));
    if (perspective <= 1.001L) grow(plain, error / 0x1.0p-20L);
  }
  const Values right = truth.slope(x, y, false);
  const Values below = truth.slope(x, y, true);
  const long double unit = 0x1.0p-19L * truth.steepest() * perspective * perspective;
  grow(slope, (f.secondDx[i] - right.second) / unit);
  grow(slope, (f.thirdDx[i] - right.third) / unit);
  grow(slope, (f.secondDy[i] - below.second) / unit);
  grow(slope, (f.thirdDy[i] - below.third) / unit);
  ++fragments;
}

void measure(void* user, VitrailCpuFragments* f) {
  for (std::size_t i = 0; i < VITRAIL_CPU_LANES; ++i) {
    for (auto& channel : f->color) channel[i] = 0.001F;
    if ((f->mask >> i & 1U) != 0) static_cast<Errors*>(user)->add(*f, i);
  }
}

void expectValues(const std::vector<Position>& positions, const std::string& what) {
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions);
    Errors errors;
    errors.positions = &positions;
    Picture picture(kWeightsSide, kWeightsSide);
    const VitrailCpuFrame frame = picture.frame();
    VitrailCpuDraw draw = drawOf(positions);
    draw.blend = VITRAIL_BLEND_ADDITIVE;
    draw.shade = measure;
    draw.shadeUser = &errors;
    draw.shadeFlags = VITRAIL_CPU_SHADE_DERIVATIVES;
    ASSERT_EQ(raster.render(frame, {&draw, 1}), VITRAIL_SUCCESS);
    std::printf("  %s, %s: %llu fragments, of what is allowed depth %.3f, weights %.3f (w alike %.3f), slopes %.3f\n",
                what.c_str(), nameOf(instructions), static_cast<unsigned long long>(errors.fragments), errors.depth,
                errors.weight, errors.plain, errors.slope);
    EXPECT_GT(errors.fragments, 1000U);
    EXPECT_LE(errors.depth, 1.0) << what;
    EXPECT_LE(errors.weight, 1.0) << what;
    EXPECT_LE(errors.plain, 1.0) << what;
    EXPECT_LE(errors.slope, 1.0) << what;
  }
}

std::vector<Position> triangles(Random& random, std::size_t count, double size, double wExponent) {
  std::vector<Position> positions;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.real(0.0, kWeightsSide);
    const double y = random.real(0.0, kWeightsSide);
    for (int corner = 0; corner < 3; ++corner) {
      const double cornerX = x + random.real(-size, size);
      const float w = static_cast<float>(std::exp2(random.real(-wExponent, wExponent)));
      positions.push_back(
          inPixels(kWeightsSide, kWeightsSide, cornerX, y + random.real(-size, size), random.single(0.0, 1.0), w));
    }
  }
  return positions;
}

// Two corners nearly in one place.
std::vector<Position> slivers(Random& random, std::size_t count, double length, double wExponent) {
  std::vector<Position> positions = triangles(random, count, length, wExponent);
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    const Position& p = positions[i];
    Position& q = positions[i + 1];
    const auto moved = [&](float v) {
      return (v / p[3] + random.single(-16.0, 16.0) / (kWeightsSide * 128.0F)) * q[3];
    };
    q[0] = moved(p[0]);
    q[1] = moved(p[1]);
  }
  return positions;
}

TEST(InterpolationTest, OfOrdinaryTriangles) {
  Random random(30);
  expectValues(triangles(random, 1500, 15.0, 0.0), "w alike");
  expectValues(triangles(random, 1500, 15.0, 2.0), "in perspective");
}
TEST(InterpolationTest, OfSmallAndOfLargeTriangles) {
  Random random(31);
  expectValues(triangles(random, 20000, 1.0, 2.0), "small");
  expectValues(triangles(random, 20, 400.0, 2.0), "large");
  expectValues(triangles(random, 20, 20000.0, 2.0), "huge");
}
TEST(InterpolationTest, OfSlivers) {
  Random random(32);
  expectValues(slivers(random, 6000, 30.0, 0.0), "slivers");
  expectValues(slivers(random, 6000, 30.0, 2.0), "slivers in perspective");
  expectValues(slivers(random, 20000, 600.0, 2.0), "far slivers");
}
TEST(InterpolationTest, InStrongPerspective) {
  Random random(33);
  expectValues(triangles(random, 1500, 15.0, 7.0), "w up to 16,384 times as large");
}

// ---- Depth at samples, as opaque triangles leave it

void expectSampleDepths(const std::vector<Position>& positions, const std::string& what) {
  const vitrail::raster::Viewport viewport{kWeightsSide, kWeightsSide, 0, 0, false, false};
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions);
    for (const std::uint32_t samples : {2U, 4U, 8U}) {
      std::uint64_t covered = 0;
      double worst = 0.0;
      for (std::size_t i = 0; i < positions.size(); i += 3) {
        const std::array<Corner, 3> corners = {vitrail::raster::placed(viewport, positions[i]),
                                               vitrail::raster::placed(viewport, positions[i + 1]),
                                               vitrail::raster::placed(viewport, positions[i + 2])};
        const TrueValues truth(corners);
        VitrailCpuDraw draw = drawOf(positions);
        draw.positions = positions[i].data();
        draw.vertexCount = 3;
        draw.surface = VITRAIL_CPU_OPAQUE;
        Picture picture(kWeightsSide, kWeightsSide);
        std::vector<float> depth(std::size_t{kWeightsSide} * kWeightsSide * samples, 1.0F);
        VitrailCpuFrame frame = picture.frame();
        frame.samples = samples;
        frame.depth = depth.data();
        ASSERT_EQ(raster.render(frame, {&draw, 1}), VITRAIL_SUCCESS);
        for (std::size_t at = 0; at < depth.size(); ++at) {
          if (depth[at] == 1.0F) continue;
          const auto pixel = static_cast<std::int64_t>(at / samples);
          const auto place = vitrail::raster::samplePlaces(samples)[at % samples];
          const Values values =
              truth.at(pixel % kWeightsSide * 256 + place.x * 16, pixel / kWeightsSide * 256 + place.y * 16);
          const auto error = static_cast<double>(std::fabs(depth[at] - values.depth));
          worst = std::max(worst, error / (0x1.0p-22 * double{truth.largestDepth()}));
          ++covered;
        }
      }
      EXPECT_GT(covered, 200U) << what;
      EXPECT_LE(worst, 1.0) << what << ", " << samples << " samples, " << nameOf(instructions);
    }
  }
}

TEST(InterpolationTest, OfDepthAtSamples) {
  Random random(34);
  expectSampleDepths(triangles(random, 100, 15.0, 1.0), "ordinary triangles");
  expectSampleDepths(slivers(random, 300, 60.0, 1.0), "slivers");
}

} // namespace
} // namespace vitrail::tests::raster
