// The raster's calls, with a host that is not the tool: every form of draws, depths and indices gives the picture that
// follows by hand; frames that have no room say so, and the next ones have it; what is wrong is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "../../thorough.h"
#include "raster_host.h"

namespace vitrail::tests::vulkan {
namespace {

// ---- Scenes of rectangles whose borders are those of pixels

struct Rectangle {
  std::uint32_t left, top, right, bottom; // pixels, without the right and bottom ones
  float depth;                            // 0 is nearest
  Vec4 color;
  VitrailBlend blend = VITRAIL_BLEND_OVER;
};

constexpr std::uint32_t kSide = 32; // of most pictures

float place(std::uint32_t pixel, std::uint32_t size) {
  return 2.0F * static_cast<float>(pixel) / static_cast<float>(size) - 1.0F;
}

// Rectangles that overlap in many ways, each at a depth of its own.
std::vector<Rectangle> someRectangles(std::uint32_t count, std::uint32_t side = kSide) {
  std::mt19937 random(7);
  const auto whole = [&](std::uint32_t least, std::uint32_t most) {
    return least + static_cast<std::uint32_t>(random() % (most - least + 1));
  };
  std::vector<Rectangle> rectangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t left = whole(0, side - 2);
    const std::uint32_t top = whole(0, side - 2);
    const auto channel = [&] { return static_cast<float>(whole(0, 16)) / 16.0F; };
    rectangles.push_back({left,
                          top,
                          whole(left + 1, side),
                          whole(top + 1, side),
                          static_cast<float>(i + 1) / static_cast<float>(count + 1),
                          {channel(), channel(), channel(), static_cast<float>(whole(1, 7)) / 8.0F}});
  }
  std::ranges::shuffle(rectangles, random);
  return rectangles;
}

void addQuad(RasterScene& scene, const Rectangle& r, std::uint32_t side, bool nearestIsOne) {
  const float depth = nearestIsOne ? 1.0F - r.depth : r.depth;
  for (const std::uint32_t y : {r.top, r.bottom}) {
    for (const std::uint32_t x : {r.left, r.right}) {
      scene.vertices.push_back({place(x, side), place(y, side), depth, 1.0F});
    }
  }
}

// How the rectangles become draws.
enum class Form : std::uint8_t { Indices, VertexOffsets, FirstIndices, NoIndices, Instances };

RasterScene sceneOf(const std::vector<Rectangle>& rectangles, Form form, bool nearestIsOne = false,
                    std::uint32_t side = kSide) {
  constexpr std::uint32_t kCorners[] = {0, 1, 2, 1, 3, 2};
  RasterScene scene;
  for (std::uint32_t i = 0; i < rectangles.size(); ++i) {
    const Rectangle& r = rectangles[i];
    VitrailVkRasterDraw draw{};
    draw.count = 6;
    draw.instanceCount = 1;
    draw.blend = r.blend;
    draw.word = i;
    scene.colors.push_back(r.color);
    const auto firstVertex = static_cast<std::uint32_t>(scene.vertices.size());
    if (form == Form::NoIndices) {
      RasterScene quad;
      addQuad(quad, r, side, nearestIsOne);
      for (const std::uint32_t corner : kCorners) scene.vertices.push_back(quad.vertices[corner]);
      draw.vertexCount = 6;
      draw.vertexOffset = static_cast<std::int32_t>(firstVertex);
      draw.firstIndex = 77;               // which nobody looks at
    } else if (form == Form::Instances) { // one square for all, shifted: only its first corner moves
      addQuad(scene, {0, 0, r.right - r.left, r.bottom - r.top, 0.0F, {}}, side, false);
      scene.shifts.push_back({2.0F * static_cast<float>(r.left) / static_cast<float>(side),
                              2.0F * static_cast<float>(r.top) / static_cast<float>(side),
                              nearestIsOne ? 1.0F - r.depth : r.depth, 0.0F});
      draw.firstInstance = i;
      draw.vertexOffset = static_cast<std::int32_t>(firstVertex);
      draw.vertexCount = 4;
    } else {
      addQuad(scene, r, side, nearestIsOne);
      draw.vertexCount = 4;
      if (form == Form::VertexOffsets) draw.vertexOffset = static_cast<std::int32_t>(firstVertex);
      if (form != Form::VertexOffsets) draw.vertexCount = firstVertex + 4;
    }
    if (form == Form::Indices || form == Form::FirstIndices) {
      draw.firstIndex = static_cast<std::uint32_t>(scene.indices.size());
      for (const std::uint32_t corner : kCorners) scene.indices.push_back(firstVertex + corner);
    }
    scene.draws.push_back(draw);
  }
  if (form == Form::VertexOffsets || form == Form::Instances) {
    scene.indices.assign(std::begin(kCorners), std::end(kCorners));
  }
  scene.behind = {0.25F, 0.5F, 0.75F, 1.0F};
  return scene;
}

// By hand, in double precision.
std::array<double, 4> blended(std::vector<Rectangle> rectangles, std::uint32_t x, std::uint32_t y, const Vec4& behind,
                              float opaqueDepth = 1.0F) {
  std::ranges::sort(rectangles, {}, &Rectangle::depth);
  std::array<double, 4> color{};
  std::array<double, 4> through{1.0, 1.0, 1.0, 1.0};
  for (const Rectangle& r : rectangles) {
    if (x < r.left || x >= r.right || y < r.top || y >= r.bottom || r.depth > opaqueDepth) continue;
    const double alpha = r.color[3];
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = r.color[c];
      if (r.blend == VITRAIL_BLEND_OVER) color[c] += through[c] * alpha * value;
      if (r.blend == VITRAIL_BLEND_PREMULTIPLIED) color[c] += through[c] * value;
      if (r.blend == VITRAIL_BLEND_ADDITIVE) color[c] += through[c] * alpha * value;
      const bool hides = r.blend == VITRAIL_BLEND_OVER || r.blend == VITRAIL_BLEND_PREMULTIPLIED;
      if (hides) through[c] *= 1.0 - alpha;
      if (r.blend == VITRAIL_BLEND_MULTIPLY) through[c] *= 1.0 - alpha + alpha * value;
    }
    if (r.blend <= VITRAIL_BLEND_PREMULTIPLIED) through[3] *= 1.0 - alpha;
  }
  for (std::size_t c = 0; c < 3; ++c) color[c] += through[c] * behind[c];
  color[3] = 1.0 - through[3] + through[3] * behind[3];
  return color;
}

void expectPicture(const RasterHost& host, const std::vector<Rectangle>& rectangles, const RasterScene& scene,
                   std::uint32_t side = kSide, float opaqueDepth = 1.0F) {
  double worst = 0.0;
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::array<double, 4> expected = blended(rectangles, x, y, scene.behind, opaqueDepth);
      const Vec4 drawn = host.at(x, y);
      for (std::size_t c = 0; c < 4; ++c) worst = std::max(worst, std::abs(expected[c] - drawn[c]));
    }
  }
  EXPECT_LT(worst, 2e-5); // colours have as many bits as halves in nodes; here they are whole
}

class RasterTest : public VulkanTest {};

TEST_F(RasterTest, EveryFormOfDrawsIsThePictureByHand) {
  const std::vector<Rectangle> rectangles = someRectangles(24);
  for (const bool keeps : {true, false}) {
    for (const VkIndexType type : {VK_INDEX_TYPE_UINT16, VK_INDEX_TYPE_UINT32, VK_INDEX_TYPE_NONE_KHR}) {
      if (!keeps && type == VK_INDEX_TYPE_UINT16 && !isThorough()) continue; // one pipeline more
      RasterHostDesc desc;
      desc.keepsPositions = keeps;
      desc.indexType = type;
      desc.solids = type == VK_INDEX_TYPE_NONE_KHR; // as in other tests, which have such pipelines
      RasterHost host(desc);
      std::vector<Form> forms = {Form::Indices, Form::VertexOffsets, Form::FirstIndices, Form::Instances};
      if (type == VK_INDEX_TYPE_NONE_KHR) forms = {Form::NoIndices};
      for (const Form form : forms) {
        SCOPED_TRACE(testing::Message() << "keeps " << keeps << ", indices " << type << ", form "
                                        << static_cast<int>(form));
        const RasterScene scene = sceneOf(rectangles, form);
        host.setScene(scene);
        host.draw();
        expectPicture(host, rectangles, scene);
      }
    }
  }
}

TEST_F(RasterTest, AnyOrderOfDrawsIsTheSameBits) {
  std::vector<Rectangle> rectangles = someRectangles(40);
  RasterHost host({});
  host.setScene(sceneOf(rectangles, Form::Indices));
  const std::vector<float> first = host.draw();
  std::ranges::reverse(rectangles);
  host.setScene(sceneOf(rectangles, Form::Indices));
  EXPECT_TRUE(host.draw() == first);
  std::ranges::shuffle(rectangles, std::mt19937(3));
  host.setScene(sceneOf(rectangles, Form::Instances));
  EXPECT_EQ(host.draw(), first);
}

TEST_F(RasterTest, DepthOrdersAndOpaqueSurfaces) {
  const std::vector<Rectangle> rectangles = someRectangles(30);
  for (const VitrailDepthOrder order : {VITRAIL_DEPTH_NEAREST_IS_ZERO, VITRAIL_DEPTH_NEAREST_IS_ONE}) {
    RasterHostDesc desc;
    desc.depthOrder = order;
    RasterHost host(desc);
    const bool nearestIsOne = order == VITRAIL_DEPTH_NEAREST_IS_ONE;
    for (const float opaque : {1.0F, 0.51F, 0.0F}) {
      SCOPED_TRACE(testing::Message() << "order " << order << ", opaque " << opaque);
      RasterScene scene = sceneOf(rectangles, Form::Indices, nearestIsOne);
      scene.opaqueDepth = nearestIsOne ? 1.0F - opaque : opaque;
      host.setScene(scene);
      host.draw();
      expectPicture(host, rectangles, scene, kSide, opaque);
    }
  }
}

