#include "frame_data.h"

#include <cmath>

namespace vitrail::tool {

namespace {

const glm::dvec3 kLightInCamera(-0.4, 0.7, 0.6); // docs/shading.md

} // namespace

shaders::FrameData makeFrameData(const View& view, std::uint32_t width, std::uint32_t height,
                                 const glm::dvec3& origin) {
  View local = view;
  local.cameraToWorld[3] = glm::vec4(glm::dvec3(view.cameraToWorld[3]) - origin, 1.0);
  const double w = width;
  const double h = height;
  const auto aspect = static_cast<float>(w / h);
  const glm::dmat3 axes{glm::dmat4(view.cameraToWorld)};

  shaders::FrameData data{};
  const glm::mat4 projection = projectionMatrix(local, aspect);
  data.viewProjection = projection * viewMatrix(local);
  data.depth = glm::vec4(-projection[2][2], projection[3][2], 2.0 / 256.0 / w, 2.0 / 256.0 / h);
  data.cameraToWorld = local.cameraToWorld;
  data.eye = glm::vec4(glm::vec3(local.cameraToWorld[3]), view.orthographic ? 1.0F : 0.0F);
  data.toLight = glm::vec4(glm::normalize(axes * kLightInCamera), 0.0);
  if (!view.orthographic) { // else all pixels look straight ahead
    const double tangentY = std::tan(0.5 * static_cast<double>(view.verticalFov));
    const double tangentX = tangentY * w / h;
    data.ray = glm::vec4(2.0 * tangentX / w, 2.0 * tangentY / h, tangentX, tangentY);
  }
  return data;
}

} // namespace vitrail::tool
