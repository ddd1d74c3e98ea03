// Spheres of one size at random places in a cube, with random colours and opacities: the usual first picture of
// order-independent transparency. Many pass through each other.
#include <cmath>
#include <string>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

#include "parts.h"
#include "random.h"
#include "shapes.h"

namespace vitrail::tool {

Scene makeSpheres(std::uint32_t count, std::uint32_t seed) {
  Random random(seed);
  Scene scene;
  scene.name = "spheres";
  const std::uint32_t mesh = addMesh(scene, uvSphere(64, 32));
  // The volume that the spheres fill stays the same for any count.
  const float radius = 1.1F / std::cbrt(static_cast<float>(count));
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 position = random.inCube();
    const float hue = random.uniform();
    const float saturation = random.range(0.5F, 1.0F);
    const glm::vec3 color = colorFromHue(hue, saturation, random.range(0.7F, 1.0F));
    Material material = glassMaterial(color, random.range(0.2F, 1.0F), 0.5F);
    material.name = "sphere " + std::to_string(i);
    const glm::mat4 place = glm::translate(glm::mat4(1.0F), position);
    scene.draws.push_back({mesh, addMaterial(scene, std::move(material)), glm::scale(place, glm::vec3(radius))});
  }
  return scene;
}

} // namespace vitrail::tool
