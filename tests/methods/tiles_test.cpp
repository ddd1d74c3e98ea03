// The method tiles where others do not have to be tested: that its rasteriser covers what the device's does, that lists
// of any length come out right, and that neither the order of triangles nor the memory that it has changes a bit.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "../../tool/methods/methods.h"
#include "../../tool/scene/builtin/builtin.h"
#include "../reference/test_scenes.h"
#include "../thorough.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::straightView;
using reference::unlitMaterial;
using reference::wideView;

MethodOptions methodNamed(const std::string& name) {
  MethodOptions options;
  options.name = name;
  return options;
}

// Numbers from 0 to below 1, the same in every run.
class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : state_(seed * 2654435761U + 1U) {}
  float next() {
    state_ ^= state_ << 13U;
    state_ ^= state_ >> 17U;
    state_ ^= state_ << 5U;
    return static_cast<float>(state_ >> 8U) / 16777216.0F;
  }
  float between(float low, float high) { return low + (high - low) * next(); }
  float whole(int low, int high) {
    return static_cast<float>(low) + std::floor(next() * static_cast<float>(high - low + 1));
  }

 private:
  std::uint32_t state_;
};

constexpr std::uint32_t kCoverageSide = 128;
constexpr std::size_t kFewPixels = 16; // a thousandth

// Triangles whose light adds up, in objects of different colours: whole numbers, which 16-bit floats add without
// rounding. Whoever covers a pixel by another triangle most likely gets another sum.
class AddedTriangles {
 public:
  explicit AddedTriangles(std::uint32_t seed) : numbers(seed) {}

  void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    Mesh& mesh = meshes_.at(next_++ % kObjects);
    for (const glm::vec3& position : {a, b, c}) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(position);
    }
  }
  // In pixels of a straight view.
  void addPixels(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
    const auto placed = [this](const glm::vec2& p) {
      constexpr float kHalf = kCoverageSide / 2.0F;
      return glm::vec3(p.x / kHalf - 1.0F, 1.0F - p.y / kHalf, numbers.between(-8.0F, 8.0F));
    };
    add(placed(a), placed(b), placed(c));
  }

  Scene scene() const {
    Scene scene;
    Numbers colors(1);
    for (std::uint32_t i = 0; i < kObjects; ++i) {
      Material material = unlitMaterial({colors.whole(1, 9), colors.whole(1, 9), colors.whole(1, 9), 1.0F});
      material.blend = BlendMode::Additive;
      scene.materials.push_back(material);
      scene.meshes.push_back(meshes_.at(i));
      scene.draws.push_back({.mesh = i, .material = i});
    }
    return scene;
  }

  Numbers numbers;

 private:
  static constexpr std::uint32_t kObjects = 23;
  std::array<Mesh, kObjects> meshes_;
  std::uint32_t next_ = 0;
};

RenderOptions sumsOf(const View& view) {
  RenderOptions picture;
  picture.width = picture.height = kCoverageSide;
  picture.view = view;
  picture.background.srgb = glm::vec3(0.0F);
  picture.encoding = Encoding::Linear;
  return picture;
}

class TilesTest : public GpuTest {
 protected:
  static RenderResult draw(const std::string& name, const Scene& scene, const RenderOptions& picture,
                           DrawOrder order = DrawOrder::Forward) {
    return renderOnce(gpu(), scene, picture, {}, order, methodNamed(name));
  }

  static bool onCpu() { return gpu().properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }

  // How many pixels have other sums than the device's rasteriser gives them.
  static std::size_t differentSums(const Scene& scene, const View& view) {
    const RenderOptions picture = sumsOf(view);
    const DeepPicture drawn = draw("tiles", scene, picture).deep;
    const DeepPicture expected = draw("unsorted", scene, picture).deep;
    std::size_t different = 0;
    std::size_t covered = 0;
    for (std::size_t i = 0; i < expected.rgba.size(); i += 4) {
      different += std::equal(&drawn.rgba[i], &drawn.rgba[i] + 3, &expected.rgba[i]) ? 0 : 1;
      covered += expected.rgba[i] != 0 ? 1 : 0;
    }
    EXPECT_GT(covered, kCoverageSide) << "the test covers hardly anything";
    return different;
  }
};

