// Pictures whose every value follows from the blending formula. Colours are on the 8-bit sRGB grid and alphas on the
// 8-bit grid, so that storing a fragment loses nothing.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "../reference/shading.h"
#include "../reference/test_scenes.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::decodeSrgb;
using reference::encodeSrgb;
using reference::quantize8;
using reference::straightView;
using reference::unlitMaterial;
using reference::wideView;

constexpr std::array<DrawOrder, 3> kOrders{DrawOrder::Forward, DrawOrder::Reversed, DrawOrder::Shuffled};

// sRGB colour and linear alpha, in 1/255.
using Color8 = std::array<int, 4>;

glm::vec4 linearColor(const Color8& color) {
  const auto channel = [&](std::size_t c) { return static_cast<float>(decodeSrgb(color[c] / 255.0)); };
  return {channel(0), channel(1), channel(2), static_cast<float>(color[3]) / 255.0F};
}

// The picture's pixel: layers from the farthest to the nearest, each blended over what is behind it.
Color8 blendBackToFront(const std::vector<Color8>& nearestFirst, const Color8& background) {
  Color8 result{0, 0, 0, 255};
  for (std::size_t c = 0; c < 3; ++c) {
    double value = decodeSrgb(background[c] / 255.0);
    for (auto layer = nearestFirst.rbegin(); layer != nearestFirst.rend(); ++layer) {
      const double alpha = (*layer)[3] / 255.0;
      value = alpha * decodeSrgb((*layer)[c] / 255.0) + (1.0 - alpha) * value;
    }
    result[c] = quantize8(encodeSrgb(value));
  }
  return result;
}

void expectEveryPixel(const Picture& picture, const Color8& expected, int tolerance) {
  for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
    ASSERT_LE(std::abs(int{picture.rgba[i]} - expected[i % 4]), tolerance)
        << "channel " << i % 4 << " of pixel " << i / 4 << " is " << int{picture.rgba[i]} << ", expected "
        << expected[i % 4];
  }
}

RenderOptions smallPicture(const View& view, const Color8& background) {
  RenderOptions options;
  options.width = 16;
  options.height = 12;
  options.view = view;
  options.background.srgb = glm::vec3(background[0], background[1], background[2]) / 255.0F;
  return options;
}

// Random layers, the nearest first. Alphas are such that the last ones still show.
std::vector<Color8> randomLayers(std::uint32_t count, std::mt19937& random) {
  const std::uint32_t largestAlpha = std::clamp<std::uint32_t>(510 / count, 1, 255);
  std::vector<Color8> layers(count);
  for (Color8& layer : layers) {
    for (std::size_t c = 0; c < 3; ++c) layer[c] = static_cast<int>(random() % 256);
    layer[3] = static_cast<int>(1 + random() % largestAlpha);
  }
  return layers;
}

// Which layer is the n-th to be drawn.
std::vector<std::size_t> shuffledOrder(std::size_t count, std::mt19937& random) {
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

// Layer i of n, in front of a camera at the origin.
float layerZ(std::size_t i, std::size_t count) {
  return -1.0F - 8.0F * static_cast<float>(i) / static_cast<float>(count);
}

class StackTest : public GpuTest, public ::testing::WithParamInterface<std::uint32_t> {
 protected:
  void expectStack(const Scene& scene, const View& view, const std::vector<Color8>& layers) {
    const Color8 background{200, 30, 90, 255};
    const RenderOptions options = smallPicture(view, background);
    for (const DrawOrder order : kOrders) {
      const RenderResult result = renderOnce(gpu(), scene, options, {}, order);
      expectEveryPixel(result.picture, blendBackToFront(layers, background), 1);
      EXPECT_TRUE(result.report.complete);
      EXPECT_EQ(result.report.layersMax, layers.size());
      EXPECT_EQ(result.report.fragmentsRequested, layers.size() * options.width * options.height);
    }
  }
};

// A draw and a material for each quad.
TEST_P(StackTest, SeparateDraws) {
  std::mt19937 random(GetParam());
  const std::vector<Color8> layers = randomLayers(GetParam(), random);
  Scene scene;
  for (const std::size_t i : shuffledOrder(layers.size(), random)) {
    const reference::Rectangle all{glm::vec2(-9.0F), glm::vec2(9.0F), layerZ(i, layers.size())};
    addRectangle(scene, all, unlitMaterial(linearColor(layers[i])));
  }
  expectStack(scene, straightView(), layers);
}

// All quads in one mesh, with vertex colours, in perspective.
TEST_P(StackTest, OneMesh) {
  std::mt19937 random(GetParam() + 1000);
  const std::vector<Color8> layers = randomLayers(GetParam(), random);
  Scene scene;
  Mesh mesh;
  for (const std::size_t i : shuffledOrder(layers.size(), random)) {
    Scene one;
    addRectangle(one, {glm::vec2(-50.0F), glm::vec2(50.0F), layerZ(i, layers.size())}, unlitMaterial(glm::vec4(1.0F)));
    const auto first = static_cast<std::uint32_t>(mesh.vertexCount());
    for (Vertex vertex : one.meshes[0].vertices()) {
      vertex.color = linearColor(layers[i]);
      mesh.add(vertex);
    }
    for (const std::uint32_t index : one.meshes[0].indices) mesh.indices.push_back(first + index);
  }
  scene.meshes.push_back(std::move(mesh));
  scene.materials.push_back(unlitMaterial(glm::vec4(1.0F)));
  scene.draws.emplace_back();
  expectStack(scene, wideView(), layers);
}

INSTANTIATE_TEST_SUITE_P(Layers, StackTest, ::testing::Values(1U, 2U, 17U, 130U, 700U));

class ClosedFormTest : public GpuTest {};

// A pane drawn 60,000 times is more than Mesa's CPU driver lets a shader sort: there the picture is refused with the
// reason, and elsewhere it is exact.
TEST_F(ClosedFormTest, AStackTooDeepForTheDriverIsRefused) {
  Scene scene;
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), -2.0F}, unlitMaterial(linearColor({80, 160, 240, 1})));
  std::vector<std::uint32_t>& indices = scene.meshes[0].indices;
  const std::vector<std::uint32_t> once = indices;
  for (int i = 1; i < 60000; ++i) indices.insert(indices.end(), once.begin(), once.end());
  RenderOptions options = smallPicture(straightView(), {200, 30, 90, 255});
  options.width = 2;
  options.height = 1;
  try {
    const RenderResult result = renderOnce(gpu(), scene, options);
    EXPECT_TRUE(result.report.complete);
    EXPECT_EQ(result.report.layersMax, 60000U);
    expectEveryPixel(result.picture, {80, 160, 240, 255}, 1); // the last layer's weight is 1/255 * (254/255)^59999
  } catch (const GpuError& error) {
    EXPECT_NE(std::string(error.what()).find("lets a shader sort"), std::string::npos) << error.what();
  }
}

