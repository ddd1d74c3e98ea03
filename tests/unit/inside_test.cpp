// Looking inside: what is picked under a pixel is what the reference finds there, peeled pixels blend what is left, and
// objects are chosen by name.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "cpu/peel.h"
#include "reference/surfaces.h"
#include "reference/test_scenes.h"
#include "render/cpu_still.h"
#include "render/pick.h"
#include "scene/builtin/builtin.h"
#include "scene/objects.h"

namespace vitrail::tool {
namespace {

using namespace reference;

// ---- Picking

struct Wanted {
  std::uint32_t draw;
  double depth;
  double alpha;
};

// The layers of a pixel, to the nearest opaque one. `isSure`: no edge is near, and no two depths are close.
std::vector<Wanted> layersOf(const SurfaceFinder& finder, const glm::dvec2& centre, bool& isSure) {
  std::vector<RayHit> hits;
  const auto at = [&](const glm::dvec2& place) {
    const PixelSurfaces found = finder.find(place, glm::dvec2(0.0), hits);
    const int nearest = found.nearestOpaque[0];
    std::vector<Wanted> layers;
    for (const PixelSurface& surface : found.transparent) {
      if (surface.hidden == 0) layers.push_back({surface.hit.draw, surface.hit.depth, surface.base.a});
    }
    if (nearest >= 0) {
      const RayHit& hit = found.opaque[static_cast<std::size_t>(nearest)].hit;
      layers.push_back({hit.draw, hit.depth, 1.0});
    }
    return layers;
  };
  std::vector<Wanted> layers = at(centre);
  isSure = true;
  for (const glm::dvec2& nudge :
       {glm::dvec2(0.02, 0.0), glm::dvec2(-0.02, 0.0), glm::dvec2(0.0, 0.02), glm::dvec2(0.0, -0.02)}) {
    const std::vector<Wanted> near = at(centre + nudge);
    isSure = isSure && near.size() == layers.size();
    for (std::size_t i = 0; isSure && i < near.size(); ++i) isSure = near[i].draw == layers[i].draw;
  }
  for (std::size_t i = 1; i < layers.size(); ++i) {
    isSure = isSure && layers[i].depth - layers[i - 1].depth > 1.0e-4 * layers[i].depth;
  }
  return layers;
}

void expectPicksTheReference(const Scene& scene, std::optional<float> opacity) {
  ReferenceOptions options;
  options.width = 160;
  options.height = 120;
  options.view = frameScene(scene, Orbit{}, 4.0F / 3.0F);
  options.opacity = opacity;
  const SurfaceFinder finder(scene, options);
  Picker picker(scene, opacity);
  std::mt19937 random(1);
  std::size_t sure = 0;
  std::size_t layers = 0;
  for (int i = 0; i < 400; ++i) {
    const std::uint32_t x = static_cast<std::uint32_t>(random()) % options.width;
    const std::uint32_t y = static_cast<std::uint32_t>(random()) % options.height;
    SCOPED_TRACE(std::to_string(x) + ", " + std::to_string(y));
    bool isSure = false;
    const std::vector<Wanted> wanted = layersOf(finder, {x + 0.5, y + 0.5}, isSure);
    if (!isSure) continue;
    ++sure;
    const std::vector<PickedLayer> picked = picker.at(options.view, options.width, options.height, x, y);
    ASSERT_EQ(picked.size(), wanted.size());
    for (std::size_t layer = 0; layer < wanted.size(); ++layer) {
      EXPECT_EQ(picked[layer].draw, wanted[layer].draw);
      EXPECT_NEAR(picked[layer].distance, wanted[layer].depth, 5.0e-4 * wanted[layer].depth); // corners are snapped
      EXPECT_NEAR(picked[layer].alpha, wanted[layer].alpha, 1.0e-3);
      const glm::dvec3 seen(glm::dmat4(viewMatrix(options.view)) * glm::dvec4(picked[layer].point, 1.0));
      EXPECT_NEAR(-seen.z, picked[layer].distance, 1.0e-6 * wanted[layer].depth);
      ++layers;
    }
  }
  EXPECT_GT(sure, 200U);
  EXPECT_GT(layers, 250U);
}

TEST(Picking, FindsWhatTheReferenceFinds) {
  expectPicksTheReference(makeBuiltinScene("interlocked", {}), {});
  expectPicksTheReference(makeBuiltinScene("spheres", {30, 2}), {});
  expectPicksTheReference(makeBuiltinScene("mannequins", {4, 1}), {}); // opaque ones among them
  expectPicksTheReference(makeBuiltinScene("mannequins", {4, 1}), 0.3F);
}

TEST(Picking, AnEmptyPixelHasNothing) {
  Scene scene;
  addRectangle(scene, {{-0.1F, -0.1F}, {0.1F, 0.1F}, 0.0F}, unlitMaterial({1.0F, 0.0F, 0.0F, 0.5F}));
  Picker picker(scene, {});
  EXPECT_TRUE(picker.at(straightView(), 64, 64, 0, 0).empty());
  const std::vector<PickedLayer> middle = picker.at(straightView(), 64, 64, 32, 32);
  ASSERT_EQ(middle.size(), 1U);
  EXPECT_EQ(middle[0].blend, "over");
  EXPECT_NEAR(middle[0].color.r, 1.0F, 1e-3);
}

// ---- Peeling

TEST(Peeling, LeavesOutTheNearestLayers) {
  // Rectangles at heights 0 to 4, seen from above: the highest is the nearest.
  const std::vector<glm::vec4> colors = {{0.9F, 0.1F, 0.1F, 0.3F},
                                         {0.1F, 0.8F, 0.1F, 0.5F},
                                         {0.1F, 0.1F, 0.9F, 0.7F},
                                         {0.9F, 0.9F, 0.1F, 0.2F},
                                         {0.4F, 0.6F, 0.8F, 0.6F}};
  Scene scene;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    addRectangle(scene, {{-2.0F, -2.0F}, {2.0F, 2.0F}, static_cast<float>(i)}, unlitMaterial(colors[i]));
  }
  for (const std::uint32_t samples : {1U, 4U}) {
    MethodOptions method;
    method.name = "cpu";
    method.samples = samples;
    CpuStillRenderer renderer(scene, {}, DrawOrder::Shuffled, method);
    for (std::uint32_t peel = 0; peel <= colors.size() + 1; ++peel) {
      RenderOptions options;
      options.width = options.height = 8;
      options.view = straightView();
      options.background.kind = Background::Kind::Transparent;
      options.encoding = Encoding::Linear;
      options.peel = peel;
      const RenderResult result = renderer.render(options);
      glm::dvec4 expected(0.0);
      for (std::size_t i = 0; i + peel < colors.size(); ++i) { // from the back
        const glm::dvec4 color(colors[i]);
        expected = glm::dvec4(glm::dvec3(color) * color.a, color.a) + (1.0 - color.a) * expected;
      }
      const std::uint16_t* pixel = &result.deep.rgba[(4 * 8 + 4) * 4];
      for (int c = 0; c < 4; ++c) {
        const std::uint32_t half = pixel[c];
        const double value = half == 0 ? 0.0 : std::ldexp(1024.0 + (half & 1023U), static_cast<int>(half >> 10U) - 25);
        EXPECT_NEAR(value, expected[c], 2.0e-3) << peel << " of " << samples << " samples, channel " << c;
      }
      EXPECT_TRUE(result.report.warnings.empty());
    }
  }
}

TEST(Peeling, AFragmentWithAFilterIsOne) {
  const VitrailLayer reflection{{0.1F, 0.1F, 0.1F, 0.2F}, 0.9F, VITRAIL_BLEND_PREMULTIPLIED, 1, 7};
  const VitrailLayer filter{{0.5F, 0.25F, 1.0F, 0.0F}, 0.9F, VITRAIL_BLEND_MULTIPLY, 1, 7};
  const VitrailLayer behind{{1.0F, 1.0F, 1.0F, 0.5F}, 0.5F, VITRAIL_BLEND_OVER, 1, 8};
  const std::array<VitrailLayer, 3> layers = {reflection, filter, behind};
  EXPECT_TRUE(isFilterOf(filter, reflection));
  EXPECT_FALSE(isFilterOf(behind, filter));
  std::array<float, 4> color = {0.0F, 0.0F, 0.0F, 1.0F};
  blendPeeled(layers, 1, 1, color.data());
  EXPECT_FLOAT_EQ(color[0], 0.5F);
  EXPECT_FLOAT_EQ(color[1], 0.5F);
  color = {1.0F, 1.0F, 1.0F, 1.0F};
  blendPeeled(layers, 0, 1, color.data());
  EXPECT_FLOAT_EQ(color[0], 0.1F + 0.8F * 0.5F);
  EXPECT_FLOAT_EQ(color[1], 0.1F + 0.8F * 0.25F);
  color = {0.25F, 0.5F, 1.0F, 1.0F};
  blendPeeled(layers, 2, 1, color.data());
  EXPECT_EQ(color[0], 0.25F);
}

TEST(Peeling, SaysThatThereWasNothingToPeel) {
  Scene scene;
  addRectangle(scene, {}, unlitMaterial({0.5F, 0.5F, 0.5F, 1.0F}, AlphaMode::Opaque));
  MethodOptions method;
  method.name = "cpu";
  CpuStillRenderer renderer(scene, {}, DrawOrder::Forward, method);
  RenderOptions options;
  options.width = options.height = 8;
  options.view = straightView();
  options.peel = 1;
  const std::vector<std::string> warnings = renderer.render(options).report.warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("nothing was peeled"), std::string::npos);
}