// All within the picture: drivers may clip others, and round where they do.
TEST_F(TilesTest, SmallTrianglesCoverWhatTheDeviceCovers) {
  for (const float size : {0.7F, 2.0F, 6.0F, 20.0F}) {
    AddedTriangles triangles(static_cast<std::uint32_t>(size * 10.0F));
    const int count = size < 3.0F ? 20000 : size < 10.0F ? 4000 : 600;
    for (int i = 0; i < count; ++i) {
      const glm::vec2 at(triangles.numbers.between(size, 128.0F - size),
                         triangles.numbers.between(size, 128.0F - size));
      const auto corner = [&] {
        return at + glm::vec2(triangles.numbers.between(-size, size), triangles.numbers.between(-size, size));
      };
      const glm::vec2 a = corner();
      const glm::vec2 b = corner();
      triangles.addPixels(a, b, corner());
    }
    EXPECT_EQ(differentSums(triangles.scene(), straightView()), 0U) << "of about " << size << " pixels";
  }
}

// Corners and edges on the middles of pixels and on the grid of 1/256: there the rules for ties decide.
TEST_F(TilesTest, TiesAreTheDevices) {
  for (const float grid : {0.5F, 1.0F / 16.0F, 1.0F / 256.0F}) {
    AddedTriangles triangles(static_cast<std::uint32_t>(1.0F / grid));
    for (int i = 0; i < 8000; ++i) {
      const glm::vec2 at(triangles.numbers.whole(12, 116), triangles.numbers.whole(12, 116));
      const auto corner = [&] {
        const auto steps = static_cast<int>(4.0F / grid);
        return at + grid * glm::vec2(triangles.numbers.whole(-steps, steps), triangles.numbers.whole(-steps, steps));
      };
      const glm::vec2 a = corner();
      const glm::vec2 b = i % 4 == 0 ? a + glm::vec2(triangles.numbers.whole(-8, 8), 0.0F) : corner();
      triangles.addPixels(a, b, i % 8 == 1 ? a + glm::vec2(0.0F, triangles.numbers.whole(-8, 8)) : corner());
    }
    EXPECT_EQ(differentSums(triangles.scene(), straightView()), 0U) << "on a grid of " << grid;
  }
}

TEST_F(TilesTest, SliversCoverWhatTheDeviceCovers) {
  AddedTriangles triangles(5);
  for (int i = 0; i < 1500; ++i) { // two corners hardly apart
    Numbers& numbers = triangles.numbers;
    const glm::vec2 at(numbers.between(1.0F, 127.0F), numbers.between(1.0F, 127.0F));
    const glm::vec2 near = at + glm::vec2(numbers.whole(-3, 3), numbers.whole(-3, 3)) / 256.0F;
    triangles.addPixels(at, near, {numbers.between(0.0F, 128.0F), numbers.between(0.0F, 128.0F)});
  }
  EXPECT_EQ(differentSums(triangles.scene(), straightView()), 0U);
}

// Drivers clip them or not, and what they clip they round.
TEST_F(TilesTest, LargeTrianglesCoverWhatTheDeviceCovers) {
  AddedTriangles triangles(6);
  for (int i = 0; i < 60; ++i) {
    const float reach = std::pow(10.0F, triangles.numbers.between(2.0F, 3.5F));
    const auto corner = [&] {
      return glm::vec2(triangles.numbers.between(-reach, reach), triangles.numbers.between(-reach, reach));
    };
    const glm::vec2 a = corner();
    const glm::vec2 b = corner();
    triangles.addPixels(a, b, corner());
  }
  EXPECT_LE(differentSums(triangles.scene(), straightView()), kFewPixels);
}

