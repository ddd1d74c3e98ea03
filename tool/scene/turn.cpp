#include "turn.h"

namespace vitrail::tool {

std::optional<UpAxis> upAxisNamed(std::string_view name) {
  if (name == "y" || name == "Y") return UpAxis::Y;
  if (name == "z" || name == "Z") return UpAxis::Z;
  if (name == "x" || name == "X") return UpAxis::X;
  return {};
}

glm::dmat3 turnOf(UpAxis up) {
  switch (up) { // where the file's axes go, one column each
    case UpAxis::Z:
      return {{1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}};
    case UpAxis::X:
      return {{0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
    default:
      return glm::dmat3(1.0);
  }
}

void turnScene(Scene& scene, UpAxis up) {
  if (up == UpAxis::Y) return;
  const glm::dmat3 exact = turnOf(up);
  const glm::mat3 turn(exact);
  const glm::mat4 placed(turn);
  scene.origin = exact * scene.origin;
  for (Draw& draw : scene.draws) draw.transform = placed * draw.transform;
  for (SceneCamera& camera : scene.cameras) camera.cameraToWorld = placed * camera.cameraToWorld;
  for (Light& light : scene.lights) {
    light.position = turn * light.position;
    light.direction = turn * light.direction;
  }
}

} // namespace vitrail::tool