// ---- Objects

// car { body, wheel { tyre } }, wheel
Scene car() {
  Scene scene;
  const std::uint32_t car = scene.objects.add("car");
  const std::uint32_t body = scene.objects.add("body", car);
  const std::uint32_t wheel = scene.objects.add("wheel", car);
  const std::uint32_t tyre = scene.objects.add("tyre", wheel);
  const std::uint32_t empty = scene.objects.add("empty", car);
  const std::uint32_t other = scene.objects.add("wheel");
  static_cast<void>(empty);
  for (const std::uint32_t object : {body, wheel, tyre, other}) {
    scene.draws[addRectangle(scene, {}, Material{})].object = object;
  }
  return scene;
}

std::vector<std::string> drawn(ObjectChoice choice) {
  Scene scene = car();
  chooseObjects(scene, choice);
  std::vector<std::string> paths;
  for (const Draw& draw : scene.draws) paths.push_back(scene.objects.path(draw.object));
  return paths;
}

using Paths = std::vector<std::string>;

TEST(Objects, AreChosenWithAllBelowThem) {
  EXPECT_EQ(drawn({}), (Paths{"car/body", "car/wheel", "car/wheel/tyre", "wheel"}));
  EXPECT_EQ(drawn({{"wheel"}, {}, {}, {}}), (Paths{"car/wheel", "car/wheel/tyre", "wheel"}));
  EXPECT_EQ(drawn({{"car/wheel"}, {}, {}, {}}), (Paths{"car/wheel", "car/wheel/tyre"}));
  EXPECT_EQ(drawn({{}, {"wheel"}, {}, {}}), (Paths{"car/body"}));
  EXPECT_EQ(drawn({{}, {"car"}, {"tyre"}, {}}), (Paths{"car/wheel/tyre", "wheel"}));
  EXPECT_EQ(drawn({{"car"}, {"body"}, {}, {}}), (Paths{"car/wheel", "car/wheel/tyre"}));
  EXPECT_TRUE(drawn({{}, {"car", "wheel"}, {}, {}}).empty());
}

