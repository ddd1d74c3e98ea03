// Every triangle that a picture's ray passes through. Embree's tree finds the candidates; whether a ray meets a
// triangle, where and how deep is computed here in double precision.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "../../tool/scene/camera.h"
#include "../../tool/scene/scene.h"

namespace vitrail::tool::reference {

// A ray of a view in camera space (x right, y up, looking along -z). At view depth t it is at
// (origin + slope * t, -t).
struct PictureRay {
  glm::dvec2 origin{0.0};
  glm::dvec2 slope{0.0};
};

// The ray through a point of the picture, in pixels from its top left corner: pixel centres are at halves.
PictureRay pictureRay(const View& view, const glm::dvec2& pixel, const glm::dvec2& size);

struct RayHit {
  std::uint32_t number = 0;    // of the triangle among all that are drawn
  std::uint32_t draw = 0;      // index into Scene::draws
  std::uint32_t triangle = 0;  // index into the mesh's triangles
  glm::dvec3 barycentric{0.0}; // weights of the triangle's three corners, in order
  double depth = 0.0;          // view depth: distance along the camera's -z
  bool front = true;           // the ray meets the counter-clockwise side, as the mesh defines it
};

// The triangles of a scene in the camera space of a view. Scene and view are read by the constructor only.
class RayScene {
 public:
  RayScene(const Scene& scene, const View& view);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // Replaces `hits` with all hits of a ray, at any depth in front of the eye's plane (orthographic: of the near plane),
  // in no particular order. An edge belongs to one of the two triangles that share it, by the top-left rule. Safe to
  // call from several threads.
  void allHits(const PictureRay& ray, std::vector<RayHit>& hits) const;

  // Where another ray meets the plane of a hit's triangle, inside the triangle or not. `front` stays. Each corner of
  // the triangle has a ray of its own: one that is moved from the others moves its corner on the picture, the other
  // way.
  RayHit onSamePlane(const RayHit& hit, const std::array<PictureRay, 3>& rays) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vitrail::tool::reference