TEST_F(RasterTest, BlendModes) {
  std::vector<Rectangle> rectangles = someRectangles(24);
  for (std::size_t i = 0; i < rectangles.size(); ++i) rectangles[i].blend = static_cast<VitrailBlend>(i % 4);
  RasterHost host({});
  const RasterScene scene = sceneOf(rectangles, Form::Indices);
  host.setScene(scene);
  host.draw();
  expectPicture(host, rectangles, scene);
  EXPECT_EQ(host.stats().errorBound, 0.0F);
  // A glow: premultiplied, of alpha 0.
  rectangles.assign(1, {4, 4, 20, 20, 0.5F, {0.5F, 0.25F, 0.0F, 0.0F}, VITRAIL_BLEND_PREMULTIPLIED});
  const RasterScene glow = sceneOf(rectangles, Form::Indices);
  host.setScene(glow);
  host.draw();
  expectPicture(host, rectangles, glow);
  // Where the host says that there is one mode.
  rectangles = someRectangles(24);
  for (Rectangle& r : rectangles) r.blend = VITRAIL_BLEND_ADDITIVE;
  RasterHostDesc one;
  one.blendModes = 1U << VITRAIL_BLEND_ADDITIVE;
  RasterHost additive(one);
  additive.setScene(sceneOf(rectangles, Form::Indices));
  additive.draw();
  expectPicture(additive, rectangles, scene);
}

// What is hidden to within the bound is left out where the host says how much light there is, and only then.
TEST_F(RasterTest, LightThatIsHidden) {
  std::vector<Rectangle> rectangles;
  for (std::uint32_t i = 0; i < 40; ++i) {
    rectangles.push_back(
        {0, 0, kSide, kSide, static_cast<float>(i + 1) / 50.0F, {1.0F, i < 39 ? 1.0F : 0.0F, 0.5F, 0.5F}});
  }
  RasterHostDesc desc;
  desc.blendModes = 1U << VITRAIL_BLEND_OVER;
  RasterHost host(desc);
  const RasterScene scene = sceneOf(rectangles, Form::Indices);
  host.setScene(scene);
  host.draw();
  expectPicture(host, rectangles, scene);
  EXPECT_EQ(host.stats().errorBound, 0.0F);
  host.info().mostLight = 1.0F;
  host.draw();
  const float bound = host.stats().errorBound;
  EXPECT_GT(bound, 0.0F);
  EXPECT_LT(bound, 0.5F);
  const std::array<double, 4> expected = blended(rectangles, 3, 3, scene.behind);
  const auto curve = [](double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055; };
  const Vec4 drawn = host.at(3, 3);
  EXPECT_NE(drawn[0], static_cast<float>(expected[0])); // something was left out
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_LE(255.0 * std::abs(curve(drawn[c]) - curve(expected[c])), bound + 0.01);
  }
}

// ---- What surfaces tell

// One rectangle over the whole picture, whose colour shows something (raster.glsl of the tests).
RasterScene showing(std::uint32_t what) {
  RasterScene scene = sceneOf({{0, 0, kSide, kSide, 0.5F, {1.0F, 1.0F, 1.0F, 1.0F}}}, Form::VertexOffsets);
  scene.draws[0].word |= what << 16U;
  return scene;
}

TEST_F(RasterTest, SidesAndCulling) {
  RasterHost host({});
  const auto drawn = [&](std::uint32_t flags) {
    RasterScene scene = showing(1);
    scene.draws[0].flags = flags;
    host.setScene(scene);
    host.draw();
    return host.at(5, 9);
  };
  const Vec4 front{1.0F, 0.0F, 0.0F, 1.0F};
  const Vec4 back{0.0F, 0.0F, 1.0F, 1.0F};
  const Vec4 behind{0.25F, 0.5F, 0.75F, 1.0F};
  // Its corners run clockwise in the picture, y down.
  EXPECT_EQ(drawn(0), back);
  EXPECT_EQ(drawn(VITRAIL_VK_RASTER_FRONT_CLOCKWISE), front);
  EXPECT_EQ(drawn(VITRAIL_VK_RASTER_CULL_BACK), behind);
  EXPECT_EQ(drawn(VITRAIL_VK_RASTER_CULL_FRONT), back);
  EXPECT_EQ(drawn(VITRAIL_VK_RASTER_CULL_FRONT | VITRAIL_VK_RASTER_FRONT_CLOCKWISE), behind);
  EXPECT_EQ(drawn(VITRAIL_VK_RASTER_CULL_BACK | VITRAIL_VK_RASTER_FRONT_CLOCKWISE), front);
}

TEST_F(RasterTest, WeightsAreThoseOfPerspective) {
  RasterHost host({});
  RasterScene scene = showing(2);
  // A triangle that goes away from the viewer: w is 1 on the left, 4 on the right.
  scene.vertices = {{-1.0F, -1.0F, 0.5F, 1.0F}, {-1.0F, 1.0F, 0.5F, 1.0F}, {4.0F, -4.0F, 2.0F, 4.0F}};
  scene.indices = {0, 1, 2};
  scene.draws[0].count = 3;
  scene.draws[0].vertexCount = 3;
  scene.draws[0].vertexOffset = 0;
  host.setScene(scene);
  host.draw();
  for (const std::uint32_t x : {2U, 10U, 20U}) {
    const double across = (x + 0.5) / kSide; // 0 on the left, 1 on the right, in the picture
    const double down = 2.5 / kSide;         // of the third row
    const double screen[3] = {1.0 - across - down, down, across};
    const double w[3] = {1.0, 1.0, 4.0};
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += screen[i] / w[i];
    const Vec4 drawn = host.at(x, 2);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(drawn[i], screen[i] / w[i] / sum, 1e-5) << "at " << x;
  }
}

TEST_F(RasterTest, DerivativesAreDifferencesOfPixels) {
  RasterHost host({});
  host.setScene(showing(5));
  host.draw();
  const Vec4 drawn = host.at(9, 9);         // weights change by 1/32 from pixel to pixel
  EXPECT_NEAR(drawn[0], 2.0 / kSide, 1e-5); // of one corner along both axes, of the others along one
  EXPECT_NEAR(drawn[1], 1.0 / kSide, 1e-5);
  EXPECT_NEAR(drawn[2], 1.0 / kSide, 1e-5);
}

TEST_F(RasterTest, NumbersAreTheDraws) {
  RasterHost host({});
  RasterScene scene = showing(3);
  scene.vertices.insert(scene.vertices.begin(), 5, Vec4{9.0F, 9.0F, 9.0F, 1.0F}); // before its own
  scene.draws[0].vertexOffset = 5;
  host.setScene(scene);
  host.draw();
  EXPECT_EQ(host.at(0, 0), (Vec4{5.0F / 256.0F, 6.0F / 256.0F, 7.0F / 256.0F, 1.0F}));
  scene.draws[0].word = 4U << 16U;
  scene.draws[0].instanceCount = 2;
  scene.draws[0].firstInstance = 3;
  scene.shifts.assign(5, Vec4{9.0F, 9.0F, 0.0F, 0.0F}); // out of the picture
  scene.shifts[4] = {};
  scene.draws.insert(scene.draws.begin(), scene.draws[0]);
  scene.draws[0].count = 0; // which draws nothing
  host.setScene(scene);
  host.draw();
  EXPECT_EQ(host.at(0, 0), (Vec4{0.0F, 4.0F / 256.0F, 1.0F / 256.0F, 1.0F}));
  EXPECT_EQ(host.at(31, 31), (Vec4{1.0F / 256.0F, 4.0F / 256.0F, 1.0F / 256.0F, 1.0F}));
}

// A work group that sets up triangles has those of a part of an instance, or of many.
TEST_F(RasterTest, InstancesOfMeshesOfAnySize) {
  constexpr std::uint32_t kPixels = 1024; // in a row, a triangle each
  RasterHostDesc desc;
  desc.width = kPixels;
  desc.height = 1;
  RasterHost host(desc);
  for (const std::uint32_t triangles : {1U, 3U, 100U, 128U, 300U, 512U}) {
    SCOPED_TRACE(triangles);
    const std::uint32_t instances = kPixels / triangles;
    RasterScene scene;
    scene.colors = {{1.0F, 1.0F, 1.0F, 1.0F}};
    VitrailVkRasterDraw draw{};
    draw.count = draw.vertexCount = 3 * triangles;
    draw.instanceCount = instances;
    draw.word = 4U << 16U;
    scene.draws = {draw};
    const auto across = [](float pixels) { return pixels * 2.0F / kPixels; };
    for (std::uint32_t i = 0; i < triangles; ++i) { // around the middles of pixels
      const auto left = static_cast<float>(i);
      scene.vertices.push_back({across(left + 0.25F) - 1.0F, -0.5F, 0.5F, 1.0F});
      scene.vertices.push_back({across(left + 0.75F) - 1.0F, -0.5F, 0.5F, 1.0F});
      scene.vertices.push_back({across(left + 0.5F) - 1.0F, 0.5F, 0.5F, 1.0F});
    }
    for (std::uint32_t i = 0; i < draw.count; ++i) scene.indices.push_back(i);
    for (std::uint32_t i = 0; i < instances; ++i) {
      scene.shifts.push_back({across(static_cast<float>(i * triangles)), 0.0F, 0.0F, 0.0F});
    }
    host.setScene(scene);
    host.draw();
    for (std::uint32_t i = 0; i < instances * triangles; ++i) {
      const Vec4 numbers{static_cast<float>(i % triangles) / 256.0F, static_cast<float>(i / triangles) / 256.0F, 0.0F,
                         1.0F};
      ASSERT_EQ(host.at(i, 0), numbers) << "pixel " << i;
    }
  }
}

TEST_F(RasterTest, AlphaZeroIsNotThere) {
  RasterHost host({});
  RasterScene scene = showing(6);
  host.setScene(scene);
  host.draw();
  EXPECT_EQ(host.at(8, 8), (Vec4{1.0F, 1.0F, 1.0F, 1.0F}));
  EXPECT_EQ(host.at(9, 8), scene.behind);
}