// Red of alpha 128/255 over green of alpha 64/255.
Scene redOverGreen() {
  Scene scene;
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), 1.0F}, unlitMaterial(linearColor({255, 0, 0, 128})));
  addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), -1.0F}, unlitMaterial(linearColor({0, 255, 0, 64})));
  return scene;
}

// Over blue, in linear light: (128/255, 127/255 * 64/255, 127/255 * 191/255) = (0.5020, 0.1250, 0.3730).
TEST_F(ClosedFormTest, TwoLayersOverAColor) {
  const RenderOptions options = smallPicture(straightView(), {0, 0, 255, 255});
  expectEveryPixel(renderOnce(gpu(), redOverGreen(), options).picture, {188, 99, 164, 255}, 0);
}

// Alpha 1 - 127/255 * 191/255 = 0.6270; the colours above, divided by it: (0.8006, 0.1994, 0).
TEST_F(ClosedFormTest, TwoLayersOverNothing) {
  RenderOptions options = smallPicture(straightView(), {0, 0, 0, 0});
  options.background.kind = Background::Kind::Transparent;
  const Picture picture = renderOnce(gpu(), redOverGreen(), options).picture;
  EXPECT_TRUE(picture.hasAlpha);
  expectEveryPixel(picture, {231, 123, 0, 160}, 0);
}

// Quads at one depth have no right order, but they have one.
TEST_F(ClosedFormTest, EqualDepthsDoNotDependOnSubmission) {
  for (const std::uint32_t count : {5U, 40U}) {
    std::mt19937 random(count);
    std::vector<Color8> layers = randomLayers(count, random);
    layers.back() = layers.front(); // two that are the same in everything
    const RenderOptions options = smallPicture(wideView(), {255, 255, 255, 255});
    std::vector<std::uint8_t> first;
    for (int attempt = 0; attempt < 2; ++attempt) {
      Scene scene;
      for (const std::size_t i : shuffledOrder(count, random)) {
        addRectangle(scene, {glm::vec2(-9.0F), glm::vec2(9.0F), -3.0F}, unlitMaterial(linearColor(layers[i])));
      }
      for (const DrawOrder order : kOrders) {
        const RenderResult result = renderOnce(gpu(), scene, options, {}, order);
        EXPECT_EQ(result.report.layersMax, count);
        if (first.empty()) first = result.picture.rgba;
        ASSERT_TRUE(result.picture.rgba == first) << count << " quads, attempt " << attempt;
      }
    }
  }
}

// A falls to the right, B rises: they cross in the picture's middle, so A is in front on the left and B on the right.
TEST_F(ClosedFormTest, CrossingQuads) {
  const Color8 a{255, 0, 0, 128};
  const Color8 b{0, 0, 255, 192};
  const Color8 background{255, 255, 255, 255};
  Scene scene;
  addRectangle(scene, {glm::vec2(-4.0F), glm::vec2(4.0F), 0.0F}, unlitMaterial(linearColor(a)));
  addRectangle(scene, {glm::vec2(-4.0F), glm::vec2(4.0F), 0.0F}, unlitMaterial(linearColor(b)));
  for (glm::vec3& position : scene.meshes[0].positions) position.z = -position.x;
  for (glm::vec3& position : scene.meshes[1].positions) position.z = position.x;
  const RenderOptions options = smallPicture(straightView(), background);
  const Color8 left = blendBackToFront({a, b}, background);
  const Color8 right = blendBackToFront({b, a}, background);
  for (const DrawOrder order : kOrders) {
    const Picture picture = renderOnce(gpu(), scene, options, {}, order).picture;
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
      const Color8& expected = i / 4 % 16 < 8 ? left : right;
      ASSERT_LE(std::abs(int{picture.rgba[i]} - expected[i % 4]), 1) << "channel " << i % 4 << " of pixel " << i / 4;
    }
  }
}

} // namespace
} // namespace vitrail::tool::test