// All around the eye: triangles are cut by the near plane, and reach far beyond the picture. Where a cut lies is
// rounded, by the device and here in its own way.
TEST_F(TilesTest, TrianglesAroundTheEyeCoverWhatTheDeviceCovers) {
  AddedTriangles inFront(7);
  AddedTriangles around(8);
  for (int i = 0; i < 1200; ++i) {
    AddedTriangles& triangles = i % 2 == 0 ? inFront : around;
    Numbers& numbers = triangles.numbers;
    const auto corner = [&] {
      const float z = i % 2 == 0 ? numbers.between(-40.0F, -1.0F) : numbers.between(-6.0F, 3.0F);
      const float wide = std::abs(z) + 1.0F;
      return glm::vec3(numbers.between(-wide, wide), numbers.between(-wide, wide), z);
    };
    const glm::vec3 a = corner();
    const glm::vec3 b = i % 2 == 0 ? a + 2.0F * glm::vec3(numbers.next(), numbers.next(), 0.0F) : corner();
    triangles.add(a, b, i % 2 == 0 ? a + 2.0F * glm::vec3(-numbers.next(), numbers.next(), 0.0F) : corner());
    if (i % 2 == 1 && i > 120) break;
  }
  EXPECT_EQ(differentSums(inFront.scene(), wideView()), 0U);
  EXPECT_LE(differentSums(around.scene(), wideView()), kFewPixels);
}

// ---- Deep pixels

// Sheets over the whole picture, the front half of one colour and the back half of another, in any order.
Scene sheets(std::uint32_t count, float alpha) {
  Scene scene;
  Mesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto place = static_cast<std::uint32_t>(std::uint64_t{i} * 7919U % count); // a prime: no two the same
    const float z = -8.0F + 16.0F * static_cast<float>(place) / static_cast<float>(count);
    const bool front = place >= count / 2;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec2& corner :
         {glm::vec2(-3.0F), glm::vec2(3.0F, -3.0F), glm::vec2(3.0F), glm::vec2(-3.0F, 3.0F)}) {
      mesh.positions.emplace_back(corner, z);
      mesh.colors.push_back(packColor(front ? glm::vec4(1.0F, 0.0F, 0.0F, 1.0F) : glm::vec4(0.0F, 1.0F, 0.0F, 1.0F)));
    }
    for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.indices.push_back(first + corner);
  }
  scene.meshes.push_back(std::move(mesh));
  scene.materials.push_back(unlitMaterial({1.0F, 1.0F, 1.0F, alpha}));
  scene.draws.push_back({.mesh = 0, .material = 0});
  return scene;
}

void expectSheets(const RenderResult& result, std::uint32_t count, float alpha) {
  const double half = std::pow(1.0 - static_cast<double>(alpha), count / 2);
  const std::array<double, 3> linear{1.0 - half + half * half, half * (1.0 - half) + half * half,
                                     half * half}; // on white
  for (std::size_t i = 0; i < result.picture.rgba.size(); ++i) {
    if (i % 4 == 3) continue;
    const double value = linear.at(i % 4);
    const double srgb = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
    ASSERT_NEAR(result.picture.rgba[i], 255.0 * srgb, 1.0) << "channel " << i % 4 << " of pixel " << i / 4;
  }
  EXPECT_TRUE(result.report.complete);
}

// Keys in registers, once and again; a tile that takes too many turns, one whose chunks are merged, many dispatches.
TEST_F(TilesTest, PixelsOfAnyDepthAreRight) {
  struct Depth {
    std::uint32_t count;
    float alpha;
    std::uint32_t side;
  };
  for (const Depth& depth : {Depth{24, 0.0625F, 21}, Depth{300, 0.0078125F, 13}, Depth{1100, 0.001953125F, 6},
                             Depth{5000, 0.00048828125F, 3}, Depth{100000, 0.0000152587890625F, 3}}) {
    if ((depth.count == 1100 || depth.count == 5000) && !tests::isThorough()) continue;
    SCOPED_TRACE(std::to_string(depth.count) + " sheets");
    RenderOptions picture;
    picture.width = picture.height = depth.side;
    picture.view = straightView();
    expectSheets(draw("tiles", sheets(depth.count, depth.alpha), picture), depth.count, depth.alpha);
  }
}