TEST_F(RasterTest, LinesAndPoints) {
  RasterHostDesc desc;
  desc.solids = true;
  RasterHost host(desc);
  RasterScene scene = showing(0);
  // A line along the middle of the row 4, and a point of 6 pixels around the corner of four pixels.
  scene.vertices = {{-1.0F, -0.71875F, 0.5F, 1.0F}, {1.0F, -0.71875F, 0.5F, 1.0F}, {0.0F, 0.5F, 0.5F, 1.0F}};
  scene.indices = {0, 1, 2};
  scene.draws[0] = {};
  scene.draws[0].count = 2;
  scene.draws[0].instanceCount = 1;
  scene.draws[0].vertexCount = 3;
  scene.draws.push_back(scene.draws[0]);
  scene.draws[0].flags = VITRAIL_VK_RASTER_LINES;
  scene.draws[1].flags = VITRAIL_VK_RASTER_POINTS;
  scene.draws[1].count = 1;
  scene.draws[1].firstIndex = 2;
  host.setScene(scene);
  host.info().pointSize = 6.0F;
  host.draw();
  std::uint32_t line = 0;
  std::uint32_t point = 0;
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      if (host.at(x, y) == scene.behind) continue;
      if (y == 4) {
        ++line;
      } else {
        ++point;
        EXPECT_TRUE(x >= 13 && x < 19 && y >= 21 && y < 27) << x << ' ' << y;
      }
    }
  }
  EXPECT_EQ(line, kSide);
  EXPECT_EQ(point, 36U);
}

TEST_F(RasterTest, ClipPlanesAndTheEye) {
  RasterHost host({});
  RasterScene scene = showing(0);
  scene.colors[0] = {1.0F, 1.0F, 1.0F, 1.0F};
  host.setScene(scene);
  const float plane[1][4] = {{1.0F, 0.0F, 0.0F, 0.0F}}; // the right half
  host.info().clipPlaneCount = 1;
  host.info().clipPlanes = plane;
  host.draw();
  EXPECT_EQ(host.at(15, 3), scene.behind);
  EXPECT_EQ(host.at(16, 3), (Vec4{1.0F, 1.0F, 1.0F, 1.0F}));
  // Planes across the depth, of the host's depths.
  for (const VitrailDepthOrder order : {VITRAIL_DEPTH_NEAREST_IS_ZERO, VITRAIL_DEPTH_NEAREST_IS_ONE}) {
    RasterHostDesc desc;
    desc.depthOrder = order;
    RasterHost across(desc);
    for (Vec4& vertex : scene.vertices) vertex[2] = 0.25F;
    across.setScene(scene);
    for (const float side : {1.0F, -1.0F}) {
      const float deep[1][4] = {{0.0F, 0.0F, side, -0.4F * side}};
      across.info().clipPlaneCount = 1;
      across.info().clipPlanes = deep;
      across.draw();
      EXPECT_EQ(across.at(16, 3) == scene.behind, side > 0.0F) << order;
    }
  }
  host.info().clipPlaneCount = 0;
  host.info().clipPlanes = nullptr;
  // A triangle that reaches behind the eye: what is before it is drawn, over all of the picture's right side.
  scene.vertices = {{0.0F, 4.0F, 0.25F, 0.5F}, {0.0F, -4.0F, 0.25F, 0.5F}, {4.0F, 0.0F, -1.0F, -2.0F}};
  scene.indices = {0, 1, 2};
  scene.draws[0].count = 3;
  scene.draws[0].vertexCount = 3;
  host.setScene(scene);
  host.draw();
  EXPECT_EQ(host.at(15, 16), scene.behind);
  EXPECT_NE(host.at(17, 16), scene.behind);
  EXPECT_NE(host.at(31, 16), scene.behind);
  EXPECT_GE(host.stats().largeTriangles, 1U);
}

// ---- Room

TEST_F(RasterTest, FramesWithoutRoomSaySoAndTheNextHaveIt) {
  const std::vector<Rectangle> rectangles = someRectangles(3000, 64);
  RasterHostDesc desc;
  desc.width = desc.height = 64;
  RasterHost host(desc);
  host.setScene(sceneOf(rectangles, Form::VertexOffsets, false, 64));
  host.drawOnce();
  EXPECT_EQ(host.stats().exact, VK_FALSE); // nobody said how much there is
  EXPECT_EQ(host.stats().draws, 3000U);
  EXPECT_EQ(host.stats().instances, 3000U);
  EXPECT_EQ(host.stats().vertices, 12000U);
  host.draw();
  const VitrailVkRasterStats stats = host.stats();
  EXPECT_EQ(stats.bands, 1U);
  const std::vector<float> expected = host.picture();

  // The same, told beforehand: the first frame has room for the draws.
  desc.hints = {.draws = 3000, .instances = 3000, .triangles = 6000, .vertices = 12000};
  RasterHost told(desc);
  told.setScene(sceneOf(rectangles, Form::VertexOffsets, false, 64));
  told.drawOnce();
  EXPECT_GT(told.stats().records, 0U);
  EXPECT_TRUE(told.draw() == expected);

  // And with a budget for a part of it: in bands, to the same bits.
  VitrailVkRasterMemory memory = host.raster().memory();
  EXPECT_GT(memory.tileBytes, 0U);
  EXPECT_GT(memory.drawBytes, 3000U * 64U);
  desc.memoryBudget = memory.tileBytes / 3;
  RasterHost bounded(desc);
  bounded.setScene(sceneOf(rectangles, Form::VertexOffsets, false, 64));
  EXPECT_TRUE(bounded.draw() == expected);
  EXPECT_GT(bounded.stats().bands, 1U);
  EXPECT_LE(bounded.raster().memory().tileBytes, desc.memoryBudget + 4096U); // and what is rounded

  // Each band by a submission of its own.
  const std::uint32_t bands = bounded.raster().bands();
  ASSERT_GT(bands, 1U);
  bounded.info().bandCount = 1;
  for (std::uint32_t band = 0; band < bands; ++band) {
    bounded.info().firstBand = band;
    if (band == 0) {
      bounded.commands().run([&](VkCommandBuffer commands) { bounded.recordAll(commands); });
    } else {
      bounded.commands().run([&](VkCommandBuffer commands) { bounded.recordMore(commands); });
    }
  }
  EXPECT_EQ(bounded.stats().exact, VK_TRUE);
  bounded.readPicture();
  EXPECT_TRUE(bounded.picture() == expected);
}

TEST_F(RasterTest, ABudgetWithoutRoomForARowIsRefused) {
  RasterHostDesc desc;
  desc.memoryBudget = 100;
  EXPECT_THROW(RasterHost{desc}, HostError);
  expectOneLine("memoryBudget");
  // One that has room for tiles, and not for what is in them.
  desc.memoryBudget = 20'000;
  RasterHost host(desc);
  host.setScene(sceneOf(someRectangles(500), Form::VertexOffsets));
  VkResult result = VK_SUCCESS;
  for (int i = 0; i < 12 && result == VK_SUCCESS; ++i) {
    host.drawOnce();
    EXPECT_EQ(host.stats().exact, VK_FALSE);
    result = host.raster().update();
  }
  EXPECT_EQ(result, VK_ERROR_OUT_OF_DEVICE_MEMORY);
  expectOneLine("no room for the");
}

// Two frames are recorded before any has run: each has the memory that it was recorded with.
TEST_F(RasterTest, FramesInFlightKeepTheirMemory) {
  RasterHostDesc desc;
  RasterHost host(desc);
  Commands second(backend().device());
  host.setScene(sceneOf(someRectangles(200), Form::VertexOffsets));
  host.drawOnce();
  for (int i = 0; i < 4; ++i) {
    ASSERT_EQ(host.raster().update(), VK_SUCCESS);
    host.recordAll(host.commands().begin());
    ASSERT_EQ(host.raster().update(), VK_SUCCESS);
    host.recordAll(second.begin());
    host.commands().execute();
    second.execute();
  }
  host.readPicture();
  EXPECT_EQ(host.stats().exact, VK_TRUE);
  const std::vector<float> drawn = host.picture();
  EXPECT_EQ(host.raster().memory().retiredBytes, 0U);
  RasterHost fresh(desc);
  fresh.setScene(sceneOf(someRectangles(200), Form::VertexOffsets));
  EXPECT_TRUE(fresh.draw() == drawn);
}

TEST_F(RasterTest, StatisticsAreNotThereBeforeTheFrame) {
  RasterHost host({});
  VitrailVkRasterStats stats{};
  EXPECT_EQ(host.raster().readStats(0, stats), VK_NOT_READY);
  host.setScene(sceneOf(someRectangles(4), Form::Indices));
  host.recordAll(host.commands().begin());
  EXPECT_EQ(host.raster().readStats(0, stats), VK_NOT_READY);
  host.commands().execute();
  EXPECT_EQ(host.raster().readStats(0, stats), VK_SUCCESS);
  EXPECT_EQ(stats.draws, 4U);
  // By the host's numbers.
  host.info().frame = 10;
  host.drawOnce();
  EXPECT_EQ(host.raster().readStats(10, stats), VK_SUCCESS);
  EXPECT_EQ(stats.frame, 10U);
  EXPECT_EQ(host.raster().readStats(9, stats), VK_NOT_READY);
}

TEST_F(RasterTest, NothingToDrawIsExact) {
  for (const std::uint32_t samples : {1U, 4U}) {
    if (samples > 1 && !std::ranges::count(backend().features().multisampled, samples)) continue;
    RasterHostDesc desc;
    desc.samples = samples;
    RasterHost host(desc);
    RasterScene scene;
    scene.behind = {0.1F, 0.2F, 0.3F, 1.0F};
    host.setScene(scene);
    host.drawOnce();
    EXPECT_EQ(host.stats().exact, VK_TRUE);
    EXPECT_EQ(host.at(7, 7), scene.behind);
  }
}

