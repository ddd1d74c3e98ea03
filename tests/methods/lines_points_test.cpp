// Lines and points, which every method draws as it draws triangles.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "../../tool/methods/methods.h"
#include "../../tool/scene/load.h"
#include "../../tool/stage/surfaces.h"
#include "../reference/test_scenes.h"
#include "../thorough.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

constexpr std::uint32_t kSize = 32;

using Color = std::array<int, 3>;

Color colorAt(const Picture& picture, std::uint32_t x, std::uint32_t y) {
  const std::size_t first = std::size_t{4} * (y * picture.width + x);
  return {picture.rgba[first], picture.rgba[first + 1], picture.rgba[first + 2]};
}

// The middle of a pixel of the pictures below.
glm::vec3 middleOf(float x, float y) {
  constexpr float step = 2.0F / static_cast<float>(kSize);
  return {(x + 0.5F) * step - 1.0F, 1.0F - (y + 0.5F) * step, 0.0F};
}

// Adds lines or points without normals as an object of its own.
void add(Scene& scene, Primitive primitive, const std::vector<glm::vec3>& positions, const Material& material) {
  Mesh mesh;
  mesh.primitive = primitive;
  mesh.positions = positions;
  for (std::uint32_t i = 0; i < positions.size(); ++i) mesh.indices.push_back(i);
  scene.draws.push_back({.mesh = static_cast<std::uint32_t>(scene.meshes.size()),
                         .material = static_cast<std::uint32_t>(scene.materials.size())});
  scene.meshes.push_back(mesh);
  scene.materials.push_back(material);
}

const Material kBlue = reference::unlitMaterial({0.0F, 0.0F, 1.0F, 1.0F}, AlphaMode::Opaque);
const Material kHalfRed = reference::unlitMaterial({1.0F, 0.0F, 0.0F, 0.5F});

// A line in row 8, a translucent one in row 16; points in row 24, the left opaque, the right translucent.
Scene linesAndPoints() {
  Scene scene;
  scene.pointSize = 5.0F;
  add(scene, Primitive::Lines, {middleOf(-1, 8), middleOf(33, 8)}, kBlue);
  add(scene, Primitive::Lines, {middleOf(-1, 16), middleOf(33, 16)}, kHalfRed);
  add(scene, Primitive::Points, {middleOf(8, 24)}, kBlue);
  add(scene, Primitive::Points, {middleOf(24, 24)}, kHalfRed);
  return scene;
}

RenderOptions straightPicture() {
  RenderOptions picture;
  picture.width = kSize;
  picture.height = kSize;
  picture.view = reference::straightView();
  return picture;
}

void expectLinesAndPoints(const Picture& picture, bool exact) {
  const Color white{255, 255, 255};
  const Color blue{0, 0, 255};
  EXPECT_EQ(colorAt(picture, 20, 8), blue) << "the line";
  EXPECT_EQ(colorAt(picture, 20, 6), white) << "lines are a pixel wide";
  EXPECT_EQ(colorAt(picture, 20, 10), white);
  for (const std::uint32_t x : {6U, 8U, 10U}) EXPECT_EQ(colorAt(picture, x, 24), blue) << "points are five pixels wide";
  for (const std::uint32_t x : {4U, 12U}) EXPECT_EQ(colorAt(picture, x, 24), white);
  for (const auto& [x, y] : {std::pair{20U, 16U}, {22U, 24U}, {26U, 24U}}) {
    SCOPED_TRACE(std::to_string(x) + ", " + std::to_string(y));
    const Color color = colorAt(picture, x, y);
    EXPECT_NEAR(color[0], 255, 3);
    EXPECT_NEAR(color[1], 188, exact ? 3 : 60);
    EXPECT_EQ(color[1], color[2]);
  }
  EXPECT_EQ(colorAt(picture, 20, 14), white);
}

// If not thorough: of those that draw lines by pipelines of one kind, one.
bool drawsLinesInItsOwnWay(std::string_view name) {
  constexpr std::array<std::string_view, 7> kKinds = {kListMethod, "tiles",  "depth-peeling", "weighted",
                                                      "sorted",    "moment", kCpuMethod};
  return std::ranges::find(kKinds, name) != kKinds.end();
}

