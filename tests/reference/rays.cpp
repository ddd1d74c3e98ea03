// Triangles are Embree user geometry: Embree walks its tree over boxes that are a little too large, and calls back for
// each triangle whose box the ray may touch. The test itself follows Woop, Benthin, Wald, "Watertight Ray/Triangle
// Intersection" (JCGT 2013): corners are sheared so that the ray becomes the z axis, and three edge functions decide.
#include "rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace vitrail::tool::reference {

namespace {

struct Triangle {
  std::array<glm::dvec3, 3> corners; // camera space
  std::uint32_t draw = 0;
  std::uint32_t index = 0;
  bool mirrored = false; // the draw's transform turns counter-clockwise into clockwise
};

// Twice the signed area of (0, a, b). Swapping a and b gives exactly the negated value, however the compiler contracts
// products, so that two triangles never both own or both miss their common edge.
double edgeFunction(const glm::dvec2& a, const glm::dvec2& b) {
  const bool ordered = a.x < b.x || (a.x == b.x && a.y < b.y);
  const glm::dvec2& p = ordered ? a : b;
  const glm::dvec2& q = ordered ? b : a;
  const double area = p.x * q.y - p.y * q.x;
  return ordered ? area : -area;
}

// Whether the origin is inside of the edge from a to b of a counter-clockwise triangle (y up). On the edge itself it is
// where the edge is a left one (going down) or a top one (going left).
bool insideEdge(double area, const glm::dvec2& a, const glm::dvec2& b) {
  if (area != 0.0) return area > 0.0;
  const glm::dvec2 along = b - a;
  return along.y < 0.0 || (along.y == 0.0 && along.x < 0.0);
}

// A ray and a triangle in the space where the ray is the z axis: its corners, and the edge functions opposite of them.
struct Sheared {
  std::array<glm::dvec2, 3> p;
  glm::dvec3 area{0.0};
  double sum = 0.0;
};

// Each corner as its own ray sees it.
Sheared shear(const Triangle& triangle, const std::array<PictureRay, 3>& rays) {
  Sheared sheared;
  std::array<glm::dvec2, 3>& p = sheared.p;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3& corner = triangle.corners[i];
    p[i] = glm::dvec2(corner) - rays[i].origin + rays[i].slope * corner.z;
  }
  sheared.area = {edgeFunction(p[1], p[2]), edgeFunction(p[2], p[0]), edgeFunction(p[0], p[1])};
  sheared.sum = sheared.area.x + sheared.area.y + sheared.area.z;
  return sheared;
}

// Where the ray meets the triangle's plane.
void place(RayHit& hit, const Triangle& triangle, const Sheared& sheared) {
  hit.barycentric = sheared.area / sheared.sum;
  hit.depth = -(hit.barycentric.x * triangle.corners[0].z + hit.barycentric.y * triangle.corners[1].z +
                hit.barycentric.z * triangle.corners[2].z);
}

void addHit(const std::vector<Triangle>& triangles, std::uint32_t number, const PictureRay& ray,
            std::vector<RayHit>& hits) {
  const Triangle& triangle = triangles[number];
  const Sheared sheared = shear(triangle, {ray, ray, ray});
  const auto& [p, area, sum] = sheared;
  if (!(sum != 0.0)) return; // seen edge-on, or not finite
  const bool inside =
      sum > 0.0 ? insideEdge(area.x, p[1], p[2]) && insideEdge(area.y, p[2], p[0]) && insideEdge(area.z, p[0], p[1])
                : insideEdge(-area.x, p[2], p[1]) && insideEdge(-area.y, p[0], p[2]) && insideEdge(-area.z, p[1], p[0]);
  if (!inside) return;
  RayHit hit;
  hit.number = number;
  hit.draw = triangle.draw;
  hit.triangle = triangle.index;
  hit.front = (sum > 0.0) != triangle.mirrored;
  place(hit, triangle, sheared);
  hits.push_back(hit);
}

// What one ray carries through Embree. The context stands first: callbacks get a pointer to it.
#if __has_include(<embree4/rtcore.h>)
struct Walk {
  RTCRayQueryContext context;
  const PictureRay* ray;
  std::vector<RayHit>* hits;
};

