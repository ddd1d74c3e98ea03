// Coverage by the rasteriser against the scalar rules, for every set of instructions, and what no rule has to tell:
// meshes cover each sample exactly once.
#include <algorithm>
#include <cmath>
#include <string>

#include "coverage.h"

namespace vitrail::tests::raster {
namespace {

struct CoverageCase {
  TriangleKind kind;
  std::uint32_t samples;
};

class CoverageTest : public testing::TestWithParam<CoverageCase> {};

TEST_P(CoverageTest, IsThatOfTheRules) {
  const auto& [kind, samples] = GetParam();
  Random random(samples);
  for (std::uint32_t round = 0; round < roundsOfTests(); ++round) {
    const CoverageFrame frame = kind.make(random, samples);
    const Sums expected = coveredByRules(frame);
    for (const VitrailCpuInstructions instructions : instructionsHere()) {
      Raster raster(instructions);
      EXPECT_EQ(differences(coveredBy(raster, frame), expected), 0U) << nameOf(instructions) << ", round " << round;
    }
  }
}

std::vector<CoverageCase> coverageCases() {
  std::vector<CoverageCase> cases;
  for (const TriangleKind& kind : triangleKinds()) {
    for (const std::uint32_t samples : {1U, 2U, 4U, 8U}) cases.push_back({kind, samples});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Kinds, CoverageTest, testing::ValuesIn(coverageCases()),
                         [](const auto& given) { return given.param.kind.name + std::to_string(given.param.samples); });

// Draws without a shade function take another way through the rasteriser: what they add up to counts triangles.
TEST(CoverageOfFlatDrawsTest, CountsTriangles) {
  for (const TriangleKind& kind : triangleKinds()) {
    for (const std::uint32_t samples : {1U, 4U}) {
      Random random(17);
      const CoverageFrame frame = kind.make(random, samples);
      Sums expected = coveredByRules(frame);
      for (const VitrailCpuInstructions instructions : instructionsHere()) {
        Raster raster(instructions);
        Picture picture(frame.width, frame.height, {});
        VitrailCpuFrame desc = picture.frame();
        desc.samples = samples;
        desc.pictureWidth = desc.pictureHeight = frame.picture;
        desc.originX = desc.originY = frame.origin;
        VitrailCpuDraw draw = drawOf(frame.positions);
        draw.blend = VITRAIL_BLEND_ADDITIVE;
        draw.color[0] = 1.0F;
        draw.color[3] = 1.0F;
        VitrailStats stats{};
        ASSERT_EQ(raster.render(desc, {&draw, 1}, &stats), VITRAIL_SUCCESS);
        std::uint64_t fragments = 0;
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
          fragments += expected[i].count;
          const float value = picture.pixels[4 * i];
          const auto count = static_cast<float>(expected[i].count);
          wrong +=
              static_cast<std::size_t>(samples == 1 ? value != count : value > count || (value > 0) != (count > 0));
        }
        EXPECT_EQ(wrong, 0U) << kind.name << ", " << samples << " samples, " << nameOf(instructions);
        EXPECT_EQ(stats.fragmentsRequested, fragments) << kind.name << ", " << samples << " samples";
      }
    }
  }
}

// ---- Meshes

// A picture that a mesh covers wholly: each sample exactly once.
void expectEverySampleOnce(const CoverageFrame& mesh, const std::string& what) {
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions);
    Picture picture(mesh.width, mesh.height, {});
    VitrailCpuFrame frame = picture.frame();
    frame.samples = mesh.samples;
    VitrailCpuDraw draw = drawOf(mesh.positions);
    draw.blend = VITRAIL_BLEND_ADDITIVE;
    draw.color[0] = 1.0F;
    draw.color[3] = 1.0F;
    ASSERT_EQ(raster.render(frame, {&draw, 1}), VITRAIL_SUCCESS);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < mesh.pixels(); ++i) wrong += static_cast<std::size_t>(picture.pixels[4 * i] != 1.0F);
    EXPECT_EQ(wrong, 0U) << what << ", " << mesh.samples << " samples, " << nameOf(instructions);
  }
}

// Cells of a grid whose corners are moved, each cut along one of its diagonals, all turned around the picture's middle.
CoverageFrame gridMesh(Random& random, std::uint32_t samples, std::uint32_t side, double cell) {
  CoverageFrame frame{side, side, samples, {}, 0, 0};
  const double angle = random.real(0.0, 6.283185307179586);
  const double middle = side / 2.0;
  const auto across = static_cast<std::size_t>(std::ceil(1.5 * side / cell));
  std::vector<std::array<double, 2>> places;
  for (std::size_t y = 0; y <= across; ++y) {
    for (std::size_t x = 0; x <= across; ++x) {
      const double u = (static_cast<double>(x) + random.real(-0.2, 0.2) - static_cast<double>(across) / 2.0) * cell;
      const double v = (static_cast<double>(y) + random.real(-0.2, 0.2) - static_cast<double>(across) / 2.0) * cell;
      places.push_back(
          {middle + u * std::cos(angle) - v * std::sin(angle), middle + u * std::sin(angle) + v * std::cos(angle)});
    }
  }
  const auto add = [&](std::size_t place) {
    frame.positions.push_back(inPixels(side, side, places[place][0], places[place][1]));
  };
  for (std::size_t y = 0; y < across; ++y) {
    for (std::size_t x = 0; x < across; ++x) {
      const std::size_t a = y * (across + 1) + x;
      const std::size_t b = a + 1;
      const std::size_t c = b + across + 1;
      const std::size_t d = c - 1;
      const bool falls = random.below(2) == 0;
      for (const std::size_t place : falls ? std::array{a, b, c, a, c, d} : std::array{a, b, d, b, c, d}) add(place);
    }
  }
  return frame;
}

