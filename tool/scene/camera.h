// Where a picture is taken from, and the matrices that the host renderer draws with.
#pragma once

#include <span>
#include <vector>

#include "scene.h"

namespace vitrail::tool {

// A picture's view of a scene. It looks along its own -Z; +X is right and +Y is up in the picture.
struct View {
  glm::mat4 cameraToWorld{1.0F}; // a rotation and a translation
  bool orthographic = false;
  float verticalFov = 0.785398F; // radians; perspective only
  float halfHeight = 1.0F;       // world units; orthographic only
  float nearPlane = 0.1F;        // above 0 for perspective
  float farPlane = 0.0F;         // 0: infinite (perspective only)
};

// An orbit around the middle of a scene, in degrees. Azimuth 0 looks along -Z from the front (+Z), 90 from the right
// (+X); elevation 90 looks down. Zoom 1 fits the whole scene, 2 shows its middle twice as large: like a longer lens,
// from the same place, so that the near plane never cuts into the scene. Zoom is above 0.
struct Orbit {
  float azimuth = 35.0F;
  float elevation = 20.0F;
  float zoom = 1.0F;
  float fov = 45.0F; // the vertical field of view at zoom 1: a wider one is seen from nearer
};

// A camera at a place of the scene that looks at another, upright; looking straight up or down, with the top of the
// picture towards -Z or +Z.
struct LookAt {
  glm::dvec3 eye{0.0};
  glm::dvec3 target{0.0}; // another point than the eye
  float fov = 45.0F;      // vertical, degrees, between 0 and 180
};

// The view from a camera of the file.
View viewOf(const SceneCamera& camera);

// The view that shows the whole scene from the given orbit (default: the three-quarter view), in a picture of `aspect`
// = width / height, with the orbit's vertical field of view at zoom 1. What the scene covers of the picture is in its
// middle, with a narrow margin. The near and far plane enclose the scene, which has at least one draw.
View frameScene(const Scene& scene, const Orbit& orbit, float aspect);

// The same for a box. A scene seldom reaches the corners of its box, so it looks smaller in this view than in its own.
View frameScene(const Bounds& bounds, const Orbit& orbit, float aspect);

// The same for points, of which there is at least one.
View frameScene(std::span<const glm::dvec3> points, const Orbit& orbit, float aspect);

// The view from a place. The near and far plane enclose what is in front of the camera of the scene, or of some points.
View lookFrom(const Scene& scene, const LookAt& look);
View lookFrom(std::span<const glm::dvec3> points, const LookAt& look);

// World to camera.
glm::mat4 viewMatrix(const View& view);

// Camera to Vulkan clip space (y down) with reversed depth: 1 at the near plane, 0 at the far plane or infinity.
glm::mat4 projectionMatrix(const View& view, float aspect);

} // namespace vitrail::tool