// The GPU has worked out how many draws there are.
TEST_F(RasterTest, DrawsThatTheGpuCounts) {
  std::vector<Rectangle> rectangles = someRectangles(20);
  RasterHost host({});
  const RasterScene scene = sceneOf(rectangles, Form::Indices);
  host.setScene(scene);
  Buffer count(backend().device(), 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::Host);
  host.info().countBuffer = count.get();
  for (const std::uint32_t draws : {20U, 7U, 0U, 100U}) {
    *static_cast<std::uint32_t*>(count.mapped()) = draws;
    host.draw();
    const std::size_t drawn = std::min<std::size_t>(draws, rectangles.size());
    expectPicture(host, {rectangles.begin(), rectangles.begin() + static_cast<std::ptrdiff_t>(drawn)}, scene);
    EXPECT_EQ(host.stats().draws, drawn);
  }
}

TEST_F(RasterTest, DrawsThatAreTheSameAreNotReadAgain) {
  RasterHost host({});
  const std::vector<Rectangle> rectangles = someRectangles(20);
  const RasterScene scene = sceneOf(rectangles, Form::Indices);
  host.setScene(scene);
  const std::vector<float> first = host.draw();
  host.info().sameDraws = VK_TRUE;
  EXPECT_TRUE(host.draw() == first);
  const std::vector<Rectangle> fewer(rectangles.begin(), rectangles.begin() + 5);
  RasterScene some = scene;
  some.draws.resize(5);
  host.setScene(some);
  host.draw(); // which are not the same, as their number shows
  expectPicture(host, fewer, scene);
  host.setScene(sceneOf(fewer, Form::Indices));
  host.info().sameDraws = VK_FALSE;
  host.draw();
  expectPicture(host, fewer, scene);
}

// Where there are to be millions, a thread asks for more of them: also of few all are asked for.
TEST_F(RasterTest, ManyVertices) {
  constexpr std::uint32_t kQuads = 700; // 2,800 vertices
  RasterScene scene = sceneOf(someRectangles(kQuads, 64), Form::Indices, false, 64);
  scene.draws.resize(1); // all in one
  scene.draws[0].count = static_cast<std::uint32_t>(scene.indices.size());
  scene.draws[0].vertexCount = static_cast<std::uint32_t>(scene.vertices.size());
  std::vector<float> expected;
  for (const std::uint64_t vertices : {std::uint64_t{0}, std::uint64_t{1} << 21U}) {
    RasterHostDesc desc;
    desc.width = desc.height = 64;
    desc.hints.vertices = vertices;
    RasterHost host(desc);
    host.setScene(scene);
    const std::vector<float> drawn = host.draw();
    EXPECT_EQ(host.stats().vertices, scene.vertices.size());
    if (vertices == 0) expected = drawn;
    EXPECT_TRUE(drawn == expected);
  }
  EXPECT_GT(std::accumulate(expected.begin(), expected.end(), 0.0F), 1.0F);
}

// Work groups that blend are as many as tiles of the frame before: here of few, and each goes on to many.
TEST_F(RasterTest, MoreTilesThanInTheFrameBefore) {
  constexpr std::uint32_t kPixels = 256;
  for (const std::uint32_t samples : {1U, 4U}) {
    RasterHostDesc desc;
    desc.width = desc.height = kPixels;
    desc.samples = samples;
    RasterHost host(desc);
    const RasterScene all = sceneOf(someRectangles(40, kPixels), Form::Indices, false, kPixels);
    host.setScene(all);
    const std::vector<float> expected = host.draw();
    host.setScene(sceneOf({{8, 8, 16, 16, 0.5F, {1.0F, 0.5F, 0.25F, 0.5F}}}, Form::Indices, false, kPixels));
    for (int frame = 0; frame < 3; ++frame) host.draw();
    host.setScene(all);
    EXPECT_TRUE(host.drawOnce() == expected) << samples << " samples";
    EXPECT_EQ(host.stats().exact, VK_TRUE);
    EXPECT_TRUE(host.draw() == expected) << samples << " samples";
  }
}

// A pixel with more surfaces than registers hold, of which none hides another: their fragments are collected.
TEST_F(RasterTest, DeepTiles) {
  constexpr std::uint32_t kLayers = 6000;
  std::vector<Rectangle> rectangles;
  for (std::uint32_t i = 0; i < kLayers; ++i) {
    rectangles.push_back({2,
                          2,
                          4,
                          4,
                          static_cast<float>(i + 1) / static_cast<float>(kLayers + 2),
                          {i % 2 == 0 ? 1.0F : 0.0F, 0.5F, 0.25F, 1.0F / 512.0F}});
  }
  std::ranges::shuffle(rectangles, std::mt19937(5));
  RasterHostDesc desc;
  desc.hints = {.draws = kLayers, .instances = kLayers, .triangles = 2 * kLayers, .vertices = 4 * kLayers};
  RasterHost host(desc);
  const RasterScene scene = sceneOf(rectangles, Form::VertexOffsets);
  host.setScene(scene);
  host.draw();
  EXPECT_EQ(host.stats().deepTiles, 1U);
  EXPECT_EQ(host.stats().deepestPixel, kLayers);
  double worst = 0.0;
  const std::array<double, 4> expected = blended(rectangles, 3, 3, scene.behind);
  for (std::size_t c = 0; c < 4; ++c) worst = std::max(worst, std::abs(expected[c] - host.at(3, 3)[c]));
  EXPECT_LT(worst, 1e-3); // 6,000 roundings
  EXPECT_EQ(host.at(4, 4), scene.behind);
}

// More surfaces at one depth than their colours can order: the host's orders decide.
TEST_F(RasterTest, OrdersOfTheHosts) {
  constexpr std::uint32_t kLayers = 40;
  std::vector<Rectangle> rectangles;
  for (std::uint32_t i = 0; i < kLayers; ++i) {
    const float shade = static_cast<float>(i) / static_cast<float>(kLayers);
    rectangles.push_back({0, 0, 8, 8, 0.5F, {shade, 1.0F - shade, 0.5F, 0.5F}});
  }
  RasterScene scene = sceneOf(rectangles, Form::Instances);
  for (std::uint32_t i = 0; i < kLayers; ++i) scene.orders.push_back(kLayers - i); // the last is in front
  RasterHost host({});
  host.setScene(scene);
  host.draw();
  for (std::uint32_t i = 0; i < kLayers; ++i) rectangles[i].depth = 0.9F - 0.01F * static_cast<float>(i);
  expectPicture(host, rectangles, scene);
  std::ranges::reverse(scene.draws);
  const std::vector<float> before = host.picture();
  host.setScene(scene);
  EXPECT_TRUE(host.draw() == before);
}

// ---- Several samples

TEST_F(RasterTest, SeveralSamples) {
  for (const std::uint32_t samples : backend().features().multisampled) {
    SCOPED_TRACE(samples);
    const std::vector<Rectangle> rectangles = someRectangles(16);
    RasterHostDesc desc;
    desc.samples = samples;
    RasterHost host(desc);
    RasterScene scene = sceneOf(rectangles, Form::Indices);
    host.setScene(scene);
    host.draw();
    expectPicture(host, rectangles, scene); // their borders are those of pixels
    // A slanted edge covers a part of the samples.
    scene.vertices = {{-1.0F, -1.0F, 0.5F, 1.0F}, {1.0F, -1.0F, 0.5F, 1.0F}, {-1.0F, 1.0F, 0.5F, 1.0F}};
    scene.indices = {0, 1, 2};
    scene.draws.resize(1);
    scene.draws[0].count = 3;
    scene.draws[0].firstIndex = 0;
    scene.draws[0].vertexCount = 3;
    scene.colors[0] = {1.0F, 1.0F, 1.0F, 1.0F};
    scene.behind = {0.0F, 0.0F, 0.0F, 1.0F};
    host.setScene(scene);
    host.draw();
    EXPECT_EQ(host.at(3, 3)[0], 1.0F);
    EXPECT_EQ(host.at(28, 28)[0], 0.0F);
    const float edge = host.at(16, 15)[0] * static_cast<float>(samples);
    EXPECT_GT(edge, 0.0F);
    EXPECT_LT(edge, static_cast<float>(samples));
    EXPECT_EQ(edge, std::round(edge));
  }
}

// ---- Resizing