// Each covers one pixel of the tile, all at depths of their own.
TEST_F(TilesTest, ATileWithAMillionTrianglesIsRight) {
  const std::uint32_t onCpus = tests::isThorough() ? 1U << 18U : 1U << 16U; // takes their drivers long
  const std::uint32_t count = onCpu() ? onCpus : 1U << 20U;
  constexpr float kAlpha = 1.0F / 32768.0F;
  Scene scene;
  Mesh mesh;
  std::array<std::uint32_t, 64> counts{};
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t pixel = i * 2654435761U >> 26U;
    ++counts.at(pixel);
    const glm::vec2 middle(static_cast<float>(pixel % 8) + 0.5F, static_cast<float>(pixel / 8) + 0.5F);
    const float z = 8.0F - 16.0F * static_cast<float>(i) / static_cast<float>(count);
    for (const glm::vec2& corner : {glm::vec2(-0.3F, -0.3F), glm::vec2(0.3F, -0.3F), glm::vec2(0.0F, 0.4F)}) {
      const glm::vec2 place = (middle + corner) / 4.0F - 1.0F;
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.emplace_back(place.x, -place.y, z);
    }
  }
  scene.meshes.push_back(std::move(mesh));
  scene.materials.push_back(unlitMaterial({0.0F, 0.0F, 0.0F, kAlpha}));
  scene.draws.push_back({.mesh = 0, .material = 0});
  RenderOptions picture;
  picture.width = picture.height = 8;
  picture.view = straightView();
  const RenderResult result = draw("tiles", scene, picture);
  for (std::size_t pixel = 0; pixel < 64; ++pixel) {
    const double left = std::pow(1.0 - static_cast<double>(kAlpha), counts.at(pixel));
    EXPECT_NEAR(result.picture.rgba[4 * pixel], 255.0 * (1.055 * std::pow(left, 1.0 / 2.4) - 0.055), 1.0) << pixel;
  }
}

// Long triangles across each other, many turns deep.
Scene crossing(std::uint32_t count) {
  Scene scene;
  Mesh mesh;
  Numbers numbers(11);
  for (std::uint32_t i = 0; i < count; ++i) {
    const float angle = numbers.between(0.0F, 6.28F);
    const glm::vec3 along(std::cos(angle), std::sin(angle), 0.0F);
    const glm::vec3 across(-along.y, along.x, 0.0F);
    const glm::vec4 color(numbers.next(), numbers.next(), numbers.next(), 1.0F);
    // Steep: within a tile they reach from the front of the scene to its back.
    for (const glm::vec3& corner : {-9.0F * along - 9.0F * across + glm::vec3(0.0F, 0.0F, -8.0F),
                                    9.0F * along - 9.0F * across + glm::vec3(0.0F, 0.0F, 8.0F),
                                    9.0F * across + glm::vec3(0.0F, 0.0F, numbers.between(-1.0F, 1.0F))}) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(corner * glm::vec3(0.25F, 0.25F, 1.0F));
      mesh.colors.push_back(packColor(color));
    }
  }
  scene.meshes.push_back(std::move(mesh));
  scene.materials.push_back(unlitMaterial({1.0F, 1.0F, 1.0F, 0.05F}));
  scene.draws.push_back({.mesh = 0, .material = 0});
  return scene;
}

TEST_F(TilesTest, ManySurfacesThatCrossInOneTileAreRight) {
  RenderOptions picture;
  picture.width = picture.height = 24;
  picture.view = straightView();
  const Scene scene = crossing(200);
  const RenderResult drawn = draw("tiles", scene, picture);
  EXPECT_LE(largestDifference(drawn.picture, draw("linked-list", scene, picture).picture), 1);
  for (const DrawOrder order : {DrawOrder::Reversed, DrawOrder::Shuffled}) {
    EXPECT_TRUE(draw("tiles", scene, picture, order).picture.rgba == drawn.picture.rgba);
  }
}

// ---- Order

