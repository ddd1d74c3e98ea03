// Thousands of thin tubes that grow out of a core and curl: few fragments for how deep they lie, and triangles that are
// small in every direction.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "parts.h"
#include "random.h"
#include "shapes.h"

namespace vitrail::tool {
namespace {

constexpr std::uint32_t strandColors = 8;
constexpr std::uint32_t curvePoints = 30; // of a tube's curve
constexpr std::uint32_t sides = 5;
constexpr float coreRadius = 0.26F;

// A curve from the core outward. Its direction turns around an axis of its own, which wanders, and gravity of the core
// keeps it near.
void growStrand(Random& random, std::vector<glm::vec3>& curve, std::vector<float>& radii) {
  constexpr float step = 0.062F;
  const glm::vec3 root = random.direction();
  glm::vec3 place = coreRadius * 0.96F * root;
  glm::vec3 heading = glm::normalize(root + 0.35F * random.direction());
  glm::vec3 axis = random.direction();
  const float curl = random.range(0.06F, 0.24F);
  const float length = step * random.range(0.7F, 1.15F);
  for (std::uint32_t k = 0; k < curvePoints; ++k) {
    curve[k] = place;
    const float along = static_cast<float>(k) / static_cast<float>(curvePoints - 1);
    radii[k] = 0.0062F * (1.0F - 0.75F * along * along);
    axis = glm::normalize(axis + 0.25F * random.inBall());
    const glm::vec3 inward = -0.13F * glm::dot(place, place) * place;
    heading = glm::normalize(heading + curl * glm::cross(axis, heading) + inward);
    place += length * heading;
  }
}

} // namespace

Scene makeHairball(std::uint32_t count, std::uint32_t seed) {
  Random random(seed);
  Scene scene;
  scene.name = "hairball";
  Mesh core = uvSphere(64, 32);
  for (glm::vec3& position : core.positions) position *= coreRadius;
  Material coreMaterial = glassMaterial(linearFromSrgb({0.25F, 0.12F, 0.08F}), 0.5F, 0.4F);
  coreMaterial.name = "core";
  const std::uint32_t coreMesh = addMesh(scene, std::move(core));
  scene.draws.push_back({coreMesh, addMaterial(scene, std::move(coreMaterial)), glm::mat4(1.0F)});

  std::array<Mesh, strandColors> strands;
  std::vector<glm::vec3> curve(curvePoints);
  std::vector<float> radii(curvePoints);
  for (std::uint32_t i = 0; i < count; ++i) {
    growStrand(random, curve, radii);
    append(strands[i % strandColors], tube(curve, radii, sides));
  }
  for (std::uint32_t i = 0; i < std::min(count, strandColors); ++i) {
    const float shade = static_cast<float>(i) / static_cast<float>(strandColors - 1);
    Material material =
        glassMaterial(colorFromHue(0.02F + 0.09F * shade, 0.8F - 0.3F * shade, 0.55F + 0.4F * shade), 0.22F, 0.35F);
    material.name = "strands " + std::to_string(i);
    const std::uint32_t mesh = addMesh(scene, std::move(strands[i]));
    scene.draws.push_back({mesh, addMaterial(scene, std::move(material)), glm::mat4(1.0F)});
  }
  return scene;
}

} // namespace vitrail::tool
