// Lights and the extensions of materials against the double-precision reference, textures with hidden colours, decals,
// and light over a transparent background.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "../../tool/scene/builtin/shapes.h"
#include "../reference/compare.h"
#include "../reference/shading.h"
#include "../reference/test_scenes.h"
#include "../thorough.h"
#include "fixture.h"

namespace vitrail::tool::test {
namespace {

using reference::addRectangle;
using reference::Comparison;
using reference::decodeSrgb;
using reference::Reference;
using reference::ReferenceOptions;
using reference::straightView;
using reference::unlitMaterial;

// Balls beside each other, each of the usual material changed in a way of its own.
Scene balls(const std::vector<std::function<void(Material&)>>& changes) {
  Scene scene;
  scene.meshes.push_back(uvSphere(48, 24));
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Material material;
    material.baseColor = {0.6F, 0.3F, 0.1F, 1.0F};
    material.metallic = 0.0F;
    material.roughness = 0.4F;
    changes[i](material);
    scene.materials.push_back(material);
    const glm::vec3 place(1.1F * static_cast<float>(i % 4), -1.1F * static_cast<float>(i / 4), 0.0F);
    scene.draws.push_back(
        {0, static_cast<std::uint32_t>(i), glm::scale(glm::translate(glm::mat4(1.0F), place), glm::vec3(0.5F))});
  }
  return scene;
}

Picture picked(const Picture& picture, std::uint32_t x, std::uint32_t y) {
  Picture pixel;
  pixel.width = pixel.height = 1;
  const std::size_t at = (std::size_t{y} * picture.width + x) * 4;
  pixel.rgba.assign(picture.rgba.begin() + static_cast<std::ptrdiff_t>(at),
                    picture.rgba.begin() + static_cast<std::ptrdiff_t>(at) + 4);
  return pixel;
}

void expectPixel(const Picture& picture, std::uint32_t x, std::uint32_t y, const std::array<int, 3>& color,
                 int bound = 1) {
  const Picture pixel = picked(picture, x, y);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(int{pixel.rgba[c]}, color.at(c), bound) << "channel " << c;
}

class MaterialsTest : public GpuTest {
 protected:
  static void expectLikeReference(const Scene& scene, const RenderOptions& options, double edgeShare) {
    const RenderResult result = renderOnce(gpu(), scene, options);
    ReferenceOptions same;
    same.width = options.width;
    same.height = options.height;
    same.view = options.view;
    same.background = options.background;
    const Reference reference = renderReference(scene, same);
    const Comparison comparison = compare(result.picture, reference.exact, reference, 2);
    EXPECT_LE(comparison.away, 2) << comparison;
    EXPECT_LE(comparison.edgeShare, edgeShare) << comparison;
  }

  static RenderOptions straight(std::uint32_t width, std::uint32_t height) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.view = straightView();
    options.background.srgb = glm::vec3(0.0F);
    return options;
  }
};

TEST_F(MaterialsTest, WhatIsReflectedOtherwiseThanByGlass) {
  const Scene scene = balls({
      [](Material& m) { m.ior = 2.4F; },
      [](Material& m) { m.ior = 0.0F; },
      [](Material& m) { m.specular = 0.0F; },
      [](Material& m) {
        m.specularColor = {0.2F, 1.0F, 5.0F};
        m.metallic = 0.3F;
      },
      [](Material& m) {
        m.specularGlossiness = true;
        m.specularColor = {0.8F, 0.6F, 0.2F};
      },
      [](Material& m) {
        m.ior = 1.8F;
        m.transmission = 0.7F;
      },
  });
  expectLikeReference(scene, usualOptions(scene, 320, 180), 0.02);
}