// `count` panes in one plane, of different colours and ways to blend; some are the same twice.
Scene onePlane(std::uint32_t count) {
  Scene scene;
  Numbers numbers(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    Material material = unlitMaterial({numbers.next(), numbers.next(), numbers.next(), numbers.between(0.1F, 0.6F)});
    if (i % 5 == 1) material.blend = BlendMode::Additive;
    if (i % 5 == 2) {
      material.unlit = false;
      material.metallic = 0.0F;
      material.transmission = 0.8F;
    }
    const float low = numbers.between(-0.9F, -0.3F);
    addRectangle(scene, {glm::vec2(low), glm::vec2(-low + 0.3F, 0.8F), 0.0F}, material);
    if (i % 4 == 0) scene.draws.push_back(scene.draws.back());
  }
  return scene;
}

TEST_F(TilesTest, SurfacesInOnePlaneHaveAnOrderOfTheirOwn) {
  for (const std::uint32_t count : {3U, 10U, 40U, 80U}) {
    if ((count == 10 || count == 80) && !tests::isThorough()) continue;
    SCOPED_TRACE(std::to_string(count) + " panes");
    RenderOptions picture;
    picture.width = 48;
    picture.height = 32;
    picture.view = straightView();
    const Scene scene = onePlane(count);
    const RenderResult forward = draw("tiles", scene, picture);
    for (const DrawOrder order : {DrawOrder::Reversed, DrawOrder::Shuffled}) {
      EXPECT_TRUE(draw("tiles", scene, picture, order).picture.rgba == forward.picture.rgba);
    }
    // More than so many have another order than in fragment lists.
    if (count < 16) {
      EXPECT_LE(largestDifference(forward.picture, draw("linked-list", scene, picture).picture), 1);
    }
    // More than registers hold are all collected.
    if (count >= 40) {
      EXPECT_TRUE(std::ranges::any_of(forward.report.passesMs, [](const auto& pass) { return pass.first == "sort"; }));
    }
  }
}

// So many in one plane as only the largest kernel keeps, in the tiles of which there are many other triangles.
TEST_F(TilesTest, SurfacesInOnePlaneAmongManyTriangles) {
  Scene scene = onePlane(20);
  const std::uint32_t dust = static_cast<std::uint32_t>(scene.materials.size());
  // Large enough for tiles that are deep in the mean, which keep as many fragments of a pixel as lie in the plane.
  addRectangle(scene, {{-0.3F, -0.3F}, {0.3F, 0.3F}, 0.5F}, unlitMaterial({0.2F, 0.9F, 0.4F, 0.02F}));
  ASSERT_EQ(scene.materials.size(), dust + 1);
  const Draw first = scene.draws.back();
  Numbers numbers(7);
  for (int i = 0; i < 1500; ++i) {
    scene.draws.push_back(first);
    scene.draws.back().transform = glm::translate(
        glm::mat4(1.0F), {numbers.between(-1.0F, 1.0F), numbers.between(-1.0F, 1.0F), numbers.between(-0.9F, 0.4F)});
  }
  RenderOptions picture;
  picture.width = picture.height = 16;
  picture.view = straightView();
  const RenderResult forward = draw("tiles", scene, picture);
  for (const DrawOrder order : {DrawOrder::Reversed, DrawOrder::Shuffled}) {
    EXPECT_TRUE(draw("tiles", scene, picture, order).picture.rgba == forward.picture.rgba);
  }
  // Registers held them.
  EXPECT_TRUE(std::ranges::none_of(forward.report.passesMs, [](const auto& pass) { return pass.first == "sort"; }));
  // None is missing: what only adds light has no order.
  for (Material& material : scene.materials) {
    material.blend = BlendMode::Additive;
    material.transmission = 0.0F;
    material.unlit = true; // as in other tests, which have such kernels
    for (int c = 0; c < 3; ++c) material.baseColor[c] *= 0.2F;
  }
  picture.background.srgb = glm::vec3(0.0F);
  const Picture added = draw("tiles", scene, picture).picture;
  EXPECT_LE(largestDifference(added, draw("linked-list", scene, picture).picture), 1);
}

