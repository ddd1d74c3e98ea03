// What methods that count first promise beyond the table of methods_test.cpp: more surfaces in a pixel than a stencil
// counts, images that take several steps to reduce or to sum up, surfaces at equal depths, and stopping early.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "../../tool/scene/builtin/builtin.h"
#include "../reference/test_scenes.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::straightView;
using reference::unlitMaterial;

struct Pane {
  glm::vec4 color;
  float z = 0.0F;
  bool adds = false;
};

Scene stackOf(const std::vector<Pane>& panes) {
  Scene scene;
  for (const Pane& pane : panes) {
    Material material = unlitMaterial(pane.color);
    if (pane.adds) material.blend = BlendMode::Additive;
    addRectangle(scene, {glm::vec2(-0.8F), glm::vec2(0.7F), pane.z}, material);
  }
  return scene;
}

// 260 panes at depths of their own as two draws, neither in the order of depths.
Scene manyPanes() {
  Scene scene = stackOf({{{0.9F, 0.3F, 0.1F, 0.01F}}, {{0.1F, 0.5F, 0.9F, 0.02F}}});
  for (int half = 0; half < 2; ++half) {
    Mesh& mesh = scene.meshes[static_cast<std::size_t>(half)];
    const Mesh pane = std::exchange(mesh, {});
    for (int i = 0; i < 130; ++i) {
      const int place = 2 * (i * 77 % 130) + half;
      const auto base = static_cast<std::uint32_t>(mesh.vertexCount());
      for (Vertex vertex : pane.vertices()) {
        vertex.position.z = -6.0F + 12.0F * static_cast<float>(place) / 259.0F;
        mesh.add(vertex);
      }
      for (const std::uint32_t index : pane.indices) mesh.indices.push_back(base + index);
    }
  }
  return scene;
}

RenderOptions straightOn(std::uint32_t width, std::uint32_t height) {
  RenderOptions picture;
  picture.width = width;
  picture.height = height;
  picture.view = straightView();
  picture.background.srgb = {0.2F, 0.6F, 0.4F};
  return picture;
}

MethodOptions named(const std::string& name) {
  MethodOptions method;
  method.name = name;
  return method;
}

// Lists that store colours as a method does: as finely as layers are kept, or in the standard nodes of an a-buffer.
MethodOptions exactLists(const std::string& method = {}) {
  MethodOptions lists;
  lists.listBuild = VITRAIL_LIST_BUILD_FRAGMENT; // colours are rounded once
  if (method == "a-buffer") lists.nodes = VITRAIL_NODE_STANDARD;
  return lists;
}

class SeveralPasses : public GpuTest, public ::testing::WithParamInterface<std::string> {
 protected:
  static RenderResult draw(const Scene& scene, const RenderOptions& picture, const MethodOptions& method) {
    return renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, method);
  }

  static void expectLikeLists(const Scene& scene, const RenderOptions& picture, int tolerance = 1) {
    const RenderResult result = draw(scene, picture, named(GetParam()));
    const RenderResult lists = draw(scene, picture, exactLists(GetParam()));
    EXPECT_LE(largestDifference(result.picture, lists.picture), GetParam() == "a-buffer" ? 0 : tolerance);
    EXPECT_TRUE(result.report.complete);
    EXPECT_EQ(result.report.layersMax, lists.report.layersMax);
    EXPECT_EQ(result.report.fragmentsStored, lists.report.fragmentsStored);
    EXPECT_EQ(result.report.fragmentsMissing, 0U);
    EXPECT_NEAR(result.report.layersMean, lists.report.layersMean, 1e-9);
  }
};

TEST_P(SeveralPasses, ThereMayBeMoreSurfacesThanAStencilCounts) {
  expectLikeLists(manyPanes(), straightOn(12, 9), 2); // 16-bit floats round 260 times
}

// More pixels than two steps of a reduction or of a prefix sum, 512 items each, take to one. Strips of all colours, so
// that no pixel's fragments can be taken for another's.
TEST_P(SeveralPasses, PicturesMayBeLarge) {
  Scene scene;
  for (int i = 0; i < 12; ++i) {
    const float t = static_cast<float>(i) / 11.0F;
    const float left = -1.3F + 2.0F * t;
    addRectangle(scene, {glm::vec2(left, -0.9F + 0.5F * t), glm::vec2(left + 0.5F, 1.0F - 0.6F * t), 5.0F - t},
                 unlitMaterial({t, 0.5F, 1.0F - t, 0.2F + 0.6F * t}));
  }
  expectLikeLists(scene, straightOn(601, 443));
}

// Equal ones: the order among them is of no consequence, but none may be lost.
TEST_P(SeveralPasses, EqualSurfacesAtOneDepthAllCount) {
  const Pane pane{{0.9F, 0.4F, 0.1F, 0.25F}, 0.5F};
  const Pane glow{{0.1F, 0.1F, 0.3F, 0.4F}, -0.5F, true};
  const Scene scene = stackOf({pane, glow, pane, {{0.2F, 0.3F, 0.8F, 0.6F}, -1.0F}, glow, pane});
  expectLikeLists(scene, straightOn(24, 16));
}

