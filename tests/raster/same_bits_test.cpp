// The same frame has the same bits, whoever draws it and in whatever order: draws, threads, memory, parts.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <thread>

#include "scene.h"

namespace vitrail::tests::raster {
namespace {

// A host's own threads.
void onThreads(void* user, std::uint32_t count, void (*task)(void* data, std::uint32_t i), void* data) {
  ++*static_cast<std::uint32_t*>(user);
  std::vector<std::thread> threads;
  for (std::uint32_t i = 0; i < count; ++i) threads.emplace_back(task, data, i);
  for (std::thread& thread : threads) thread.join();
}

SceneOptions everything(std::uint32_t samples) {
  SceneOptions options;
  options.width = 150;
  options.height = 110;
  options.samples = samples;
  options.draws = 20;
  options.primitives = 40;
  options.hasFilters = options.hasDiscards = options.hasOpaque = options.hasDepth = true;
  options.hasOtherTopologies = options.hasPlanes = options.hasOddVertices = options.isClipped = true;
  return options;
}

class SameBitsTest : public testing::TestWithParam<std::uint32_t> {
 protected:
  Scene scene() const {
    Random random(20 + GetParam());
    return randomScene(random, everything(GetParam()));
  }
};

INSTANTIATE_TEST_SUITE_P(Samples, SameBitsTest, testing::Values(1U, 2U, 4U, 8U),
                         [](const auto& given) { return std::to_string(given.param); });

TEST_P(SameBitsTest, InAnyOrderOfDraws) {
  const Scene made = scene();
  Random random(21);
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions);
    const Drawn forward = draw(raster, made);
    std::vector<VitrailCpuDraw> draws = made.descs();
    std::reverse(draws.begin(), draws.end());
    EXPECT_TRUE(draw(raster, made, draws) == forward) << nameOf(instructions) << ", reversed";
    for (int i = 0; i < 4; ++i) {
      std::shuffle(draws.begin(), draws.end(), random.engine());
      EXPECT_TRUE(draw(raster, made, draws) == forward) << nameOf(instructions) << ", shuffled";
    }
  }
}

// Primitives in another order, each with its own colour by what it is and not by its number.
TEST_P(SameBitsTest, InAnyOrderOfTriangles) {
  Random random(22);
  constexpr std::size_t kTriangles = 3000;
  constexpr std::uint32_t kSide = 100;
  std::vector<std::array<Position, 3>> triangles(kTriangles);
  for (auto& triangle : triangles) {
    const double x = random.real(0.0, kSide);
    const double y = random.real(0.0, kSide);
    const float depth = 0.01F * static_cast<float>(random.below(100)); // many are at one depth
    for (Position& corner : triangle) {
      const double cornerX = x + random.real(-9.0, 9.0);
      corner = inPixels(kSide, kSide, cornerX, y + random.real(-9.0, 9.0), depth);
    }
  }
  const auto pictureOf = [&](Raster& raster) {
    std::vector<Position> positions;
    for (const auto& triangle : triangles) positions.insert(positions.end(), triangle.begin(), triangle.end());
    Picture picture(kSide, kSide, {0.2F, 0.4F, 0.6F, 1.0F});
    VitrailCpuFrame frame = picture.frame();
    frame.samples = GetParam();
    VitrailCpuDraw desc = drawOf(positions);
    desc.shade = [](void*, VitrailCpuFragments* f) {
      for (std::size_t i = 0; i < VITRAIL_CPU_LANES; ++i) {
        for (std::size_t c = 0; c < 4; ++c) f->color[c][i] = 0.1F + 0.2F * static_cast<float>(c) * f->second[i];
      }
    };
    EXPECT_EQ(raster.render(frame, {&desc, 1}), VITRAIL_SUCCESS);
    return picture.pixels;
  };
  Raster raster(VITRAIL_CPU_BEST);
  const std::vector<float> forward = pictureOf(raster);
  std::reverse(triangles.begin(), triangles.end());
  EXPECT_TRUE(pictureOf(raster) == forward);
  std::shuffle(triangles.begin(), triangles.end(), random.engine());
  EXPECT_TRUE(pictureOf(raster) == forward);
}

TEST_P(SameBitsTest, OnAnyNumberOfThreads) {
  const Scene made = scene();
  Raster one(VITRAIL_CPU_BEST, 1);
  const Drawn expected = draw(one, made);
  for (std::uint32_t threads = 2; threads <= 16; ++threads) {
    Raster raster(VITRAIL_CPU_BEST, threads);
    EXPECT_EQ(vitrailCpuContextThreads(raster.get()), threads);
    const Drawn drawn = draw(raster, made);
    EXPECT_TRUE(drawn == expected) << threads << " threads";
    EXPECT_EQ(drawn.stats.fragmentsRequested, expected.stats.fragmentsRequested) << threads << " threads";
    EXPECT_EQ(drawn.stats.layersMax, expected.stats.layersMax) << threads << " threads";
  }
}

TEST_P(SameBitsTest, OnTheHostsThreads) {
  const Scene made = scene();
  Raster one(VITRAIL_CPU_BEST, 1);
  const Drawn expected = draw(one, made);
  for (const std::uint32_t threads : {2U, 3U, 16U}) {
    std::uint32_t calls = 0;
    VitrailCpuContextDesc desc{};
    desc.threads = threads;
    desc.parallel = onThreads;
    desc.parallelUser = &calls;
    Raster raster(desc);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(draw(raster, made) == expected) << threads << " threads";
    EXPECT_GT(calls, 0U);
  }
}