TEST_F(TilesTest, EverySceneIsTheSameInEveryOrder) {
  for (const std::string name : {"mannequins", "hairball", "smoke"}) {
    if (name == "mannequins" && !tests::isThorough()) continue; // the hairball is lit, too
    SCOPED_TRACE(name);
    BuiltinOptions options;
    if (name == "hairball") options.count = 600;
    if (name == "mannequins") options.count = 4;
    const Scene scene = makeBuiltinScene(name, options);
    const RenderOptions picture = usualOptions(scene, 64, 36);
    const Picture forward = draw("tiles", scene, picture).picture;
    EXPECT_TRUE(draw("tiles", scene, picture, DrawOrder::Reversed).picture.rgba == forward.rgba);
    EXPECT_TRUE(draw("tiles", scene, picture, DrawOrder::Shuffled).picture.rgba == forward.rgba);
  }
}

// Which thread gets which place differs from frame to frame, and must not show.
TEST_F(TilesTest, ManyFramesAreOne) {
  BuiltinOptions options;
  options.count = 250;
  const Scene hairball = makeBuiltinScene("hairball", options);
  const Scene plane = onePlane(120);
  RenderOptions planePicture;
  planePicture.width = 24;
  planePicture.height = 16;
  planePicture.view = straightView();
  for (const auto& [scene, picture] :
       {std::pair(&hairball, usualOptions(hairball, 48, 32)), std::pair(&plane, planePicture)}) {
    const std::unique_ptr<Renderer> renderer = rendererOf(gpu(), *scene, {}, DrawOrder::Forward, methodNamed("tiles"));
    const Picture first = renderer->render(picture).picture;
    const int frames = onCpu() ? 8 : 50; // few threads leave little to chance
    for (int frame = 1; frame < (tests::isThorough() ? 5 * frames : frames); ++frame) {
      ASSERT_TRUE(renderer->render(picture).picture.rgba == first.rgba) << "frame " << frame;
    }
  }
}

// ---- Memory

// What tests draw that need pipelines of their own: an unlit scene has smaller ones.
std::string lightlyShaded() { return tests::isThorough() ? "spheres" : "planes"; }

TEST_F(TilesTest, BudgetsDoNotChangeABit) {
  BuiltinOptions options;
  options.count = 32;
  const Scene spheres = makeBuiltinScene("spheres", options);
  // More turns than any device gives blending, and where first pages are large more than those hold.
  const Scene deep = sheets(onCpu() ? 3000 : 5000, 0.001953125F);
  RenderOptions deepPicture;
  deepPicture.width = 8;
  deepPicture.height = tests::isThorough() ? 24 : 16;
  deepPicture.view = straightView();
  for (const auto& [scene, whole, part] :
       {std::tuple(&spheres, usualOptions(spheres, 128, 72), 64), std::tuple(&deep, deepPicture, 2)}) {
    const std::unique_ptr<Renderer> renderer = rendererOf(gpu(), *scene, {}, DrawOrder::Forward, methodNamed("tiles"));
    const RenderResult expected = renderer->render(whole);
    EXPECT_EQ(expected.report.tiles, 1U);
    RenderOptions bounded = whole;
    bounded.memoryBudget = expected.report.nodesBytes / part;
    const RenderResult drawn = renderer->render(bounded);
    EXPECT_GT(drawn.report.tiles, 1U) << *bounded.memoryBudget << " bytes";
    EXPECT_LE(drawn.report.nodesBytes, *bounded.memoryBudget);
    // What all frames have, and the vertices in clip space, come on top.
    EXPECT_EQ(drawn.report.totalBytes - drawn.report.nodesBytes,
              expected.report.totalBytes - expected.report.nodesBytes);
    EXPECT_TRUE(drawn.picture.rgba == expected.picture.rgba);
    EXPECT_TRUE(renderer->render(whole).picture.rgba == expected.picture.rgba);
    bounded.memoryBudget = 65536;
    try {
      renderer->render(bounded);
    } catch (const GpuError& error) {
      const std::string reason = error.what();
      EXPECT_NE(reason.find("--memory-budget"), std::string::npos) << reason;
      EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
    }
  }
}