TEST_F(RasterTest, AnotherExtent) {
  RasterHostDesc desc;
  desc.width = desc.height = 64;
  RasterHost host(desc);
  const std::vector<Rectangle> rectangles = someRectangles(30, 64);
  const RasterScene scene = sceneOf(rectangles, Form::Indices, false, 64);
  host.setScene(scene);
  host.draw();
  expectPicture(host, rectangles, scene, 64);
  ASSERT_EQ(host.raster().resize({32, 32}), VK_SUCCESS); // a corner of the images
  const std::vector<Rectangle> small = someRectangles(30);
  host.setScene(sceneOf(small, Form::Indices));
  host.draw();
  expectPicture(host, small, scene);
  EXPECT_EQ(host.raster().resize({0, 32}), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("extent");
  EXPECT_EQ(host.raster().resize({20000, 32}), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("extent");
}

// What a frame of another extent has needed is not made: its draws are, which are those of any extent.
TEST_F(RasterTest, FramesOfAnotherExtentAreNotFollowed) {
  RasterHostDesc desc;
  desc.width = desc.height = 64;
  RasterHost host(desc);
  const RasterScene scene = sceneOf(someRectangles(1000, 64), Form::VertexOffsets, false, 64);
  host.setScene(scene);
  host.drawOnce(); // asks for tables
  ASSERT_EQ(host.raster().resize({16, 16}), VK_SUCCESS);
  const VitrailVkRasterMemory before = host.raster().memory();
  ASSERT_EQ(host.raster().update(), VK_SUCCESS);
  EXPECT_GT(host.raster().memory().drawBytes, before.drawBytes);
  ASSERT_EQ(host.raster().resize({64, 64}), VK_SUCCESS);
  host.drawOnce(); // needs much room
  EXPECT_EQ(host.stats().exact, VK_FALSE);
  EXPECT_GT(host.stats().records, 4096U);
  ASSERT_EQ(host.raster().resize({16, 16}), VK_SUCCESS);
  const VkDeviceSize small = host.raster().memory().tileBytes;
  ASSERT_EQ(host.raster().update(), VK_SUCCESS);
  EXPECT_EQ(host.raster().memory().tileBytes, small);
  // And one that needs what a large one had no room for is followed.
  ASSERT_EQ(host.raster().resize({64, 64}), VK_SUCCESS);
  host.draw();
  EXPECT_GT(host.raster().memory().tileBytes, small);
}

// ---- What hosts may put in

// Triangles whose corners are no places cover nothing, and change nothing of others.
TEST_F(RasterTest, PositionsThatAreNone) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const std::vector<Vec4> wrong = {
      {kNan, 0.0F, 0.5F, 1.0F},      {0.0F, kNan, 0.5F, 1.0F},       {0.0F, 0.0F, kNan, 1.0F},
      {0.0F, 0.0F, 0.5F, kNan},      {kInfinite, 0.0F, 0.5F, 1.0F},  {0.0F, -kInfinite, 0.5F, 1.0F},
      {0.0F, 0.0F, 0.5F, kInfinite}, {0.0F, 0.0F, 0.5F, -kInfinite}, {kInfinite, kInfinite, 0.5F, kInfinite}};
  const std::vector<Rectangle> rectangles = someRectangles(12);
  for (const bool keeps : {true, false}) {
    RasterHostDesc desc;
    desc.keepsPositions = keeps;
    RasterHost host(desc);
    const RasterScene scene = sceneOf(rectangles, Form::Indices);
    RasterScene more = scene;
    const auto add = [&](const Vec4& a, const Vec4& b, const Vec4& c) {
      VitrailVkRasterDraw draw = scene.draws[0];
      draw.count = 3;
      draw.firstIndex = static_cast<std::uint32_t>(more.indices.size());
      draw.vertexOffset = static_cast<std::int32_t>(more.vertices.size());
      draw.vertexCount = 3;
      more.draws.push_back(draw);
      more.indices.insert(more.indices.end(), {0, 1, 2});
      more.vertices.insert(more.vertices.end(), {a, b, c});
    };
    const Vec4 right{-0.5F, -0.5F, 0.5F, 1.0F};
    const Vec4 below{-0.5F, 0.5F, 0.5F, 1.0F};
    for (const Vec4& one : wrong) {
      add(one, right, below);
      add(right, one, below);
      add(right, below, one);
      add(one, one, one);
    }
    const Vec4 none{};
    const Vec4 eye{0.5F, -0.5F, 0.0F, 0.0F};
    const Vec4 huge{1e38F, 0.0F, 0.5F, 1.0F};
    add(none, none, none);
    add(eye, none, {-0.5F, -0.5F, 0.0F, 0.0F});
    add(huge, huge, huge);
    add({-0.5F, -0.5F, -0.5F, -1.0F}, {0.5F, -0.5F, -0.5F, -1.0F}, {0.0F, 0.5F, -0.5F, -1.0F});
    host.setScene(more);
    host.draw();
    expectPicture(host, rectangles, scene);
  }
}

// Draws of sizes that nothing has room for, alone and together: the frame says so, and the next one is as before.
TEST_F(RasterTest, DrawsThatAreTooMany) {
  RasterHostDesc desc;
  desc.indexType = VK_INDEX_TYPE_NONE_KHR;
  desc.solids = true;
  RasterHost host(desc);
  const std::vector<Rectangle> rectangles = someRectangles(8);
  const RasterScene scene = sceneOf(rectangles, Form::NoIndices);
  host.setScene(scene);
  host.draw();
  constexpr std::uint32_t kAll = 0xffffffffU;
  const auto expectTooMany = [&](const std::vector<VitrailVkRasterDraw>& draws, const std::string& word) {
    SCOPED_TRACE(testing::Message() << draws[0].count << " indices, " << draws[0].instanceCount << " instances");
    RasterScene more = scene;
    more.draws.insert(more.draws.begin() + 3, draws.begin(), draws.end());
    host.setScene(more);
    host.drawOnce();
    EXPECT_EQ(host.stats().exact, VK_FALSE);
    EXPECT_EQ(host.raster().update(), VK_ERROR_OUT_OF_DEVICE_MEMORY);
    expectOneLine(word);
    host.setScene(scene);
    host.draw();
    expectPicture(host, rectangles, scene);
  };
  const auto draw = [](std::uint32_t count, std::uint32_t instances, std::uint32_t vertices, std::uint32_t flags = 0) {
    VitrailVkRasterDraw one{};
    one.count = count;
    one.instanceCount = instances;
    one.vertexCount = vertices;
    one.flags = flags;
    return one;
  };
  expectTooMany({draw(kAll, 1, 3)}, "2^30");
  expectTooMany({draw(kAll, kAll, kAll)}, "2^30");
  expectTooMany({draw(3, kAll, 3)}, "2^30");
  expectTooMany({draw(3, 0x40000001, 0)}, "2^30");
  expectTooMany({draw(3, 0x10000, 0x10000)}, "2^30");
  expectTooMany({draw(0x80000001, 2, 3, VITRAIL_VK_RASTER_POINTS)}, "2^30");
  expectTooMany({draw(kAll, 1, 3, VITRAIL_VK_RASTER_LINES)}, "2^30");
  expectTooMany({draw(3, 0x40000000, 0), draw(3, 0x40000000, 0), draw(3, 0x40000000, 0)}, "2^31");
  expectTooMany(std::vector(5, draw(3, 0x40000000, 0)), "2^31"); // the sum comes round
  expectTooMany({draw(3, 0x40000000, 0)}, "table");
  // Large draws of which nothing is drawn are as if they were not there.
  RasterScene none = scene;
  none.draws.push_back(draw(kAll, 0, kAll));
  none.draws.push_back(draw(2, 0x40000000, 1));
  none.draws.push_back(draw(1, kAll, 0, VITRAIL_VK_RASTER_LINES));
  none.draws.push_back(draw(0, kAll, 0));
  host.setScene(none);
  host.draw();
  expectPicture(host, rectangles, scene);
}

TEST_F(RasterTest, ExtentsOfAllForms) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, VkExtent2D{7, 3}, VkExtent2D{16384, 1}, VkExtent2D{1, 16384}}) {
    SCOPED_TRACE(testing::Message() << extent.width << 'x' << extent.height);
    RasterHostDesc desc;
    desc.width = extent.width;
    desc.height = extent.height;
    RasterHost host(desc);
    // A triangle over all of it, and one over a fourth.
    RasterScene scene = showing(0);
    scene.vertices = {{-1.0F, -1.0F, 0.5F, 1.0F},  {3.0F, -1.0F, 0.5F, 1.0F},  {-1.0F, 3.0F, 0.5F, 1.0F},
                      {-1.0F, -1.0F, 0.25F, 1.0F}, {0.0F, -1.0F, 0.25F, 1.0F}, {-1.0F, 0.0F, 0.25F, 1.0F}};
    scene.indices = {0, 1, 2, 3, 4, 5};
    scene.draws[0].vertexCount = 6;
    scene.colors[0] = {1.0F, 1.0F, 1.0F, 0.5F};
    scene.behind = {0.0F, 0.0F, 0.0F, 1.0F};
    host.setScene(scene);
    host.draw();
    std::uint32_t once = 0;
    std::uint32_t twice = 0;
    for (std::uint32_t y = 0; y < extent.height; ++y) {
      for (std::uint32_t x = 0; x < extent.width; ++x) {
        once += host.at(x, y)[0] == 0.5F ? 1 : 0;
        twice += host.at(x, y)[0] == 0.75F ? 1 : 0;
      }
    }
    EXPECT_EQ(once + twice, extent.width * extent.height);
    EXPECT_LE(twice, extent.width * extent.height / 2);
  }
}

// What a frame needed long ago is given back, but not what there is from the start: who turns back sees no gap.
TEST_F(RasterTest, RoomFromTheStartStays) {
  RasterHost host({});
  const std::vector<Rectangle> rectangles = someRectangles(8);
  const RasterScene scene = sceneOf(rectangles, Form::Indices);
  RasterScene away = scene;
  for (Vec4& vertex : away.vertices) vertex[0] += 8.0F;
  host.setScene(away);
  host.draw();
  const VkDeviceSize before = host.raster().memory().tileBytes;
  for (int i = 0; i < 130; ++i) {
    host.drawOnce();
    ASSERT_EQ(host.raster().update(), VK_SUCCESS);
  }
  EXPECT_EQ(host.stats().records, 0U);
  EXPECT_EQ(host.raster().memory().tileBytes, before);
  host.setScene(scene);
  host.drawOnce();
  EXPECT_EQ(host.stats().exact, VK_TRUE);
  expectPicture(host, rectangles, scene);
}

// ---- Bands of frames that stay alike

constexpr std::uint32_t kTilesSide = 64; // pixels of the picture
constexpr std::uint32_t kTies = 40;      // more than registers hold of any tile

// In each of so many tiles triangles at one depth, over one pixel or all of them, which makes it a deep one.
RasterScene deepTilesOf(std::uint32_t tiles, float pixels) {
  RasterScene scene;
  const float step = 2.0F / static_cast<float>(kTilesSide);
  for (std::uint32_t tile = 0; tile < tiles; ++tile) {
    const float x = place(tile % (kTilesSide / 8) * 8, kTilesSide);
    const float y = place(tile / (kTilesSide / 8) * 8, kTilesSide);
    for (std::uint32_t i = 0; i < kTies; ++i) {
      scene.vertices.insert(
          scene.vertices.end(),
          {{x, y, 0.5F, 1.0F}, {x + 2.0F * pixels * step, y, 0.5F, 1.0F}, {x, y + 2.0F * pixels * step, 0.5F, 1.0F}});
    }
  }
  scene.indices.resize(scene.vertices.size());
  std::iota(scene.indices.begin(), scene.indices.end(), 0U);
  VitrailVkRasterDraw draw{};
  draw.count = draw.vertexCount = static_cast<std::uint32_t>(scene.vertices.size());
  draw.instanceCount = 1;
  scene.draws = {draw};
  scene.colors = {{0.5F, 0.25F, 1.0F, 0.125F}};
  return scene;
}

