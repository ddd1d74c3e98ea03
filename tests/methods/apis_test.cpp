// Pictures by OpenGL are those by Vulkan: the same shading, the same library, one rule. Where neighbouring pixels
// differ much, rounding may move an edge by a pixel: there a few pixels may differ by more, and the test says how many.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "../../tool/methods/methods.h"
#include "../../tool/scene/builtin/builtin.h"
#include "../../tool/scene/builtin/shapes.h"
#include "../reference/test_scenes.h"
#include "../thorough.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::straightView;
using reference::unlitMaterial;

constexpr int kEdge = 8;              // of 255: how much neighbours differ along an edge
constexpr double kMostAtEdges = 2e-3; // of a picture's pixels

struct Pixels {
  std::size_t beyondAway = 0; // that differ by more than 1/255 away from edges,
  std::size_t beyondAtEdges = 0;
};

int differenceAt(const Picture& a, std::size_t at, const Picture& b, std::size_t other) {
  int most = 0;
  for (std::size_t c = 0; c < 4; ++c) most = std::max(most, std::abs(int{a.rgba[at + c]} - b.rgba[other + c]));
  return most;
}

bool isAtEdge(const Picture& picture, std::uint32_t x, std::uint32_t y) {
  const std::size_t at = (std::size_t{y} * picture.width + x) * 4;
  for (std::uint32_t v = y - std::min(y, 1U); v <= std::min(y + 1, picture.height - 1); ++v) {
    for (std::uint32_t u = x - std::min(x, 1U); u <= std::min(x + 1, picture.width - 1); ++u) {
      const std::size_t near = (std::size_t{v} * picture.width + u) * 4;
      if (differenceAt(picture, at, picture, near) >= kEdge) return true;
    }
  }
  return false;
}

Pixels compare(const Picture& a, const Picture& b) {
  Pixels result;
  for (std::uint32_t y = 0; y < a.height; ++y) {
    for (std::uint32_t x = 0; x < a.width; ++x) {
      const std::size_t at = (std::size_t{y} * a.width + x) * 4;
      if (differenceAt(a, at, b, at) <= 1) continue;
      ++(isAtEdge(a, x, y) || isAtEdge(b, x, y) ? result.beyondAtEdges : result.beyondAway);
    }
  }
  return result;
}

class ApisTest : public GpuTest {
 protected:
  static void expectSame(const std::string& name, const Scene& scene, const RenderOptions& picture,
                         MethodOptions method = {}, double mostAtEdges = kMostAtEdges) {
    SCOPED_TRACE(name + ", " + method.name + ", " + describe(method));
    method.api = Api::Vulkan;
    const RenderResult vulkan = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, method);
    method.api = Api::OpenGl;
    const RenderResult openGl = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, method);
    EXPECT_EQ(openGl.report.method, vulkan.report.method);
    EXPECT_NE(openGl.report.api.find("OpenGL"), std::string::npos);
    EXPECT_EQ(openGl.report.fragmentsMissing, 0U);
    EXPECT_EQ(openGl.report.complete, vulkan.report.complete);
    EXPECT_EQ(openGl.isEmpty, vulkan.isEmpty);
    const Pixels differing = compare(vulkan.picture, openGl.picture);
    EXPECT_EQ(differing.beyondAway, 0U);
    EXPECT_LE(static_cast<double>(differing.beyondAtEdges), mostAtEdges * picture.width * picture.height);
    if (differing.beyondAtEdges > 0) {
      std::printf("  %s, %s: %zu of %u pixels differ by more than 1/255, all at edges\n", name.c_str(),
                  method.name.c_str(), differing.beyondAtEdges, picture.width * picture.height);
    }
  }
};

// Every scene by lists, and one, or if thorough each, by every method that OpenGL has.
class ScenesApisTest : public ApisTest, public ::testing::WithParamInterface<std::string> {};

TEST_P(ScenesApisTest, PicturesAreTheSame) {
  BuiltinOptions small;
  if (GetParam() == "spheres") small.count = 24;
  if (GetParam() == "hairball") small.count = 60;
  if (GetParam() == "smoke" || GetParam() == "flames") small.count = 40;
  const Scene scene = makeBuiltinScene(GetParam(), small);
  const RenderOptions picture = usualOptions(scene, 160, 90);
  for (const std::string_view name : methodNames()) {
    if (traitsOf(name).makeGl == nullptr) continue;
    if (name != kListMethod && GetParam() != "mannequins" && !tests::isThorough()) continue;
    MethodOptions method;
    method.name = name;
    expectSame(GetParam(), scene, picture, method);
  }
}

INSTANTIATE_TEST_SUITE_P(Apis, ScenesApisTest,
                         ::testing::Values("spheres", "planes", "interlocked", "mannequins", "hairball", "smoke",
                                           "flames"),
                         [](const auto& scene) { return scene.param; });

// Every node format, resolve, list build and kind of multisampling, or, if not thorough, every second one.
TEST_F(ApisTest, WaysToDrawListsAreTheSame) {
  const Scene scene = makeBuiltinScene("mannequins", {});
  std::size_t number = 0;
  for (const MethodOptions& method : methodVariety(gpu())) {
    if (number++ % 2 == 1 && !tests::isThorough()) continue;
    if ((gl().limits().sampleCounts & method.samples) == 0) continue;
    expectSame("mannequins", scene, usualOptions(scene, 112, 63), method);
  }
}