TEST_F(GpuTest, EveryMethodDrawsLinesAndPoints) {
  const Scene scene = linesAndPoints();
  for (const std::string_view name : methodNames()) {
    if (!drawsLinesInItsOwnWay(name) && !tests::isThorough()) continue;
    if ((name == "interlock" || name == "multi-layer") && !gpu().features().fragmentInterlock) continue;
    for (const std::uint32_t samples : {1U, 4U}) {
      // Kernels of several samples take CPU drivers long: those of lists, if thorough of the library's other method,
      // too.
      const bool isOurs = name == kListMethod || (name == "tiles" && tests::isThorough());
      if (samples > 1 && (!isOurs || (gpu().features().sampleCounts & samples) == 0)) continue;
      SCOPED_TRACE(std::string(name) + ", " + std::to_string(samples) + " samples");
      MethodOptions method;
      method.name = name;
      method.samples = samples;
      const RenderResult result = renderOnce(gpu(), scene, straightPicture(), {}, DrawOrder::Forward, method);
      expectLinesAndPoints(result.picture, name != "stochastic");
      EXPECT_TRUE(result.report.warnings.empty());
    }
  }
}

TEST_F(GpuTest, SamplesOfLinesAreResolvedInEitherWay) {
  for (const MethodOptions& method : methodVariety(gpu())) {
    SCOPED_TRACE(describe(method));
    expectLinesAndPoints(
        renderOnce(gpu(), linesAndPoints(), straightPicture(), {}, DrawOrder::Reversed, method).picture, true);
  }
}

TEST_F(GpuTest, LinesAndPointsWithNormalsAreLitAndHaveTheirVertexColours) {
  Scene scene;
  scene.pointSize = 5.0F;
  Material lit;
  lit.metallic = 0.0F;
  for (const Primitive primitive : {Primitive::Lines, Primitive::Points})
    add(scene, primitive,
        {middleOf(4, primitive == Primitive::Lines ? 8.0F : 24.0F),
         middleOf(28, primitive == Primitive::Lines ? 8.0F : 24.0F)},
        lit);
  for (Mesh& mesh : scene.meshes) mesh.colors.assign(2, packColor({1.0F, 0.0F, 0.0F, 1.0F}));
  const Picture unlit = renderOnce(gpu(), scene, straightPicture()).picture;
  for (Mesh& mesh : scene.meshes) mesh.normals.assign(2, packDirection({0.0F, 0.0F, 1.0F}));
  const Picture shaded = renderOnce(gpu(), scene, straightPicture()).picture;
  for (const auto& [x, y] : {std::pair{16U, 8U}, {28U, 24U}}) {
    EXPECT_EQ(colorAt(unlit, x, y), (Color{255, 0, 0}));
    const Color color = colorAt(shaded, x, y);
    EXPECT_GT(color[0], 150);
    EXPECT_LT(color[0], 250);
    EXPECT_GT(color[1], 5) << "the surface reflects white light";
    EXPECT_LT(color[1], 100);
  }
}

TEST_F(GpuTest, PointsLargerThanTheDeviceDrawsAreDrawnAsLargeAsItCanWithOneLine) {
  const float largest = drawnPointSize(gpu(), 65536.0F);
  if (largest == 65536.0F) GTEST_SKIP() << "the device draws points of any size";
  Scene scene = linesAndPoints();
  scene.pointSize = 65536.0F;
  const RenderResult result = renderOnce(gpu(), scene, straightPicture());
  ASSERT_EQ(result.report.warnings.size(), 1U);
  EXPECT_TRUE(result.report.warnings[0].starts_with("points of 65536 pixels are drawn with "))
      << result.report.warnings[0];
  scene.draws.resize(2);
  EXPECT_TRUE(renderOnce(gpu(), scene, straightPicture()).report.warnings.empty()) << "there are no points";
}

// The line lies along the edge between two rows of pixels.
TEST_F(GpuTest, ALineBesideTrianglesIsSeenInTheRowBelowItsEdge) {
  const Scene scene = loadModel(std::filesystem::path(VITRAIL_TEST_CORPUS) / "good" / "lines_beside_triangles.gltf");
  const RenderOptions options = usualOptions(scene, 64, 64);
  const Picture picture = renderOnce(gpu(), scene, options).picture;
  EXPECT_EQ(colorAt(picture, 48, 16), (Color{255, 0, 0}));
  for (std::uint32_t x = 34; x < 64; ++x) {
    EXPECT_EQ(colorAt(picture, x, 15), (Color{255, 255, 255})) << x;
    EXPECT_EQ(colorAt(picture, x, 17), (Color{255, 255, 255})) << x;
  }
  EXPECT_EQ(colorAt(picture, 16, 48), (Color{255, 0, 0})) << "the triangles";
}

} // namespace
} // namespace vitrail::tool::test