// Deep tiles bound the bands, records and fragments have room for fewer: who tries fewer bands sees that, and a picture
// that stays as it is stays exact.
TEST_F(RasterTest, BandsThatDeepTilesBoundStay) {
  RasterHostDesc desc;
  desc.width = desc.height = kTilesSide;
  desc.hints.triangles = 2'600; // room for twice as many records
  desc.memoryBudget = 250'000;  // of which 64 deep tiles take 197,632
  RasterHost host(desc);
  host.setScene(deepTilesOf(6, 4.0F)); // many fragments, in few tiles
  host.draw();
  const RasterScene scene = deepTilesOf(64, 1.0F);
  host.setScene(scene);
  const std::vector<float> expected = host.draw();
  const std::uint32_t bands = host.raster().bands();
  EXPECT_GT(bands, 1U);
  EXPECT_GT(host.stats().deepTiles, 0U);
  for (int i = 0; i < 130; ++i) {
    ASSERT_EQ(host.raster().update(), VK_SUCCESS);
    host.drawOnce();
    ASSERT_EQ(host.stats().exact, VK_TRUE) << i;
  }
  EXPECT_TRUE(host.picture() == expected);
  EXPECT_EQ(host.raster().bands(), bands);
  // Fewer, where all has room, and none of the frames between is inexact.
  host.setScene(deepTilesOf(2, 1.0F));
  for (int i = 0; i < 130 * 5; ++i) {
    ASSERT_EQ(host.raster().update(), VK_SUCCESS);
    if (host.raster().bands() == 1) break;
    host.drawOnce();
    ASSERT_EQ(host.stats().exact, VK_TRUE) << i;
  }
  EXPECT_EQ(host.raster().bands(), 1U);
}

// ---- Frames that are dropped, begun again, or left open

// The frame before one that was dropped may still be drawn: its memory stays.
TEST_F(RasterTest, DroppedFramesLeaveTheMemoryOfThoseBefore) {
  RasterHostDesc desc;
  desc.width = desc.height = 64;
  RasterHost host(desc);
  host.setScene(sceneOf(someRectangles(30, 64), Form::Indices, false, 64));
  host.draw();
  host.info().frame = 50;
  host.drawOnce(); // as if it were pending
  host.info().frame = 51;
  host.recordAll(host.commands().begin()); // never submitted
  ASSERT_EQ(host.raster().resize({8, 8}), VK_SUCCESS);
  EXPECT_GT(host.raster().memory().retiredBytes, 0U);
  host.drawOnce(); // the same number again
  EXPECT_GT(host.raster().memory().retiredBytes, 0U);
  host.info().frame = 52;
  host.drawOnce();
  EXPECT_EQ(host.raster().memory().retiredBytes, 0U);
}

// Numbers that go back name new frames: what an old one of the number has left is not taken for theirs.
TEST_F(RasterTest, NumbersThatGoBack) {
  RasterHost host({});
  host.setScene(sceneOf(someRectangles(8), Form::Indices));
  host.draw();
  for (const std::uint64_t frame : {60, 61, 62}) {
    host.info().frame = frame;
    host.drawOnce();
  }
  VitrailVkRasterStats stats{};
  ASSERT_EQ(host.raster().readStats(60, stats), VK_SUCCESS);
  EXPECT_EQ(stats.exact, VK_TRUE);
  host.info().frame = 60;
  host.recordAll(host.commands().begin());
  expectOneLine("frame numbers rise");
  EXPECT_EQ(host.raster().readStats(60, stats), VK_NOT_READY);
  host.commands().execute();
  EXPECT_EQ(host.raster().readStats(60, stats), VK_SUCCESS);
  // The same number each time, as a host may do that waits for each picture: it gets room, too.
  host.setScene(sceneOf(someRectangles(2000), Form::Indices));
  for (int i = 0; i < 12; ++i) {
    host.drawOnce();
    ASSERT_EQ(host.raster().readStats(60, stats), VK_SUCCESS);
    if (stats.exact == VK_TRUE) break;
    ASSERT_EQ(host.raster().update(60), VK_SUCCESS);
  }
  EXPECT_EQ(stats.exact, VK_TRUE);
  host.recordAll(host.commands().begin());
  EXPECT_EQ(host.raster().readStats(60, stats), VK_NOT_READY);
  host.commands().execute();
  EXPECT_EQ(host.raster().readStats(60, stats), VK_SUCCESS);
}

// A raster that draws in several bands, and its picture.
RasterHostDesc bandedDesc() {
  RasterHostDesc desc;
  desc.width = desc.height = 64;
  desc.memoryBudget = 30'000;
  return desc;
}
constexpr std::uint32_t kOfBands = 60; // rectangles

void recordBand(RasterHost& host, std::uint32_t band, std::uint32_t count = 1) {
  host.info().firstBand = band;
  host.info().bandCount = count;
  host.commands().run([&](VkCommandBuffer commands) {
    if (band == 0) {
      host.recordAll(commands);
    } else {
      host.recordMore(commands);
    }
  });
}

// What comes between the bands of a frame does not change it, or ends it.
TEST_F(RasterTest, CallsBetweenBands) {
  RasterHost host(bandedDesc());
  host.setScene(sceneOf(someRectangles(kOfBands, 64), Form::VertexOffsets, false, 64));
  const std::vector<float> expected = host.draw();
  const std::uint32_t bands = host.raster().bands();
  ASSERT_GT(bands, 2U);

  // An update: the frame before has told of less room than it needs now.
  host.setScene(sceneOf(someRectangles(2 * kOfBands, 64), Form::VertexOffsets, false, 64));
  host.drawOnce();
  EXPECT_EQ(host.stats().exact, VK_FALSE);
  host.setScene(sceneOf(someRectangles(kOfBands, 64), Form::VertexOffsets, false, 64));
  for (std::uint32_t band = 0; band < bands; ++band) {
    recordBand(host, band);
    ASSERT_EQ(host.raster().update(), VK_SUCCESS);
    if (band + 1 == bands) break;
    EXPECT_EQ(host.raster().bands(), bands);
  }
  host.readPicture();
  EXPECT_TRUE(host.picture() == expected);

  // Another extent.
  host.info().firstBand = host.info().bandCount = 0;
  EXPECT_TRUE(host.draw() == expected);
  recordBand(host, 0);
  ASSERT_EQ(host.raster().resize({64, 56}), VK_SUCCESS);
  recordBand(host, 1);
  expectOneLine("in order");
  EXPECT_EQ(host.stats().misused, VK_TRUE);
  ASSERT_EQ(host.raster().resize({64, 64}), VK_SUCCESS);

  // A frame that lacks something, with the next bands of the one before.
  host.info().firstBand = host.info().bandCount = 0;
  EXPECT_TRUE(host.draw() == expected);
  const VitrailVkRasterInfo right = host.info();
  recordBand(host, 0);
  host.info().color = VK_NULL_HANDLE;
  recordBand(host, 0);
  expectOneLine("color");
  host.info().color = right.color;
  recordBand(host, 1);
  expectOneLine("in order");
  EXPECT_EQ(host.stats().exact, VK_FALSE);

  // What is not the same in all bands.
  recordBand(host, 0);
  host.info().drawCount = 0;
  recordBand(host, 1, host.raster().bands() - 1);
  expectOneLine("first band");
  EXPECT_EQ(host.stats().exact, VK_FALSE);
  host.info().drawCount = right.drawCount;
  recordBand(host, 0);
  host.info().frame = 1000;
  recordBand(host, 1);
  expectOneLine("first band");
  host.info().frame = 0;
  recordBand(host, 0);
  recordBand(host, 1, 0xffffffffU);
  expectOneLine("in order");
  EXPECT_EQ(host.stats().exact, VK_FALSE);
  host.info() = right;
  EXPECT_TRUE(host.draw() == expected);
}

// A call that records nothing is of its own frame: the one before has its statistics, and is followed.
TEST_F(RasterTest, MisusedFramesHideNoOthers) {
  RasterHost host({});
  VitrailVkRasterStats stats{};
  const auto expectStats = [&](std::uint64_t frame, VkBool32 misused) {
    ASSERT_EQ(host.raster().readStats(frame, stats), VK_SUCCESS) << frame;
    EXPECT_EQ(stats.frame, frame);
    EXPECT_EQ(stats.misused, misused) << frame;
  };
  // Of bands that are not there, of a frame that the library numbers and of one that the host does.
  host.setScene(sceneOf(someRectangles(8), Form::Indices));
  host.draw();
  const std::uint64_t last = host.stats().frame;
  host.info().firstBand = 1;
  host.commands().run([&](VkCommandBuffer commands) { host.record(commands); });
  expectOneLine("in order");
  EXPECT_EQ(host.stats().frame, last + 1);
  EXPECT_EQ(host.stats().misused, VK_TRUE);
  expectStats(last, VK_FALSE);
  EXPECT_EQ(stats.exact, VK_TRUE);
  host.info().firstBand = 0;
  host.info().frame = 50;
  host.drawOnce();
  host.info().frame = 51;
  host.info().firstBand = 1;
  host.commands().run([&](VkCommandBuffer commands) { host.record(commands); });
  expectOneLine("in order");
  expectStats(51, VK_TRUE);
  expectStats(50, VK_FALSE);
  EXPECT_EQ(stats.exact, VK_TRUE);
  // Nor does it stand between a frame without room and the next.
  host.info().firstBand = 0;
  host.setScene(sceneOf(someRectangles(2000), Form::VertexOffsets));
  std::uint64_t frame = 60;
  for (int i = 0; i < 12; ++i) {
    host.info().frame = ++frame;
    host.drawOnce();
    expectStats(frame, VK_FALSE);
    if (stats.exact == VK_TRUE) break;
    const VitrailVkRasterInfo right = host.info();
    host.info().frame = ++frame;
    host.info().color = VK_NULL_HANDLE;
    host.commands().run([&](VkCommandBuffer commands) { host.record(commands); });
    expectOneLine("color");
    expectStats(frame, VK_TRUE);
    host.info() = right;
    ASSERT_EQ(host.raster().update(frame + 1), VK_SUCCESS);
  }
  EXPECT_EQ(stats.exact, VK_TRUE);
}

