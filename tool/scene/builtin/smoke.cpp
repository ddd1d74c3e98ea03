// A plume of smoke made of soft textured billboards that face the default camera: large, faint and many deep, with
// fragments whose alpha comes from a texture. Flames are the same plume with additive materials.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "../camera.h"
#include "parts.h"
#include "random.h"
#include "shapes.h"

namespace vitrail::tool {
namespace {

constexpr std::uint32_t textureSize = 256;
constexpr std::uint32_t puffKinds = 4;

float smoothStep(float t) { return t * t * (3.0F - 2.0F * t); }

// Value noise: random values on a grid, smoothly interpolated, in octaves. In [0, 1].
class Noise {
 public:
  explicit Noise(Random& random) {
    for (float& value : grid_) value = random.uniform();
  }

  float octaves(float x, float y) const {
    float sum = 0.0F;
    float weight = 0.5F;
    for (int octave = 0; octave < 5; ++octave) {
      sum += weight * at(x, y);
      x = 2.0F * x + 17.3F;
      y = 2.0F * y + 5.9F;
      weight *= 0.5F;
    }
    return sum / (1.0F - 2.0F * weight);
  }

 private:
  static constexpr std::uint32_t size = 64; // a power of two: coordinates wrap around

  float value(std::uint32_t x, std::uint32_t y) const { return grid_[(y % size) * size + x % size]; }

  float at(float x, float y) const {
    const auto left = static_cast<std::uint32_t>(x);
    const auto top = static_cast<std::uint32_t>(y);
    const float right = smoothStep(x - static_cast<float>(left));
    const float down = smoothStep(y - static_cast<float>(top));
    const float upper = value(left, top) * (1.0F - right) + value(left + 1, top) * right;
    const float lower = value(left, top + 1) * (1.0F - right) + value(left + 1, top + 1) * right;
    return upper * (1.0F - down) + lower * down;
  }

