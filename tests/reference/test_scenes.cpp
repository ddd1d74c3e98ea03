// Rectangles and the two views that tests look at them with.
#include "test_scenes.h"

#include <numbers>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

namespace vitrail::tool::reference {

Material unlitMaterial(const glm::vec4& color, AlphaMode mode) {
  Material material;
  material.alphaMode = mode;
  material.unlit = true;
  material.baseColor = color;
  return material;
}

std::uint32_t addRectangle(Scene& scene, const Rectangle& rectangle, const Material& material) {
  Mesh mesh;
  const glm::vec2 low = rectangle.low;
  const glm::vec2 high = rectangle.high;
  for (const glm::vec2 corner : {low, glm::vec2(high.x, low.y), high, glm::vec2(low.x, high.y)}) {
    Vertex vertex;
    vertex.position = glm::vec3(corner, rectangle.z);
    vertex.texCoord0 = (corner - low) / (high - low);
    vertex.texCoord0.y = 1.0F - vertex.texCoord0.y;
    mesh.add(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene.meshes.push_back(std::move(mesh));
  scene.materials.push_back(material);
  Draw draw;
  draw.mesh = static_cast<std::uint32_t>(scene.meshes.size() - 1);
  draw.material = static_cast<std::uint32_t>(scene.materials.size() - 1);
  scene.draws.push_back(draw);
  return static_cast<std::uint32_t>(scene.draws.size() - 1);
}

View straightView() {
  View view;
  view.cameraToWorld = glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, 0.0F, 10.0F));
  view.orthographic = true;
  view.halfHeight = 1.0F;
  view.nearPlane = 1.0F;
  view.farPlane = 19.0F;
  return view;
}

View wideView() {
  View view;
  view.verticalFov = 0.5F * std::numbers::pi_v<float>;
  view.nearPlane = 0.5F;
  return view;
}

} // namespace vitrail::tool::reference