INSTANTIATE_TEST_SUITE_P(Methods, SeveralPasses,
                         ::testing::Values("depth-peeling", "reverse-depth-peeling", "dual-depth-peeling", "a-buffer"),
                         [](const auto& row) {
                           std::string name = row.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// Three panes at one depth are drawn as if they were a little apart: from the front in the order of submission, or from
// the back.
TEST_F(GpuTest, PeelingKeepsTheOrderOfSubmissionAtOneDepth) {
  const std::vector<glm::vec4> colors{{0.9F, 0.1F, 0.1F, 0.5F}, {0.1F, 0.9F, 0.2F, 0.6F}, {0.1F, 0.2F, 0.9F, 0.7F}};
  const auto panes = [&](float step) {
    std::vector<Pane> result;
    for (std::size_t i = 0; i < colors.size(); ++i) result.push_back({colors[i], step * static_cast<float>(i)});
    return stackOf(result);
  };
  const RenderOptions picture = straightOn(24, 16);
  const auto draw = [&](const Scene& scene, const MethodOptions& method) {
    return renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, method).picture;
  };
  const Picture firstInFront = draw(panes(-0.5F), exactLists());
  const Picture lastInFront = draw(panes(0.5F), exactLists());
  EXPECT_GT(largestDifference(firstInFront, lastInFront), 16);
  EXPECT_LE(largestDifference(draw(panes(0.0F), named("depth-peeling")), firstInFront), 1);
  EXPECT_LE(largestDifference(draw(panes(0.0F), named("reverse-depth-peeling")), lastInFront), 1);
}

TEST_F(GpuTest, StencilRoutedRefusesMoreThanItsStencilCounts) {
  try {
    renderOnce(gpu(), manyPanes(), straightOn(12, 9), {}, DrawOrder::Forward, named("stencil-routed"));
    ADD_FAILURE() << "260 surfaces are taken";
  } catch (const GpuError& error) {
    const std::string reason = error.what();
    EXPECT_NE(reason.find("260"), std::string::npos) << reason;
    EXPECT_NE(reason.find("at most 254"), std::string::npos) << reason;
    EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
  }
}

// Two sheets of glass at one depth that reflect and hide the same and differ in what they tint alone.
TEST_F(GpuTest, StencilRoutedOrdersTintsAtOneDepth) {
  Scene scene = stackOf({{{0.2F, 0.6F, 0.4F, 1.0F}, 0.0F}, {{0.9F, 0.3F, 0.5F, 1.0F}, 0.0F}});
  for (Material& glass : scene.materials) {
    glass.alphaMode = AlphaMode::Opaque;
    glass.unlit = false;
    glass.metallic = 0.0F;
    glass.roughness = 0.3F;
    glass.emissive = glm::vec3(0.3F);
    glass.transmission = 1.0F;
  }
  const auto draw = [&](DrawOrder order) {
    return renderOnce(gpu(), scene, straightOn(24, 16), {}, order, named("stencil-routed")).picture;
  };
  EXPECT_TRUE(draw(DrawOrder::Forward).rgba == draw(DrawOrder::Reversed).rgba);
}

// Surfaces that cross, in several passes. Where samples are drawn by themselves a few pixels on edges may differ.
TEST_F(GpuTest, StencilRoutedIsRightButForEdges) {
  const Scene scene = makeBuiltinScene("interlocked", {});
  const RenderOptions picture = usualOptions(scene, 160, 90);
  const RenderResult routed = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, named("stencil-routed"));
  const RenderResult lists = renderOnce(gpu(), scene, picture, {}, DrawOrder::Forward, exactLists());
  EXPECT_EQ(routed.report.layersMax, lists.report.layersMax);
  EXPECT_GT(routed.report.layersMax, 8U) << "of one pass";
  const bool placed = gpu().features().middleSamples > 1;
  EXPECT_EQ(routed.report.complete, placed);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < routed.picture.rgba.size(); i += 4) {
    int largest = 0;
    for (std::size_t c = i; c < i + 4; ++c) {
      largest = std::max(largest, std::abs(int{routed.picture.rgba[c]} - lists.picture.rgba[c]));
    }
    differ += largest > 1 ? 1 : 0;
  }
  EXPECT_LE(differ, placed ? 0U : 5U) << "of " << routed.picture.rgba.size() / 4 << " pixels";
}

// --layers N draws the nearest N as if there were no others, and the report says what is missing.
TEST_F(GpuTest, DepthPeelingStopsEarly) {
  const std::vector<Pane> panes{{{0.9F, 0.1F, 0.1F, 0.5F}, 3.0F},
                                {{0.1F, 0.9F, 0.2F, 0.4F}, 2.0F},
                                {{0.1F, 0.2F, 0.9F, 0.7F}, 1.0F},
                                {{0.8F, 0.8F, 0.2F, 0.9F}, 0.0F}};
  const RenderOptions picture = straightOn(24, 16);
  MethodOptions two = named("depth-peeling");
  two.maxLayers = 2;
  const auto draw = [&](const std::vector<Pane>& stack, const MethodOptions& method) {
    return renderOnce(gpu(), stackOf(stack), picture, {}, DrawOrder::Forward, method);
  };
  const RenderResult stopped = draw({panes[3], panes[1], panes[0], panes[2]}, two);
  EXPECT_LE(largestDifference(stopped.picture, draw({panes[0], panes[1]}, exactLists()).picture), 1);
  EXPECT_FALSE(stopped.report.complete);
  EXPECT_EQ(stopped.report.layersMax, 4U);
  EXPECT_EQ(stopped.report.fragmentsMissing, stopped.report.fragmentsRequested / 2);
  EXPECT_GT(stopped.report.fragmentsMissing, 0U);
  EXPECT_EQ(stopped.report.approximatePixels, stopped.report.fragmentsMissing / 2);
  two.maxLayers = 4;
  EXPECT_TRUE(draw(panes, two).report.complete);
}

} // namespace
} // namespace vitrail::tool::test
