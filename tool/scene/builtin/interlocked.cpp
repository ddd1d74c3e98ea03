// Panes and rings that pass through each other around one middle. Nearly every pair overlaps in both orders, so no
// order of whole objects or of their triangles draws them right.
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

#include "parts.h"
#include "random.h"
#include "shapes.h"

namespace vitrail::tool {
namespace {

constexpr float goldenTurn = 0.61803399F;

// Directions spread evenly over half a sphere (a pane facing backward is the same pane): a Fibonacci spiral.
glm::vec3 spreadDirection(std::uint32_t i, std::uint32_t count) {
  const float height = (static_cast<float>(i) + 0.5F) / static_cast<float>(count);
  const float across = std::sqrt(1.0F - height * height);
  const float angle = 2.0F * std::numbers::pi_v<float> * std::fmod(static_cast<float>(i) * goldenTurn, 1.0F);
  return {across * std::cos(angle), height, across * std::sin(angle)};
}

// Turns the given axis of an object towards a direction, and the object around it.
glm::mat4 turned(const glm::vec3& axis, const glm::vec3& direction, float spin) {
  const glm::vec3 around = glm::cross(axis, direction);
  const float sine = glm::length(around);
  glm::mat4 result(1.0F);
  if (sine > 1e-6F) result = glm::rotate(result, std::atan2(sine, glm::dot(axis, direction)), around / sine);
  return glm::rotate(result, spin, axis);
}

} // namespace

Scene makeInterlocked(std::uint32_t count, std::uint32_t seed) {
  Random random(seed);
  Scene scene;
  scene.name = "interlocked";
  const std::uint32_t pane = addMesh(scene, quad(0.95F, 0.7F));
  const std::uint32_t ring = addMesh(scene, torus(0.95F, 0.07F, 96, 24));
  const float firstHue = random.uniform();
  // A few dozen objects share one middle; more of them need more room.
  const float room = 0.4F * std::cbrt(static_cast<float>(count) / 12.0F);
  for (std::uint32_t i = 0; i < count; ++i) {
    const bool isPane = i % 2 == 0;
    const glm::vec3 wobble = 0.25F * random.inBall();
    const glm::vec3 direction = glm::normalize(spreadDirection(i, count) + wobble);
    const glm::vec3 middle = room * random.inBall();
    const float spin = random.range(0.0F, 2.0F * std::numbers::pi_v<float>);
    const glm::vec3 color = colorFromHue(firstHue + static_cast<float>(i) * goldenTurn, 0.85F, 0.95F);
    Material material = glassMaterial(color, isPane ? 0.65F : 0.8F, 0.4F);
    material.name = (isPane ? "pane " : "ring ") + std::to_string(i);
    const glm::vec3 axis = isPane ? glm::vec3(0.0F, 0.0F, 1.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
    const glm::mat4 transform = glm::translate(glm::mat4(1.0F), middle) * turned(axis, direction, spin);
    scene.draws.push_back({isPane ? pane : ring, addMaterial(scene, std::move(material)), transform});
  }
  return scene;
}

} // namespace vitrail::tool