// Sizes that a file may have: floats hold none of their fourth powers, and next to an eye so far away nothing of a
// direction.
TEST_F(MaterialsTest, ModelsOfAnySizeAreTheSame) {
  for (const bool flat : {true, false}) {
    Scene scene = balls({[](Material& m) {
      m.alphaMode = AlphaMode::Blend;
      m.baseColor.a = 0.5F;
      m.metallic = 0.3F;
    }});
    if (flat) scene.meshes[0].normals.clear();
    for (const std::string name : {"cpu", "linked-list", "tiles"}) {
      if (name == "tiles" && !flat && !tests::isThorough()) continue; // one pipeline more
      MethodOptions method;
      method.name = name;
      const auto picture = [&](float size) {
        Scene sized = scene;
        for (glm::vec3& position : sized.meshes[0].positions) position *= size;
        return renderOnce(gpu(), sized, usualOptions(sized, 96, 64), {}, DrawOrder::Forward, method).picture;
      };
      const Picture usual = picture(1.0F);
      EXPECT_GT(*std::ranges::max_element(usual.rgba) - *std::ranges::min_element(usual.rgba), 100);
      for (const float size : {1e-15F, 1e14F}) {
        EXPECT_LE(largestDifference(picture(size), usual), 1) << name << ", size " << size << (flat ? ", flat" : "");
      }
    }
  }
}

TEST_F(MaterialsTest, LayersOverASurface) {
  const Scene scene = balls({
      [](Material& m) {
        m.clearcoat = 1.0F;
        m.clearcoatRoughness = 0.1F;
        m.roughness = 0.8F;
        m.emissive = {0.0F, 0.1F, 0.2F};
      },
      [](Material& m) {
        m.sheenColor = {0.3F, 0.8F, 1.0F};
        m.sheenRoughness = 0.2F;
      },
      [](Material& m) {
        m.sheenColor = {0.9F, 0.4F, 0.3F};
        m.sheenRoughness = 0.7F;
        m.clearcoat = 0.5F;
        m.clearcoatRoughness = 0.4F;
      },
      [](Material& m) {
        m.alphaMode = AlphaMode::Blend;
        m.baseColor.a = 0.5F;
        m.sheenColor = {0.2F, 0.4F, 0.3F};
        m.sheenRoughness = 1.0F;
      },
  });
  expectLikeReference(scene, usualOptions(scene, 320, 120), 0.02);
}

TEST_F(MaterialsTest, GroovesFilmsAndLeaves) {
  const Scene scene = balls({
      [](Material& m) {
        m.metallic = 1.0F;
        m.anisotropy = 0.8F;
      },
      [](Material& m) {
        m.anisotropy = 0.5F;
        m.anisotropyRotation = 1.0F;
        m.doubleSided = true;
      },
      [](Material& m) {
        m.iridescence = 1.0F;
        m.iridescenceIor = 1.6F;
        m.iridescenceThickness.y = 380.0F;
      },
      [](Material& m) {
        m.metallic = 1.0F;
        m.baseColor = {0.9F, 0.9F, 0.9F, 1.0F};
        m.iridescence = 0.7F;
        m.iridescenceThickness.y = 600.0F;
      },
      [](Material& m) {
        m.diffuseTransmission = 0.6F;
        m.diffuseTransmissionColor = {0.5F, 0.9F, 0.1F};
      },
  });
  expectLikeReference(scene, usualOptions(scene, 320, 180), 0.04);
}

// Of all kinds, from all sides, on opaque and translucent balls.
TEST_F(MaterialsTest, LightsOfTheScene) {
  Scene scene = balls({
      [](Material&) {},
      [](Material& m) { m.clearcoat = 1.0F; },
      [](Material& m) {
        m.alphaMode = AlphaMode::Blend;
        m.baseColor.a = 0.4F;
      },
      [](Material& m) {
        m.diffuseTransmission = 0.6F;
        m.metallic = 0.2F;
      },
      [](Material& m) { m.unlit = true; },
  });
  Light sun;
  sun.kind = Light::Kind::Directional;
  sun.direction = glm::normalize(glm::vec3(-0.5F, -0.4F, -0.6F));
  sun.intensity = {300.0F, 250.0F, 200.0F};
  Light lamp;
  lamp.position = {1.5F, 1.5F, 1.0F};
  lamp.intensity = {200.0F, 600.0F, 900.0F};
  lamp.range = 4.0F;
  Light spot;
  spot.kind = Light::Kind::Spot;
  spot.position = {3.5F, 0.3F, 2.0F};
  spot.direction = glm::normalize(glm::vec3(-0.1F, -0.1F, -1.0F));
  spot.innerConeAngle = 0.1F;
  spot.outerConeAngle = 0.3F;
  spot.intensity = {5000.0F, 1000.0F, 500.0F};
  scene.lights = {sun, lamp, spot};
  expectLikeReference(scene, usualOptions(scene, 320, 180), 0.02);
  for (Light& light : scene.lights) light.intensity *= 1e-5F; // exposure makes up for it
  expectLikeReference(scene, usualOptions(scene, 160, 90), 0.03);
}