TEST(Objects, AreFaded) {
  Scene scene = car();
  ObjectChoice choice;
  choice.fade = {{"car", 0.5F}, {"car/wheel", 0.25F}};
  chooseObjects(scene, choice);
  const std::vector<float> expected = {0.5F, 0.25F, 0.25F, 1.0F};
  for (std::size_t i = 0; i < 4; ++i) {
    const Material& material = scene.materials[scene.draws[i].material];
    EXPECT_EQ(material.baseColor.a, expected[i]) << i;
    EXPECT_EQ(material.alphaMode, expected[i] < 1.0F ? AlphaMode::Blend : AlphaMode::Opaque) << i;
  }
}

TEST(Objects, ThatAreNotThereAreRefused) {
  try {
    drawn({{}, {"door"}, {}, {}});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "no object is named \"door\"; there are \"car\", \"body\", \"wheel\", \"tyre\", \"empty\"");
  }
}

TEST(Objects, WithoutDrawsAreDropped) {
  Scene scene = car();
  dropEmptyObjects(scene);
  EXPECT_EQ(scene.objects.size(), 5U);
  EXPECT_EQ(scene.objects.path(scene.draws[3].object), "wheel");
  EXPECT_EQ(scene.objects.path(scene.draws[2].object), "car/wheel/tyre");
}

TEST(Objects, EveryDrawHasAName) {
  Scene scene;
  Material named;
  named.name = "glass";
  addRectangle(scene, {}, named);
  addRectangle(scene, {}, Material{});
  nameDraws(scene);
  EXPECT_EQ(scene.objects.path(scene.draws[0].object), "glass");
  EXPECT_EQ(scene.objects.path(scene.draws[1].object), "draw 1");
}

} // namespace
} // namespace vitrail::tool