// Of a frame that was left open bands may be drawn: the next one has memory and sets of its own.
TEST_F(RasterTest, OpenFramesAreNotDropped) {
  RasterHost host(bandedDesc());
  Commands second(backend().device());
  host.setScene(sceneOf(someRectangles(kOfBands, 64), Form::VertexOffsets, false, 64));
  const std::vector<float> expected = host.draw();
  ASSERT_GT(host.raster().bands(), 1U);
  host.info().bandCount = 1;
  host.recordAll(second.begin()); // and no other band
  host.info().bandCount = 0;
  host.recordAll(host.commands().begin());
  second.execute();
  host.commands().execute();
  host.readPicture();
  EXPECT_EQ(host.stats().exact, VK_TRUE);
  EXPECT_TRUE(host.picture() == expected);

  // Nor may its bands be drawn: its tables are not there for draws that are the same.
  RasterScene other = sceneOf(someRectangles(kOfBands, 64), Form::VertexOffsets, false, 64);
  std::swap(other.draws.front().word, other.draws.back().word);
  host.setScene(other);
  host.info().bandCount = 1;
  host.recordAll(second.begin());
  host.info().bandCount = 0;
  host.info().sameDraws = VK_TRUE;
  const std::vector<float> swapped = host.draw();
  host.info().sameDraws = VK_FALSE;
  EXPECT_TRUE(host.draw() == swapped);
  EXPECT_FALSE(swapped == expected);
}

// Without solids all draws are of triangles, whatever their flags are: no more indices are read than they have.
TEST_F(RasterTest, FlagsOfSolidsWithoutSolids) {
  const std::vector<Rectangle> rectangles = someRectangles(2);
  RasterScene scene = sceneOf(rectangles, Form::Indices);
  RasterScene first = scene;
  first.draws.resize(1);
  for (const std::uint32_t flag : {VITRAIL_VK_RASTER_LINES, VITRAIL_VK_RASTER_POINTS}) {
    first.draws[0].flags = flag;
    first.draws[0].vertexCount = 8;
    RasterHost host({});
    host.setScene(first);
    host.draw();
    expectPicture(host, {rectangles[0]}, scene);
  }
}

// Small extents after large ones: what is kept for the next large one is within the budget.
TEST_F(RasterTest, SmallerExtentsKeepToTheBudget) {
  const RasterScene scene = sceneOf(someRectangles(100, 256), Form::VertexOffsets, false, 256);
  RasterHostDesc desc;
  desc.width = desc.height = 256;
  RasterHost small(desc);
  small.setScene(scene);
  small.draw();
  desc.width = desc.height = 512; // whose tiles take 466,944 bytes more
  desc.memoryBudget = small.raster().memory().tileBytes;
  RasterHost host(desc);
  ASSERT_EQ(host.raster().resize({256, 256}), VK_SUCCESS);
  host.setScene(scene);
  host.draw();
  EXPECT_EQ(host.stats().bands, 1U);
  EXPECT_LE(host.raster().memory().tileBytes, desc.memoryBudget + 4096U);
}

// A row of tiles with room for its records, but not for pages, which leave places free: records are counted, and lie
// side by side. Where they have been few for long there are pages again.
TEST_F(RasterTest, RecordsWithoutRoomForPagesAreCounted) {
  std::vector<Rectangle> rectangles = someRectangles(1000);
  for (std::uint32_t i = 0; i < rectangles.size(); ++i) { // of 2 x 2 pixels: no tile is deep
    rectangles[i].left = i % 7;
    rectangles[i].top = i / 7 % 7;
    rectangles[i].right = rectangles[i].left + 2;
    rectangles[i].bottom = rectangles[i].top + 2;
  }
  const RasterScene scene = sceneOf(rectangles, Form::VertexOffsets, false, 8);
  const RasterScene small = sceneOf({rectangles.begin(), rectangles.begin() + 4}, Form::VertexOffsets, false, 8);
  for (const std::uint32_t samples : {1U, 4U}) {
    SCOPED_TRACE(samples);
    RasterHostDesc desc;
    desc.width = desc.height = 8;
    desc.samples = samples;
    RasterHost whole(desc);
    whole.setScene(scene);
    const std::vector<float> expected = whole.draw();
    const VitrailVkRasterStats stats = whole.stats();
    EXPECT_EQ(stats.deepTiles, 0U);
    EXPECT_GE(stats.records, 2000U);
    const std::uint64_t masks = samples > 1 ? 8 * samples : 0;
    desc.memoryBudget = stats.records * (48 + masks);  // of which records take 40
    EXPECT_LT(desc.memoryBudget, 4032 * (37 + masks)); // which pages of 64, 128 and so on take
    RasterHost host(desc);
    for (int turn = 0; turn < 2; ++turn) {
      host.setScene(scene);
      EXPECT_TRUE(host.draw(30) == expected);
      EXPECT_LE(host.raster().memory().tileBytes, desc.memoryBudget + 4096U); // and what is rounded
      const VkDeviceSize counted = host.raster().memory().tileBytes;
      host.setScene(small);
      for (int i = 0; i < 130; ++i) {
        host.drawOnce();
        ASSERT_EQ(host.raster().update(), VK_SUCCESS);
      }
      EXPECT_NE(host.raster().memory().tileBytes, counted); // of places on pages
    }
  }
}

// ---- Draws that are wrong

// Draws once and expects that the frame says so, the log once and with that word, and that the others are drawn.
void expectWrong(RasterHost& host, const RasterScene& scene, const std::string& word) {
  SCOPED_TRACE(word);
  host.setScene(scene);
  host.drawOnce();
  EXPECT_EQ(host.stats().misused, VK_TRUE);
  EXPECT_EQ(host.stats().exact, VK_FALSE);
  EXPECT_EQ(host.stats().draws, scene.draws.size());
  expectOneLine(word);
  ASSERT_EQ(host.raster().update(), VK_SUCCESS);
  host.info().sameDraws = VK_TRUE; // which are still wrong
  host.drawOnce();
  host.info().sameDraws = VK_FALSE;
  EXPECT_EQ(host.stats().misused, VK_TRUE);
}

TEST_F(RasterTest, DrawsWithIndicesOfNoVertices) {
  const std::vector<Rectangle> rectangles = someRectangles(6);
  const std::vector<Rectangle> others(rectangles.begin() + 1, rectangles.end());
  for (const Form form : {Form::VertexOffsets, Form::NoIndices}) {
    const RasterScene scene = sceneOf(rectangles, form);
    RasterScene wrong = scene;
    wrong.draws[0].vertexCount = 1; // which both of its triangles pass
    RasterHostDesc desc;
    if (form == Form::NoIndices) {
      desc.indexType = VK_INDEX_TYPE_NONE_KHR;
      desc.solids = true; // as in other tests, which have such pipelines
    }
    RasterHost host(desc);
    host.setScene(scene);
    host.draw();
    expectWrong(host, wrong, "draw 0 has an index that is not below its vertexCount");
    expectPicture(host, others, scene);
    host.setScene(scene);
    host.drawOnce();
    EXPECT_EQ(host.stats().exact, VK_TRUE);
    EXPECT_EQ(host.stats().misused, VK_FALSE);
    expectWrong(host, wrong, "draw 0 has an index that is not below its vertexCount"); // said again
    desc.keepsPositions = false;                                                       // then nothing depends on it
    RasterHost asks(desc);
    asks.setScene(wrong);
    asks.draw();
    EXPECT_EQ(asks.stats().misused, VK_FALSE);
    expectPicture(asks, rectangles, scene);
  }
  // The last index alone, of a line and of a point.
  RasterHostDesc desc;
  desc.solids = true;
  RasterHost host(desc);
  RasterScene scene = showing(0);
  scene.indices = {0, 1, 2, 3};
  scene.draws[0].count = 4;
  for (const std::uint32_t flags : {VITRAIL_VK_RASTER_LINES, VITRAIL_VK_RASTER_POINTS}) {
    scene.draws[0].flags = flags;
    scene.draws[0].vertexCount = 4;
    host.setScene(scene);
    host.draw();
    EXPECT_EQ(host.stats().misused, VK_FALSE);
    scene.draws[0].vertexCount = 3;
    expectWrong(host, scene, "vertexCount");
  }
}