// A scene far away is moved for the GPU, and its lights with it.
TEST_F(MaterialsTest, LightsFarFromTheOrigin) {
  Scene scene = balls({[](Material&) {}, [](Material& m) { m.roughness = 0.7F; }});
  Light lamp;
  lamp.position = {1.0F, 1.5F, 1.0F};
  scene.lights = {lamp};
  const RenderOptions options = usualOptions(scene, 160, 90);
  const Picture here = renderOnce(gpu(), scene, options).picture;
  const glm::vec3 away(4096.0F, -8192.0F, 1024.0F);
  for (Draw& draw : scene.draws) draw.transform[3] += glm::vec4(away, 0.0F);
  scene.lights[0].position += away;
  RenderOptions there = options;
  there.view.cameraToWorld[3] += glm::vec4(away, 0.0F);
  const Picture far = renderOnce(gpu(), scene, there).picture;
  std::size_t differing = 0;
  for (std::size_t i = 0; i < here.rgba.size(); ++i) differing += std::abs(here.rgba[i] - far.rgba[i]) > 2 ? 1 : 0;
  EXPECT_LE(differing, here.rgba.size() / 200);
}

// Opaque white and transparent black texels in turns.
Scene checker(AlphaMode mode, int texels) {
  Scene scene;
  Image image;
  image.width = image.height = static_cast<std::uint32_t>(texels);
  for (int i = 0; i < texels * texels; ++i) {
    const bool white = (i % texels + i / texels) % 2 == 0;
    image.rgba.insert(image.rgba.end(), 4, white ? 255 : 0);
  }
  scene.images.push_back(image);
  Material material = unlitMaterial(glm::vec4(1.0F), mode);
  material.alphaCutoff = 0.25F;
  material.baseColorTexture.image = 0;
  addRectangle(scene, {glm::vec2(-1.0F), glm::vec2(1.0F), 0.0F}, material);
  return scene;
}

// docs/shading.md, "Textures with alpha": half of the texels are there, and the hidden black of the others does not
// show.
TEST_F(MaterialsTest, HiddenColoursDoNotDarken) {
  const RenderOptions options = straight(16, 16);
  expectPixel(renderOnce(gpu(), checker(AlphaMode::Blend, 64), options).picture, 8, 8, {188, 188, 188});
  expectPixel(renderOnce(gpu(), checker(AlphaMode::Mask, 64), options).picture, 8, 8, {255, 255, 255});
  // What is opaque has no alpha: half white and half black.
  expectPixel(renderOnce(gpu(), checker(AlphaMode::Opaque, 64), options).picture, 8, 8, {188, 188, 188});
}

TEST_F(MaterialsTest, BilinearFilteringIsPremultiplied) {
  for (const AlphaMode mode : {AlphaMode::Blend, AlphaMode::Mask}) {
    Scene scene = checker(mode, 6);
    scene.materials[0].baseColorTexture.sampler.mipmaps = false;
    scene.images[0].rgba[4 * 7] = 90; // a red of its own
    expectLikeReference(scene, straight(64, 64), 0.02);
  }
}

TEST_F(MaterialsTest, OfOpaqueSurfacesInOnePlaneTheLaterIsSeen) {
  Scene scene;
  const Material red = unlitMaterial({1.0F, 0.0F, 0.0F, 1.0F}, AlphaMode::Opaque);
  const Material green = unlitMaterial({0.0F, 1.0F, 0.0F, 1.0F}, AlphaMode::Opaque);
  addRectangle(scene, {glm::vec2(-1.0F), glm::vec2(1.0F), 0.0F}, green);
  addRectangle(scene, {glm::vec2(-1.0F), glm::vec2(1.0F), 0.0F}, red);
  const RenderOptions options = straight(16, 16);
  expectPixel(renderOnce(gpu(), scene, options).picture, 8, 8, {255, 0, 0}, 0);
  std::swap(scene.draws[0], scene.draws[1]); // now the one with the second material comes first
  expectPixel(renderOnce(gpu(), scene, options).picture, 8, 8, {0, 255, 0}, 0);
}