void intersect(RTCScene scene, Walk& walk, RTCRayHit& query) {
  rtcInitRayQueryContext(&walk.context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &walk.context;
  rtcIntersect1(scene, &query, &arguments);
}
#else
struct Walk {
  RTCIntersectContext context;
  const PictureRay* ray;
  std::vector<RayHit>* hits;
};

void intersect(RTCScene scene, Walk& walk, RTCRayHit& query) {
  rtcInitIntersectContext(&walk.context);
  rtcIntersect1(scene, &walk.context, &query);
}
#endif

// Called for each candidate. The ray's end is left as it is, so Embree goes on to all others.
void onCandidate(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  const auto& triangles = *static_cast<const std::vector<Triangle>*>(args->geometryUserPtr);
  auto* walk = reinterpret_cast<Walk*>(args->context);
  addHit(triangles, args->primID, *walk->ray, *walk->hits);
}

// The box of a triangle, grown by more than what single precision loses on the way to it.
void onBounds(const RTCBoundsFunctionArguments* args) {
  const auto& corners = (*static_cast<const std::vector<Triangle>*>(args->geometryUserPtr))[args->primID].corners;
  const glm::dvec3 low = glm::min(corners[0], glm::min(corners[1], corners[2]));
  const glm::dvec3 high = glm::max(corners[0], glm::max(corners[1], corners[2]));
  const glm::dvec3 size = glm::max(glm::abs(low), glm::abs(high));
  const double margin = 4e-6 * std::max({size.x, size.y, size.z}) + 1e-30;
  RTCBounds& box = *args->bounds_o;
  box.lower_x = static_cast<float>(low.x - margin);
  box.lower_y = static_cast<float>(low.y - margin);
  box.lower_z = static_cast<float>(low.z - margin);
  box.upper_x = static_cast<float>(high.x + margin);
  box.upper_y = static_cast<float>(high.y + margin);
  box.upper_z = static_cast<float>(high.z + margin);
}

std::vector<Triangle> placeTriangles(const Scene& scene, const View& view) {
  const glm::dmat4 worldToCamera = glm::inverse(glm::dmat4(view.cameraToWorld));
  std::vector<Triangle> triangles;
  for (std::size_t d = 0; d < scene.draws.size(); ++d) {
    const Draw& draw = scene.draws[d];
    const Mesh& mesh = scene.meshes.at(draw.mesh);
    const glm::dmat4 toCamera = worldToCamera * glm::dmat4(draw.transform);
    const bool mirrored = glm::determinant(glm::dmat3(glm::dmat4(draw.transform))) < 0.0;
    std::vector<glm::dvec3> placed(mesh.vertexCount());
    std::ranges::transform(mesh.positions, placed.begin(), [&](const glm::vec3& position) {
      return glm::dvec3(toCamera * glm::dvec4(glm::dvec3(position), 1.0));
    });
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) triangle.corners[k] = placed.at(mesh.indices[i + k]);
      triangle.draw = static_cast<std::uint32_t>(d);
      triangle.index = static_cast<std::uint32_t>(i / 3);
      triangle.mirrored = mirrored;
      triangles.push_back(triangle);
    }
  }
  return triangles;
}

} // namespace

struct RayScene::Impl {
  std::vector<Triangle> triangles;
  double start = 0.0; // the view depth that rays start from
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Impl(const Scene& model, const View& view)
      : triangles(placeTriangles(model, view)), start(view.orthographic ? double{view.nearPlane} - 1e-3 : 0.0) {
    device = rtcNewDevice(nullptr);
    if (device == nullptr) throw std::runtime_error("Embree made no device");
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned int>(triangles.size()));
    rtcSetGeometryUserData(geometry, &triangles);
    rtcSetGeometryBoundsFunction(
        geometry, [](const RTCBoundsFunctionArguments* args) { onBounds(args); }, nullptr);
    rtcSetGeometryIntersectFunction(geometry, [](const RTCIntersectFunctionNArguments* args) { onCandidate(args); });
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
      release();
      throw std::runtime_error("Embree could not build its tree");
    }
  }

  ~Impl() { release(); }

  void release() {
    if (scene != nullptr) rtcReleaseScene(std::exchange(scene, nullptr));
    if (device != nullptr) rtcReleaseDevice(std::exchange(device, nullptr));
  }
};

PictureRay pictureRay(const View& view, const glm::dvec2& pixel, const glm::dvec2& size) {
  const double aspect = size.x / size.y;
  const glm::dvec2 square(2.0 * pixel.x / size.x - 1.0, 1.0 - 2.0 * pixel.y / size.y);
  PictureRay ray;
  if (view.orthographic) {
    ray.origin = square * double{view.halfHeight} * glm::dvec2(aspect, 1.0);
  } else {
    ray.slope = square * std::tan(0.5 * double{view.verticalFov}) * glm::dvec2(aspect, 1.0);
  }
  return ray;
}

RayScene::RayScene(const Scene& scene, const View& view) : impl_(std::make_unique<Impl>(scene, view)) {}

RayScene::~RayScene() = default;

void RayScene::allHits(const PictureRay& ray, std::vector<RayHit>& hits) const {
  hits.clear();
  const glm::dvec2 from = ray.origin + ray.slope * impl_->start;
  RTCRayHit query{};
  query.ray.org_x = static_cast<float>(from.x);
  query.ray.org_y = static_cast<float>(from.y);
  query.ray.org_z = static_cast<float>(-impl_->start);
  query.ray.dir_x = static_cast<float>(ray.slope.x);
  query.ray.dir_y = static_cast<float>(ray.slope.y);
  query.ray.dir_z = -1.0F;
  query.ray.tnear = 0.0F;
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  Walk walk{};
  walk.ray = &ray;
  walk.hits = &hits;
  intersect(impl_->scene, walk, query);
}

RayHit RayScene::onSamePlane(const RayHit& hit, const std::array<PictureRay, 3>& rays) const {
  const Triangle& triangle = impl_->triangles[hit.number];
  RayHit moved = hit;
  place(moved, triangle, shear(triangle, rays));
  return moved;
}

} // namespace vitrail::tool::reference