TEST_F(RasterTest, DrawsWithIndicesBeyondTheBuffer) {
  const std::vector<Rectangle> rectangles = someRectangles(6);
  const std::vector<Rectangle> others(rectangles.begin() + 1, rectangles.end());
  constexpr std::uint32_t kAll = 0xffffffffU;
  for (const VkIndexType type : {VK_INDEX_TYPE_UINT16, VK_INDEX_TYPE_UINT32}) {
    RasterHostDesc desc;
    desc.indexType = type;
    RasterHost host(desc);
    const RasterScene scene = sceneOf(rectangles, Form::FirstIndices);
    host.setScene(scene);
    host.draw();
    for (const auto& [firstIndex, count] : {std::pair{31U, 6U}, {36U, 3U}, {0U, 39U}, {kAll, 3U}, {kAll - 2, 6U}}) {
      RasterScene wrong = scene;
      wrong.draws[0].firstIndex = firstIndex;
      wrong.draws[0].count = count;
      expectWrong(host, wrong, "draw 0 has more indices from firstIndex on than the buffer");
      expectPicture(host, others, scene);
      host.setScene(scene);
      host.draw();
    }
    // Those that are left over are not looked at, nor those of draws of which nothing is drawn.
    RasterScene right = scene;
    right.draws.back().count = 8; // the last of the buffer
    right.draws.push_back(right.draws[0]);
    right.draws.back().firstIndex = kAll;
    right.draws.back().instanceCount = 0;
    host.setScene(right);
    host.draw();
    EXPECT_EQ(host.stats().misused, VK_FALSE);
    expectPicture(host, rectangles, scene);
  }
  // Of 16-bit indices whole words: the last one of a buffer that ends within a word is not there.
  RasterHostDesc desc;
  desc.indexType = VK_INDEX_TYPE_UINT16;
  RasterHost host(desc);
  RasterScene scene = showing(0);
  scene.draws[0].count = 3;
  host.setScene(scene);
  host.draw();
  const Buffer odd(backend().device(), 6, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::Host);
  host.info().indices = odd.get();
  host.drawOnce();
  EXPECT_EQ(host.stats().misused, VK_TRUE);
  expectOneLine("than the buffer");
}

TEST_F(RasterTest, DrawsOfOtherBlendModes) {
  RasterHostDesc desc;
  desc.blendModes = 1U << VITRAIL_BLEND_OVER | 1U << VITRAIL_BLEND_MULTIPLY;
  std::vector<Rectangle> rectangles = someRectangles(6);
  const std::vector<Rectangle> others(rectangles.begin() + 1, rectangles.end());
  RasterHost host(desc);
  const RasterScene scene = sceneOf(rectangles, Form::Indices);
  host.setScene(scene);
  host.draw();
  for (const std::uint32_t blend : {static_cast<std::uint32_t>(VITRAIL_BLEND_ADDITIVE), 4U, 32U, 0xffffffffU}) {
    RasterScene wrong = scene;
    wrong.draws[0].blend = blend;
    expectWrong(host, wrong, "draw 0 has a blend that is none of VitrailVkRasterDesc::blendModes");
    expectPicture(host, others, scene);
    host.setScene(scene);
    host.draw();
  }
  // Of a shader of two fragments nobody looks at it.
  desc.shadesTwice = true;
  RasterHost twice(desc);
  RasterScene right = scene;
  right.draws[0].blend = 77;
  twice.setScene(right);
  twice.draw();
  EXPECT_EQ(twice.stats().misused, VK_FALSE);
  expectPicture(twice, rectangles, scene);
}

// ---- What is refused

TEST_F(RasterTest, WrongFields) {
  RasterHost host({});
  const VitrailVkRasterDesc right = RasterHost::descOf({}, host.layout());
  const auto expectRefused = [&](VkResult code, const std::string& word, const auto& change) {
    VitrailVkRasterDesc desc = right;
    change(desc);
    vitrail::vulkan::Raster raster;
    EXPECT_EQ(vitrail::vulkan::Raster::create(backend().context(backend().allFeatures()), desc, raster), code) << word;
    EXPECT_FALSE(raster) << word;
    expectOneLine(word);
  };
  using Desc = VitrailVkRasterDesc;
  constexpr VkResult kWrong = VK_ERROR_INITIALIZATION_FAILED;
  expectRefused(kWrong, "next", [](Desc& desc) { desc.next = &desc; });
  expectRefused(kWrong, "extent", [](Desc& desc) { desc.extent.height = 0; });
  expectRefused(kWrong, "extent", [](Desc& desc) { desc.extent.width = 16385; });
  expectRefused(VK_ERROR_FEATURE_NOT_PRESENT, "samples",
                [](Desc& desc) { desc.samples = static_cast<VkSampleCountFlagBits>(3); });
  expectRefused(VK_ERROR_FEATURE_NOT_PRESENT, "samples", [](Desc& desc) { desc.samples = VK_SAMPLE_COUNT_16_BIT; });
  expectRefused(VK_ERROR_FORMAT_NOT_SUPPORTED, "colorFormat",
                [](Desc& desc) { desc.colorFormat = VK_FORMAT_R8G8B8A8_UNORM; });
  expectRefused(kWrong, "depthFormat", [](Desc& desc) { desc.depthFormat = VK_FORMAT_R32_SFLOAT; });
  expectRefused(kWrong, "depthOrder", [](Desc& desc) { desc.depthOrder = static_cast<VitrailDepthOrder>(2); });
  expectRefused(kWrong, "setLayoutCount", [](Desc& desc) { desc.setLayoutCount = 8; });
  expectRefused(kWrong, "setLayoutCount", [](Desc& desc) { desc.setLayouts = nullptr; });
  expectRefused(kWrong, "indexType", [](Desc& desc) { desc.indexType = VK_INDEX_TYPE_UINT8_EXT; });
  expectRefused(kWrong, "blendModes", [](Desc& desc) { desc.blendModes = 1U << 4U; });
  expectRefused(kWrong, "framesInFlight", [](Desc& desc) { desc.framesInFlight = VITRAIL_MAX_FRAMES_IN_FLIGHT + 1; });
  const VkDescriptorSetLayout nothing = VK_NULL_HANDLE;
  expectRefused(kWrong, "setLayouts[0]", [&](Desc& desc) { desc.setLayouts = &nothing; });
  const VkSpecializationMapEntry entry{1710, 0, 4};
  const std::uint32_t value = 1;
  const VkSpecializationInfo constants{1, &entry, sizeof(value), &value};
  expectRefused(kWrong, "constant 1710", [&](Desc& desc) { desc.blend.specialization = &constants; });
  expectRefused(kWrong, "setUp:", [](Desc& desc) { desc.setUp = {}; });
  expectRefused(kWrong, "setUpLarge", [](Desc& desc) { desc.setUpLarge.code = nullptr; });
  expectRefused(kWrong, "blend:", [](Desc& desc) { desc.blend.size = 3; });
  expectRefused(kWrong, "blendDeep", [](Desc& desc) { desc.blendDeep.size = 0; });
  // Stages that were compiled for something else.
  expectRefused(kWrong, "blend: compiled with a VITRAIL_RASTER_STAGE of 1",
                [](Desc& desc) { desc.blend = desc.setUp; });
  expectRefused(kWrong, "positions: compiled with a VITRAIL_RASTER_STAGE of 2",
                [](Desc& desc) { desc.positions = desc.setUpLarge; });
  expectRefused(kWrong, "VITRAIL_SET of 1, and setLayoutCount is 0", [](Desc& desc) { desc.setLayoutCount = 0; });
  expectRefused(kWrong, "without VITRAIL_MULTISAMPLED", [](Desc& desc) { desc.samples = VK_SAMPLE_COUNT_4_BIT; });
  RasterHostDesc twice;
  twice.shadesTwice = true;
  expectRefused(kWrong, "unlike VITRAIL_RASTER_FRAGMENTS",
                [&](Desc& desc) { desc.blend = RasterHost::descOf(twice, host.layout()).blend; });
  const std::vector<std::uint32_t> other(right.setUp.code, right.setUp.code + 5);
  expectRefused(kWrong, "setUp: not compiled from", [&](Desc& desc) {
    desc.setUp.code = other.data();
    desc.setUp.size = 20;
  });
}

// A call that lacks something draws nothing, says so once, and its frame says so.
TEST_F(RasterTest, CallsThatLackSomething) {
  RasterHost host({});
  host.setScene(sceneOf(someRectangles(8), Form::Indices));
  host.draw();
  const VitrailVkRasterInfo right = host.info();
  std::uint64_t frame = 100;
  const auto expectRefused = [&](const std::string& word, const auto& change) {
    host.info() = right;
    host.info().frame = ++frame;
    change(host.info());
    host.commands().run([&](VkCommandBuffer commands) { host.record(commands); });
    expectOneLine(word);
    VitrailVkRasterStats stats{};
    EXPECT_EQ(host.raster().readStats(frame, stats), VK_SUCCESS) << word;
    EXPECT_EQ(stats.misused, VK_TRUE) << word;
    EXPECT_EQ(stats.exact, VK_FALSE) << word;
  };
  using Info = VitrailVkRasterInfo;
  expectRefused("color", [](Info& info) { info.color = VK_NULL_HANDLE; });
  expectRefused("depth", [](Info& info) { info.depth = VK_NULL_HANDLE; });
  expectRefused("draws", [](Info& info) { info.draws = VK_NULL_HANDLE; });
  expectRefused("indices", [](Info& info) { info.indices = VK_NULL_HANDLE; });
  expectRefused("sets", [](Info& info) { info.sets = nullptr; });
  expectRefused("clipPlanes", [](Info& info) { info.clipPlaneCount = 1; });
  const float planes[2][4] = {}; // which the stages were compiled for one of
  expectRefused("VITRAIL_CLIP_PLANES of 1", [&](Info& info) {
    info.clipPlaneCount = 2;
    info.clipPlanes = planes;
  });
  expectRefused("offset", [](Info& info) { info.drawOffset = 2; });
  expectRefused("bands", [](Info& info) { info.firstBand = 1; });
  expectRefused("bands", [](Info& info) { info.bandCount = 99; });
  // After all that frames are right again.
  host.info() = right;
  host.info().frame = ++frame;
  host.drawOnce();
  VitrailVkRasterStats stats{};
  EXPECT_EQ(host.raster().readStats(frame, stats), VK_SUCCESS);
  EXPECT_EQ(stats.exact, VK_TRUE);
  EXPECT_EQ(stats.misused, VK_FALSE);
  vitrailVkCmdRaster(VK_NULL_HANDLE, host.raster().handle(), &right);
  expectOneLine("null");
  vitrailVkCmdRaster(VK_NULL_HANDLE, nullptr, &right); // nothing
  EXPECT_EQ(vitrailVkRasterBands(nullptr), 0U);
  EXPECT_EQ(vitrailVkUpdateRaster(nullptr, 0), VK_ERROR_INITIALIZATION_FAILED);
}

} // namespace
} // namespace vitrail::tests::vulkan
