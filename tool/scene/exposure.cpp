// Illuminance is looked at in the middle of triangles, evenly chosen from all that are drawn.
#include "exposure.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace vitrail::tool {
namespace {

constexpr double kOwnLight = 2.0;             // docs/shading.md: the tool's light
constexpr std::uint64_t kMostSamples = 16384; // triangles that are looked at
constexpr double kNearest = 0.05; // no surface counts as nearer to a light than this share of the scene's size

// A triangle's middle, and its normal as long as twice its area.
struct Facet {
  glm::dvec3 middle{0.0};
  glm::dvec3 normal{0.0};
};

Facet facetOf(const Mesh& mesh, std::size_t triangle, const glm::dmat4& transform) {
  glm::dvec3 corner[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec3 position = mesh.positions[mesh.indices[triangle * 3 + i]];
    corner[i] = glm::dvec3(transform * glm::dvec4(glm::dvec3(position), 1.0));
  }
  // A mirror turns the corners round, and the side that was outside stays outside.
  const double side = glm::determinant(glm::dmat3(transform)) < 0.0 ? -1.0 : 1.0;
  return {(corner[0] + corner[1] + corner[2]) / 3.0, side * glm::cross(corner[1] - corner[0], corner[2] - corner[0])};
}

// The brightest channel of what a light sends to a place where nothing is nearer than `nearest`, and the direction to
// the light. The formulas of docs/shading.md under "The file's lights".
double brightness(const Light& light, const glm::dvec3& place, double nearest, glm::dvec3& toLight) {
  double share = 1.0;
  toLight = -glm::dvec3(light.direction);
  if (light.kind != Light::Kind::Directional) {
    const glm::dvec3 way = glm::dvec3(light.position) - place;
    const double distance = std::max(glm::length(way), nearest);
    if (!(distance > 0.0)) return 0.0;
    toLight = way / distance;
    const double relative = light.range > 0.0F ? distance / double{light.range} : 0.0;
    share = std::clamp(1.0 - relative * relative * relative * relative, 0.0, 1.0) / (distance * distance);
    if (light.kind == Light::Kind::Spot) {
      const double outer = std::cos(double{light.outerConeAngle});
      const double scale = 1.0 / std::max(std::cos(double{light.innerConeAngle}) - outer, 0.001);
      const double along = glm::dot(-toLight, glm::dvec3(light.direction));
      const double cone = std::clamp((along - outer) * scale, 0.0, 1.0);
      share *= cone * cone;
    }
  }
  const glm::dvec3 intensity(light.intensity);
  return share * std::max({intensity.r, intensity.g, intensity.b});
}

// What falls on one side of a surface: the sum of the lights' own brightness, as if each shone straight at it.
struct Sample {
  double light = 0.0;
  double flux = 0.0; // light times area
};

class Meter {
 public:
  explicit Meter(const Scene& scene) : scene_(scene) {
    const Bounds bounds = worldBounds(scene);
    nearest_ = kNearest * glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
  }

  void look(const Facet& facet, bool bothSides) {
    const double area = glm::length(facet.normal);
    if (!(area > 0.0)) return;
    double front = 0.0;
    double back = 0.0;
    for (const Light& light : scene_.lights) {
      glm::dvec3 toLight(0.0);
      const double shines = brightness(light, facet.middle, nearest_, toLight);
      (glm::dot(facet.normal, toLight) > 0.0 ? front : back) += shines;
    }
    add(front, area);
    if (bothSides) add(back, area);
  }

  // The light up to which half of the flux comes; 0 without any.
  double middle() {
    std::sort(samples_.begin(), samples_.end(), [](const Sample& a, const Sample& b) { return a.light < b.light; });
    double all = 0.0;
    for (const Sample& sample : samples_) all += sample.flux;
    double sum = 0.0;
    for (const Sample& sample : samples_) {
      sum += sample.flux;
      if (2.0 * sum >= all) return sample.light;
    }
    return 0.0;
  }

 private:
  void add(double light, double area) {
    if (light > 0.0 && std::isfinite(light * area)) samples_.push_back({light, light * area});
  }

  const Scene& scene_;
  double nearest_ = 0.0;
  std::vector<Sample> samples_;
};

} // namespace

double lightExposure(const Scene& scene) {
  std::uint64_t triangles = 0;
  const auto isLit = [&](const Draw& draw) {
    return scene.meshes[draw.mesh].primitive == Primitive::Triangles && !scene.materials[draw.material].unlit;
  };
  for (const Draw& draw : scene.draws) {
    if (isLit(draw)) triangles += scene.meshes[draw.mesh].indices.size() / 3;
  }
  if (triangles == 0 || scene.lights.empty()) return 1.0;
  Meter meter(scene);
  const std::uint64_t step = (triangles + kMostSamples - 1) / kMostSamples;
  std::uint64_t next = 0; // of the triangles of this draw
  for (const Draw& draw : scene.draws) {
    if (!isLit(draw)) continue;
    const Mesh& mesh = scene.meshes[draw.mesh];
    const Material& material = scene.materials[draw.material];
    const std::uint64_t count = mesh.indices.size() / 3;
    const glm::dmat4 transform(draw.transform);
    for (; next < count; next += step) {
      meter.look(facetOf(mesh, next, transform), material.doubleSided || isTransparent(material));
    }
    next -= count;
  }
  const double light = meter.middle();
  return light > 0.0 ? kOwnLight / light : 1.0;
}

} // namespace vitrail::tool