// A masked decal is seen on an opaque sheet, in whatever order the two come, and cut where it is cut.
TEST_F(MaterialsTest, MaskedDecalsAreSeen) {
  for (const bool decalFirst : {false, true}) {
    Scene scene = checker(AlphaMode::Mask, 2);
    scene.materials[0].baseColorTexture.sampler.magLinear = false;
    addRectangle(scene, {glm::vec2(-1.0F), glm::vec2(1.0F), 0.0F},
                 unlitMaterial({0.0F, 0.0F, 1.0F, 1.0F}, AlphaMode::Opaque));
    if (!decalFirst) std::swap(scene.draws[0], scene.draws[1]);
    const Picture picture = renderOnce(gpu(), scene, straight(16, 16)).picture;
    expectPixel(picture, 4, 4, {255, 255, 255}, 0);
    expectPixel(picture, 12, 4, {0, 0, 255}, 0);
  }
}

// The same balls over a transparent background and over black.
class OverNothing : public MaterialsTest {
 protected:
  void draw(const std::function<void(Material&)>& change) {
    const Scene scene = balls({change});
    RenderOptions options = usualOptions(scene, 90, 90);
    options.background.kind = Background::Kind::Transparent;
    clear = renderOnce(gpu(), scene, options).picture;
    options.background.kind = Background::Kind::Color;
    options.background.srgb = glm::vec3(0.0F);
    black = renderOnce(gpu(), scene, options).picture;
  }

  // The largest difference, of 255, from the picture over black where the other is laid over black.
  double largest(const std::function<double(double coded, double alpha)>& laidOver) const {
    double result = 0.0;
    for (std::size_t i = 0; i < clear.rgba.size(); ++i) {
      if (i % 4 == 3) continue;
      const double laid = laidOver(clear.rgba[i] / 255.0, clear.rgba[i / 4 * 4 + 3] / 255.0);
      result = std::max(result, std::abs(255.0 * laid - black.rgba[i]));
    }
    return result;
  }

  Picture clear;
  Picture black;
};

double blendCodes(double coded, double alpha) { return coded * alpha; }
double blendLight(double coded, double alpha) { return reference::encodeSrgb(decodeSrgb(coded) * alpha); }

TEST_F(OverNothing, ClearGlassKeepsItsReflection) {
  draw([](Material& m) {
    m.transmission = 1.0F;
    m.baseColor = {1.0F, 0.3F, 0.3F, 1.0F};
    m.roughness = 0.1F;
  });
  EXPECT_LE(largest(blendCodes), 1.01);
  EXPECT_EQ(*std::ranges::max_element(black.rgba), 255);
  const Picture middle = picked(clear, 45, 45);
  EXPECT_GT(int{middle.rgba[3]}, 10);
  EXPECT_LT(int{middle.rgba[3]}, 100);
}

TEST_F(OverNothing, TranslucentSurfacesAreBlendedInLinearLight) {
  draw([](Material& m) {
    m.alphaMode = AlphaMode::Blend;
    m.baseColor.a = 0.3F;
    m.roughness = 0.8F;
  });
  EXPECT_LE(largest(blendLight), 1.5);
}

// Half glass is between the two: the reference has the rule. Where alpha is raised it jumps from step to step, which
// the reference takes for edges.
TEST_F(OverNothing, HalfGlass) {
  const Scene scene = balls({[](Material& m) {
    m.transmission = 0.5F;
    m.roughness = 0.35F;
  }});
  RenderOptions options = usualOptions(scene, 90, 90);
  options.background.kind = Background::Kind::Transparent;
  expectLikeReference(scene, options, 0.4);
}

// Surfaces that hide as much as they shine keep their alpha.
TEST_F(MaterialsTest, TranslucentSurfacesKeepTheirAlpha) {
  Scene scene;
  addRectangle(scene, {glm::vec2(-1.0F), glm::vec2(1.0F), 0.0F}, unlitMaterial({1.0F, 0.25F, 0.0F, 0.2F}));
  RenderOptions options = straight(16, 16);
  options.background.kind = Background::Kind::Transparent;
  const Picture pixel = picked(renderOnce(gpu(), scene, options).picture, 8, 8);
  EXPECT_EQ(int{pixel.rgba[3]}, 51);
  expectPixel(pixel, 0, 0, {255, 137, 0});
}

} // namespace
} // namespace vitrail::tool::test
