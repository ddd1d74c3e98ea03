// Parallel panes that fill the picture. Every colour and alpha is a multiple of 1/255 (colours on the sRGB curve) and
// every depth occurs once, so that the right picture follows from the blending formula alone.
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "parts.h"
#include "random.h"
#include "shapes.h"

namespace vitrail::tool {
namespace {

// Panes reach this far for a camera that sees heights -1 to 1, so they fill pictures up to 64 times as wide as high.
// They are not square because the diagonal between their two triangles would run through pixel centres then, where a
// ray may meet both triangles.
constexpr float halfWidth = 64.0F;
constexpr float halfHeight = 57.6F;

// They stand in the camera's middle, 1 unit from both its planes.
SceneCamera cameraInFront() {
  SceneCamera camera;
  camera.name = "front";
  camera.cameraToWorld = glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, 0.0F, 3.0F));
  camera.orthographic = true;
  camera.halfHeight = 1.0F;
  camera.nearPlane = 1.0F;
  camera.farPlane = 5.0F;
  return camera;
}

float gridValue(Random& random, std::uint32_t low, std::uint32_t high) {
  return static_cast<float>(low + random.below(high - low + 1)) / 255.0F;
}

} // namespace

Scene makePlanes(std::uint32_t count, std::uint32_t seed) {
  Random random(seed);
  Scene scene;
  scene.name = "planes";
  scene.cameras.push_back(cameraInFront());
  const std::uint32_t mesh = addMesh(scene, quad(halfWidth, halfHeight));
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  random.shuffle(order);
  for (const std::uint32_t place : order) {
    const float red = gridValue(random, 0, 255);
    const float green = gridValue(random, 0, 255);
    const float blue = gridValue(random, 0, 255);
    Material material = glassMaterial(linearFromSrgb({red, green, blue}), gridValue(random, 1, 128), 1.0F);
    material.name = "pane " + std::to_string(place); // 0 is the nearest
    material.unlit = true;
    const float depth = 1.0F - 2.0F * (static_cast<float>(place) + 0.5F) / static_cast<float>(count);
    const glm::mat4 transform = glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, 0.0F, depth));
    scene.draws.push_back({mesh, addMaterial(scene, std::move(material)), transform});
  }
  return scene;
}

} // namespace vitrail::tool