// More vertices than shaders of small devices reach in clip space, most of which no triangle has: those that are there
// are transformed for each triangle and fragment.
TEST_F(TilesTest, VerticesThatHaveNoRoomInClipSpaceAreRight) {
  constexpr std::size_t kVertices = (std::size_t{1} << 20U) + 1; // of 16 bytes and 8 objects: more than 128 MiB
  BuiltinOptions options;
  options.count = 8;
  Scene scene = makeBuiltinScene(lightlyShaded(), options);
  constexpr std::uint64_t kBytes = 8 * kVertices * 16;
  const VkDeviceSize range = gpu().properties().limits.maxStorageBufferRange;
  if (range >= kBytes && gpu().localMemory() / 16 >= kBytes) GTEST_SKIP() << "there is room for so many";
  const RenderOptions picture = usualOptions(scene, 96, 54);
  const Picture expected = draw("tiles", scene, picture).picture;
  for (Mesh& mesh : scene.meshes) {
    const auto pad = [](auto& values) {
      if (!values.empty()) values.resize(kVertices, values.back());
    };
    pad(mesh.positions);
    pad(mesh.normals);
    mesh.tangents.clear();
    mesh.texCoords0.clear();
    mesh.texCoords1.clear();
  }
  const RenderResult drawn = draw("tiles", scene, picture);
  EXPECT_LE(largestDifference(drawn.picture, expected), 1);
  EXPECT_LT(drawn.report.totalBytes - drawn.report.nodesBytes, kBytes); // they were not put there
}

// ---- Several samples

TEST_F(TilesTest, SeveralSamplesAreThoseOfLists) {
  for (const std::uint32_t samples : {2U, 4U, 8U}) {
    if ((gpu().features().sampleCounts & samples) == 0) continue;
    SCOPED_TRACE(std::to_string(samples) + " samples");
    MethodOptions tiles = methodNamed("tiles");
    MethodOptions lists = methodNamed("linked-list");
    tiles.samples = lists.samples = samples;
    RenderOptions small;
    small.width = small.height = 9;
    small.view = straightView();
    constexpr std::uint32_t kSheets = 600;
    constexpr float kAlpha = 0.001953125F;
    expectSheets(renderOnce(gpu(), sheets(kSheets, kAlpha), small, {}, DrawOrder::Forward, tiles), kSheets, kAlpha);
    const Scene scene = makeBuiltinScene("interlocked", {});
    const RenderOptions picture = usualOptions(scene, 96, 64);
    const Picture drawn = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, tiles).picture;
    const Picture expected = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, lists).picture;
    std::size_t different = 0;
    for (std::size_t i = 0; i < drawn.rgba.size(); ++i)
      different += std::abs(drawn.rgba[i] - expected.rgba[i]) > 1 ? 1 : 0;
    EXPECT_LE(different, drawn.rgba.size() / 500) << "at crossings and edges depths are rounded in other ways";
    for (const DrawOrder order : {DrawOrder::Reversed, DrawOrder::Shuffled}) {
      EXPECT_TRUE(renderOnce(gpu(), scene, picture, {}, order, tiles).picture.rgba == drawn.rgba);
    }
  }
}

// ---- What cuts

TEST_F(TilesTest, ClipPlanesCutAsElsewhere) {
  BuiltinOptions options;
  options.count = 8;
  Scene scene = makeBuiltinScene(lightlyShaded(), options);
  scene.clipPlanes.emplace_back(0.3F, 1.0F, 0.2F, 0.05F);
  scene.clipPlanes.emplace_back(-1.0F, 0.1F, 0.0F, 0.3F);
  const RenderOptions picture = usualOptions(scene, 120, 90);
  const Picture drawn = draw("tiles", scene, picture).picture;
  const Picture expected = draw("linked-list", scene, picture).picture;
  std::size_t different = 0;
  for (std::size_t i = 0; i < drawn.rgba.size(); ++i)
    different += std::abs(drawn.rgba[i] - expected.rgba[i]) > 1 ? 1 : 0;
  EXPECT_LE(different, drawn.rgba.size() / 1000) << "the cuts are rounded in other ways";
  scene.clipPlanes.clear();
  EXPECT_GT(largestDifference(drawn, draw("tiles", scene, picture).picture), 30) << "nothing is cut";
}

} // namespace
} // namespace vitrail::tool::test