  std::array<float, static_cast<std::size_t>(size) * size> grid_{};
};

std::uint8_t to8Bits(float value) {
  return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
}

// A ragged puff: lighter where it is thick, and clear well before the border.
Image puffImage(Random& random) {
  const Noise noise(random);
  Image image{textureSize, textureSize, {}};
  image.rgba.reserve(static_cast<std::size_t>(textureSize) * textureSize * 4);
  for (std::uint32_t row = 0; row < textureSize; ++row) {
    for (std::uint32_t column = 0; column < textureSize; ++column) {
      const float x = (static_cast<float>(column) + 0.5F) / static_cast<float>(textureSize);
      const float y = (static_cast<float>(row) + 0.5F) / static_cast<float>(textureSize);
      const float distance = 2.0F * std::sqrt((x - 0.5F) * (x - 0.5F) + (y - 0.5F) * (y - 0.5F));
      const float cloud = noise.octaves(5.0F * x, 5.0F * y);
      const float body = std::clamp(1.15F - 1.25F * distance + 1.3F * (cloud - 0.5F), 0.0F, 1.0F);
      const float border = smoothStep(std::clamp((0.97F - distance) / 0.35F, 0.0F, 1.0F));
      const std::uint8_t light = to8Bits(0.5F + 0.7F * (cloud - 0.25F));
      image.rgba.insert(image.rgba.end(), {light, light, light, to8Bits(smoothStep(body) * border)});
    }
  }
  return image;
}

// One puff of the plume. height and across place it: 0 at the foot to 1 at the top, -1 at the left to 1 at the right
// border. It glows at the foot, and light from the left and above makes it pale or dark.
Material puffMaterial(float height, float across, Random& random) {
  const float light = std::clamp(0.55F + 0.30F * (height - across) + random.range(-0.16F, 0.16F), 0.2F, 1.0F);
  const float glow = std::clamp(1.0F - 3.2F * height + random.range(-0.15F, 0.15F), 0.0F, 1.0F);
  const glm::vec3 ember = glm::mix(glm::vec3(0.85F, 0.22F, 0.08F), glm::vec3(1.0F, 0.75F, 0.35F), glow);
  const glm::vec3 color = glm::mix(light * glm::vec3(0.98F, 0.96F, 0.95F), ember, glow);
  Material material = glassMaterial(linearFromSrgb(color), 0.42F - 0.2F * height, 1.0F);
  material.unlit = true;
  material.baseColorTexture.image = static_cast<std::int32_t>(random.below(puffKinds));
  material.baseColorTexture.sampler.wrapU = Wrap::ClampToEdge;
  material.baseColorTexture.sampler.wrapV = Wrap::ClampToEdge;
  return material;
}

} // namespace

Scene makeSmoke(std::uint32_t count, std::uint32_t seed) {
  Random random(seed);
  Scene scene;
  scene.name = "smoke";
  scene.background = Background{Background::Kind::Color, {0.11F, 0.13F, 0.17F}};
  for (std::uint32_t kind = 0; kind < puffKinds; ++kind) scene.images.push_back(puffImage(random));
  const std::uint32_t mesh = addMesh(scene, quad(1.0F, 1.0F));

  // All billboards are parallel, each in a slot of depth of its own: none cuts through another.
  const glm::mat4 facing = frameScene(Bounds{}, Orbit{}, 1.0F).cameraToWorld;
  const glm::vec3 right(facing[0]);
  const glm::vec3 backward(facing[2]);
  const glm::mat4 rotation(facing[0], facing[1], facing[2], glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
  std::vector<std::uint32_t> slots(count);
  std::iota(slots.begin(), slots.end(), 0U);
  random.shuffle(slots);
  const float drift = random.range(0.0F, 2.0F * std::numbers::pi_v<float>);
  for (std::uint32_t i = 0; i < count; ++i) {
    const float height = std::pow((static_cast<float>(i) + random.uniform()) / static_cast<float>(count), 0.85F);
    const float spread = 0.08F + 0.62F * height * height;
    const float across = random.range(-1.0F, 1.0F);
    const float sway = 0.25F * height * std::sin(4.2F * height + drift);
    // A puff's slot is a plane across the view direction, in which it has its place.
    const float slot = (static_cast<float>(slots[i]) + random.range(0.25F, 0.75F)) / static_cast<float>(count);
    glm::vec3 place = glm::vec3(0.0F, 2.6F * height, 0.0F) + (sway + spread * across) * right;
    place += (1.4F * (slot - 0.5F) - glm::dot(place, backward)) * backward;
    const float size = 0.2F + 0.4F * height * random.range(0.5F, 1.0F);
    glm::mat4 transform = glm::translate(glm::mat4(1.0F), place) * rotation;
    transform = glm::rotate(transform, random.range(0.0F, 2.0F * std::numbers::pi_v<float>), {0.0F, 0.0F, 1.0F});
    Material material = puffMaterial(height, across, random);
    material.name = "puff " + std::to_string(i);
    scene.draws.push_back({mesh, addMaterial(scene, std::move(material)), glm::scale(transform, glm::vec3(size))});
  }
  return scene;
}

Scene makeFlames(std::uint32_t count, std::uint32_t seed) {
  Scene scene = makeSmoke(count, seed);
  scene.name = "flames";
  for (const Draw& draw : scene.draws) {
    Material& material = scene.materials[draw.material];
    const float height = std::clamp(draw.transform[3].y / 2.6F, 0.0F, 1.0F);
    const glm::vec3 color = glm::mix(glm::vec3(1.0F, 0.62F, 0.25F), glm::vec3(0.75F, 0.16F, 0.08F), height);
    material.baseColor = glm::vec4(linearFromSrgb(color), 0.4F * material.baseColor.a);
    material.blend = BlendMode::Additive;
  }
  return scene;
}

} // namespace vitrail::tool