TEST(MeshTest, GridsCoverEverySampleOnce) {
  Random random(3);
  for (const std::uint32_t samples : {1U, 2U, 4U, 8U}) {
    for (const double cell : {0.3, 0.9, 3.0, 17.0, 70.0}) {
      expectEverySampleOnce(gridMesh(random, samples, cell < 1.0 ? 40 : 150, cell), "cells of " + std::to_string(cell));
    }
  }
}

// Thousands of triangles that meet in one corner, which lies on a sample or anywhere.
TEST(MeshTest, FansCoverEverySampleOnce) {
  Random random(4);
  constexpr std::uint32_t kSide = 96;
  for (const std::uint32_t samples : {1U, 2U, 4U, 8U}) {
    for (const double reach : {140.0, 1000.0, 25000.0}) {
      CoverageFrame fan{kSide, kSide, samples, {}, 0, 0};
      const bool isOnSample = random.below(2) == 0;
      const double x = isOnSample ? 40.5 : random.real(20.0, 70.0);
      const double y = isOnSample ? 52.5 : random.real(20.0, 70.0);
      constexpr std::size_t kCount = 3000;
      std::vector<double> angles(kCount);
      for (double& angle : angles) angle = random.real(0.0, 6.283185307179586);
      for (std::size_t i = 0; i < 8; ++i) angles[i] = 0.785398 * static_cast<double>(i); // no gap is wide
      std::sort(angles.begin(), angles.end());
      const auto rim = [&](std::size_t i) {
        const double angle = angles[i % kCount];
        return inPixels(kSide, kSide, x + reach * std::cos(angle), y + reach * std::sin(angle));
      };
      for (std::size_t i = 0; i < kCount; ++i) {
        fan.positions.insert(fan.positions.end(), {inPixels(kSide, kSide, x, y), rim(i), rim(i + 1)});
      }
      expectEverySampleOnce(fan, "a fan of reach " + std::to_string(reach));
    }
  }
}

// A floor from behind the eye to beyond the far plane, in random triangles: below the horizon's strip each sample once,
// above it none, and nowhere one twice. Triangles are cut by the near plane and by the guard band.
TEST(MeshTest, FloorsThatAreClippedCoverNoSampleTwice) {
  Random random(5);
  constexpr std::uint32_t kSide = 160;
  for (const std::uint32_t samples : {1U, 4U}) {
    for (const double extent : {30.0, 3000.0}) {
      CoverageFrame plane = gridMesh(random, samples, kSide, 17.0);
      for (Position& p : plane.positions) {
        const double x = p[0] * extent;
        const double z = p[1] * extent + 0.5 * extent; // depth in front of the eye
        p = {static_cast<float>(x), 1.0F, static_cast<float>((z - 0.01) * 1.01), static_cast<float>(z)};
        p[2] = static_cast<float>(z - 0.01) * (static_cast<float>(extent) / static_cast<float>(extent - 0.01));
      }
      for (const VitrailCpuInstructions instructions : instructionsHere()) {
        Raster raster(instructions);
        EXPECT_EQ(differences(coveredBy(raster, plane), coveredByRules(plane)), 0U) << nameOf(instructions);
      }
      Raster raster(VITRAIL_CPU_BEST);
      Picture picture(kSide, kSide, {});
      VitrailCpuFrame frame = picture.frame();
      frame.samples = samples;
      VitrailCpuDraw draw = drawOf(plane.positions);
      draw.blend = VITRAIL_BLEND_ADDITIVE;
      draw.color[0] = 1.0F;
      draw.color[3] = 1.0F;
      ASSERT_EQ(raster.render(frame, {&draw, 1}), VITRAIL_SUCCESS);
      std::size_t twice = 0;
      std::size_t missed = 0;
      std::size_t above = 0;
      for (std::uint32_t y = 0; y < kSide; ++y) {
        for (std::uint32_t x = 0; x < kSide; ++x) {
          const float value = picture.at(x, y)[0];
          twice += static_cast<std::size_t>(value > 1.0F);
          // The far plane ends the floor 1 / extent of half the picture below the horizon.
          const bool isFloor = y > kSide / 2 + static_cast<std::uint32_t>(80.0 / extent) + 1;
          missed += static_cast<std::size_t>(isFloor && value != 1.0F);
          above += static_cast<std::size_t>(y + 1 < kSide / 2 && value != 0.0F);
        }
      }
      EXPECT_EQ(twice, 0U) << samples << " samples";
      EXPECT_EQ(missed, 0U) << samples << " samples";
      EXPECT_EQ(above, 0U) << samples << " samples";
    }
  }
}

// ---- Clipped triangles

// New corners are rounded to floats and to 1/256 pixel far away, so edges move by fractions of a pixel.
TEST(ClippingTest, MovesEdgesLittle) {
  Random random(6);
  for (const bool isNear : {true, false}) {
    const char* const name = isNear ? "near plane" : "guard band";
    const CoverageFrame frame = isNear ? throughTheNearPlane(random) : beyondTheGuardBand(random);
    Raster raster(VITRAIL_CPU_BEST);
    EXPECT_EQ(differences(coveredBy(raster, frame), coveredByRules(frame)), 0U) << name;
    const Distances d = distancesOf(frame, coveredByRules);
    d.print(name);
    EXPECT_LT(d.farthest, 1.0 / 128.0) << name;
    EXPECT_GT(d.triangles, 700U) << name;
  }
}

} // namespace
} // namespace vitrail::tests::raster