// Tiles are cut into blocks, and blocks into windows of depth.
TEST_P(SameBitsTest, InAnyMemory) {
  Scene made = scene();
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions, 2);
    const Drawn expected = draw(raster, made);
    for (const std::uint64_t budget : {65536ULL, 80000ULL, 131072ULL, 500000ULL, 3000000ULL, 64000000ULL}) {
      const Drawn drawn = draw(raster, made, budget);
      EXPECT_TRUE(drawn == expected) << budget << " bytes, " << nameOf(instructions);
      EXPECT_EQ(drawn.stats.layersMax, expected.stats.layersMax) << budget << " bytes";
    }
  }
}

// Layers so deep that a single block does not fit, many of them at one depth.
TEST_P(SameBitsTest, OfDeepBlocksInAnyMemory) {
  Random random(23);
  for (const bool isFlat : {true, false}) {
    SceneOptions options;
    options.width = 9;
    options.height = 6;
    options.samples = GetParam();
    options.draws = 60;
    options.primitives = 60;
    options.isFlat = isFlat;
    options.hasFilters = options.hasDiscards = true;
    Scene made = randomScene(random, options);
    for (const auto& each : made.draws) { // faint, so that light reaches all of them
      each->desc.color[3] *= 0.05F;
      each->material.color[3] *= 0.05F;
      each->material.other[3] *= 0.05F;
      for (std::size_t v = 0; v < each->vertices.size() && random.below(3) == 0; v += 4) {
        each->vertices[v + 2] = 0.5F * each->vertices[v + 3];
      }
    }
    for (const VitrailCpuInstructions instructions : instructionsHere()) {
      Raster raster(instructions, 1);
      const Drawn expected = draw(raster, made);
      for (const std::uint64_t budget : {65536ULL, 100000ULL, 200000ULL, 400000ULL}) {
        EXPECT_TRUE(draw(raster, made, budget) == expected) << budget << " bytes, " << nameOf(instructions);
      }
    }
  }
}

// Memory is kept from frame to frame: what was in it must not show.
TEST(SameBitsOfFramesTest, WhateverWasDrawnBefore) {
  Random random(24);
  Raster kept(VITRAIL_CPU_BEST, 2);
  for (int i = 0; i < 60; ++i) {
    SceneOptions options = everything(1U << random.below(4));
    options.width = 1 + random.below(200);
    options.height = 1 + random.below(100);
    options.draws = random.below(12);
    options.hasDepth = random.below(2) == 0;
    options.hasOpaque = random.below(2) == 0;
    options.hasFilters = random.below(2) == 0;
    options.isFlat = random.below(3) == 0;
    options.hasSampleColors = options.samples > 1 && random.below(2) == 0;
    const Scene made = randomScene(random, options);
    const std::uint64_t budget = random.below(3) == 0 ? 65536 : 0;
    Raster fresh(VITRAIL_CPU_BEST, 1);
    ASSERT_TRUE(draw(kept, made, budget) == draw(fresh, made)) << "frame " << i;
  }
}

// Frames alike but for how many draws they have share it most of all.
TEST(SameBitsOfFramesTest, HoweverManyDrawsThereWere) {
  Random random(26);
  for (const bool isFlat : {true, false}) {
    Raster kept(VITRAIL_CPU_BEST, 2);
    for (const std::uint32_t draws : {2U, 9U, 1U, 30U, 5U}) {
      SceneOptions options;
      options.isFlat = isFlat;
      options.isShaded = !isFlat;
      options.draws = draws;
      const Scene made = randomScene(random, options);
      Raster fresh(VITRAIL_CPU_BEST, 1);
      EXPECT_TRUE(draw(kept, made) == draw(fresh, made)) << draws << " draws, " << (isFlat ? "flat" : "shaded");
    }
  }
}

double srgbOfDrawn(double v) {
  const double clamped = std::clamp(v, 0.0, 1.0);
  return clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * std::pow(clamped, 1.0 / 2.4) - 0.055;
}

// Between instruction sets a sum may be rounded otherwise: depths that are as good as equal may change places, which
// shows as far as their colours differ, so those scenes have each surface at a depth of its own.
TEST_P(SameBitsTest, ButForRoundingWithOtherInstructions) {
  Random random(25);
  SceneOptions options = everything(GetParam());
  options.isClipped = options.hasPlanes = false;
  Scene made = randomScene(random, options);
  float depth = 0.0F;
  for (const auto& each : made.draws) {
    depth += 0.04F;
    const std::uint32_t components = each->desc.components == 0 ? 4 : each->desc.components;
    const std::size_t stride = each->desc.vertexStride == 0 ? components : each->desc.vertexStride / sizeof(float);
    for (std::size_t v = 0; v < each->vertices.size(); v += stride) {
      each->vertices[v + 2] = components == 3 ? depth : depth * each->vertices[v + 3];
    }
    each->desc.transform = nullptr;
    each->desc.model = nullptr;
  }
  for (float& value : made.depth) value = 0.04F * std::floor(value * 25.0F) + 0.02F;
  Raster best(VITRAIL_CPU_BEST, 1);
  const Drawn expected = draw(best, made);
  for (const VitrailCpuInstructions instructions : instructionsHere()) {
    Raster raster(instructions, 1);
    const Drawn drawn = draw(raster, made);
    double most = 0.0;
    for (std::size_t i = 0; i < drawn.pixels.size(); ++i) {
      most = std::max(most, std::fabs(srgbOfDrawn(drawn.pixels[i]) - srgbOfDrawn(expected.pixels[i])));
    }
    EXPECT_LT(most, 1.0 / 255.0) << nameOf(instructions);
    EXPECT_EQ(drawn.stats.fragmentsRequested, expected.stats.fragmentsRequested) << nameOf(instructions);
  }
}

} // namespace
} // namespace vitrail::tests::raster