TEST_F(ApisTest, TilesAreTheSame) {
  const Scene scene = makeBuiltinScene("mannequins", {});
  RenderOptions picture = usualOptions(scene, 160, 90);
  for (const std::uint32_t samples : {1U, 4U}) {
    MethodOptions method;
    method.api = Api::OpenGl;
    method.samples = samples;
    picture.memoryBudget.reset();
    const RenderResult whole = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, method);
    picture.memoryBudget = 1U << 17U;
    const RenderResult tiled = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, method);
    EXPECT_EQ(whole.report.tiles, 1U);
    EXPECT_GT(tiled.report.tiles, 1U);
    EXPECT_TRUE(tiled.picture.rgba == whole.picture.rgba) << samples;
    EXPECT_EQ(tiled.report.fragmentsStored, whole.report.fragmentsStored);
  }
}

// A resolve of the host's own, with one sample and, if thorough, with several, whose kernels take CPU drivers long;
// from outside and from inside of what absorbs.
TEST_F(ApisTest, VolumesAreTheSame) {
  Scene scene;
  scene.meshes.push_back(uvSphere(24, 12));
  Material glass;
  glass.metallic = 0.0F;
  glass.roughness = 0.4F;
  glass.transmission = 0.9F;
  glass.thickness = 1.0F;
  glass.attenuationDistance = 1.0F;
  glass.attenuationColor = {0.3F, 0.8F, 0.5F};
  scene.materials.push_back(glass);
  for (const float x : {-0.4F, 0.5F}) {
    scene.draws.emplace_back();
    scene.draws.back().transform[3].x = x;
  }
  addRectangle(scene, {glm::vec2(-2.0F, -0.2F), glm::vec2(2.0F, 0.3F), -0.2F}, unlitMaterial({0.9F, 0.5F, 0.2F, 1.0F}));
  RenderOptions picture;
  picture.width = 80;
  picture.height = 60;
  for (const View& view : {straightView(), reference::wideView()}) {
    picture.view = view;
    for (const std::uint32_t samples : {1U, 4U}) {
      if (samples > 1 && !tests::isThorough()) continue;
      MethodOptions method;
      method.samples = samples;
      expectSame("volumes", scene, picture, method);
    }
  }
}

// OpenGL's lines take the pixels that their diamonds say, Vulkan's those whose middles lie in a rectangle: a line may
// step to the next row a pixel sooner.
TEST_F(ApisTest, LinesAndPointsAreTheSame) {
  for (const Primitive primitive : {Primitive::Lines, Primitive::Points}) {
    Scene scene;
    scene.pointSize = 7.0F;
    Mesh mesh;
    mesh.primitive = primitive;
    for (int i = 0; i < 24; ++i) {
      const auto t = static_cast<float>(i);
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.emplace_back(0.8F * std::sin(t), 0.8F * std::cos(2.3F * t), 0.1F * t);
    }
    scene.meshes.push_back(mesh);
    scene.materials.push_back(unlitMaterial({1.0F, 0.2F, 0.0F, 0.3F}));
    scene.draws.emplace_back();
    RenderOptions picture;
    picture.width = picture.height = 128;
    picture.view = straightView();
    const bool lines = primitive == Primitive::Lines;
    expectSame(lines ? "lines" : "points", scene, picture, {}, lines ? 0.02 : kMostAtEdges);
  }
}

TEST_F(ApisTest, ClippedScenesAreTheSame) {
  Scene scene = makeBuiltinScene("interlocked", {});
  scene.clipPlanes = {glm::dvec4(1.0, 0.2, 0.0, 0.1), glm::dvec4(0.0, -1.0, 0.3, 0.4)};
  expectSame("clipped", scene, usualOptions(scene, 160, 90));
}

// 16-bit pictures, and those without a background.
TEST_F(ApisTest, EncodingsAreTheSame) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  RenderOptions picture = usualOptions(scene, 96, 54);
  picture.background.kind = Background::Kind::Transparent;
  expectSame("transparent background", scene, picture);
  for (const Encoding encoding : {Encoding::Srgb16, Encoding::Linear}) {
    picture.encoding = encoding;
    MethodOptions method;
    const RenderResult vulkan = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, method);
    method.api = Api::OpenGl;
    const RenderResult openGl = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, method);
    ASSERT_EQ(openGl.deep.rgba.size(), vulkan.deep.rgba.size());
    std::size_t differ = 0;
    for (std::size_t i = 0; i < vulkan.deep.rgba.size(); ++i) {
      differ += std::abs(int{vulkan.deep.rgba[i]} - openGl.deep.rgba[i]) > (encoding == Encoding::Linear ? 16 : 257);
    }
    EXPECT_LE(static_cast<double>(differ), kMostAtEdges * static_cast<double>(vulkan.deep.rgba.size()));
  }
}

} // namespace
} // namespace vitrail::tool::test
