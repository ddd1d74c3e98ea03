// Surfaces of revolution, rectangles and tubes.
#include "shapes.h"

#include <cmath>
#include <numbers>

#include <glm/gtc/constants.hpp>

namespace vitrail::tool {
namespace {

// A direction around the Y axis. From the front (+Z), growing angles go to the right (+X).
struct Spoke {
  float sine;
  float cosine;
};

Spoke spoke(std::uint32_t i, std::uint32_t count) {
  const double angle = 2.0 * std::numbers::pi * static_cast<double>(i % count) / static_cast<double>(count);
  return {static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle))};
}

// Point k of an arc from one angle above the horizontal to another. At a quarter turn it is exactly on the axis.
ProfilePoint arcPoint(float radius, float centerHeight, double from, double to, std::uint32_t k, std::uint32_t steps) {
  const double angle = k == steps ? to : from + (to - from) * static_cast<double>(k) / static_cast<double>(steps);
  const bool onAxis = std::abs(std::abs(angle) - 0.5 * std::numbers::pi) < 1e-9;
  const auto across = onAxis ? 0.0F : static_cast<float>(std::cos(angle));
  const auto up = static_cast<float>(std::sin(angle));
  return {radius * across, centerHeight + radius * up, {across, up}};
}

void addTriangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

// The vertices of one profile point, all around. The first and the last one differ in their texture coordinates only.
// On the axis, each stands in the middle of its triangle.
void addLatheRow(Mesh& mesh, const ProfilePoint& point, float v, std::uint32_t segments) {
  const glm::vec2 normal = glm::normalize(point.normal);
  for (std::uint32_t i = 0; i <= segments; ++i) {
    const bool onAxis = point.radius == 0.0F;
    const Spoke direction = onAxis ? spoke(2 * i + 1, 2 * segments) : spoke(i, segments);
    Vertex vertex;
    vertex.position = {point.radius * direction.sine, point.height, point.radius * direction.cosine};
    vertex.normal = glm::normalize(glm::vec3(normal.x * direction.sine, normal.y, normal.x * direction.cosine));
    vertex.tangent = {direction.cosine, 0.0F, -direction.sine, 1.0F};
    const float column = static_cast<float>(i) + (onAxis ? 0.5F : 0.0F);
    vertex.texCoord0 = {column / static_cast<float>(segments), v};
    vertex.texCoord1 = vertex.texCoord0;
    mesh.add(vertex);
  }
}

// The directions across a tube at one of its points.
struct Frame {
  glm::vec3 tangent;
  glm::vec3 normal;
  glm::vec3 binormal;
};

std::vector<Frame> transportFrames(std::span<const glm::vec3> curve) {
  std::vector<Frame> frames(curve.size());
  glm::vec3 normal(0.0F);
  for (std::size_t k = 0; k < curve.size(); ++k) {
    const glm::vec3 before = curve[k == 0 ? 0 : k - 1];
    const glm::vec3 after = curve[k + 1 == curve.size() ? k : k + 1];
    const glm::vec3 tangent = glm::normalize(after - before);
    if (k == 0) {
      const glm::vec3 other = std::abs(tangent.y) < 0.8F ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
      normal = other;
    }
    normal = glm::normalize(normal - glm::dot(normal, tangent) * tangent);
    frames[k] = {tangent, normal, glm::cross(tangent, normal)};
  }
  return frames;
}

} // namespace

Mesh lathe(std::span<const ProfilePoint> profile, std::uint32_t segments) {
  std::vector<float> travelled(profile.size(), 0.0F);
  for (std::size_t j = 1; j < profile.size(); ++j) {
    const glm::vec2 step(profile[j].radius - profile[j - 1].radius, profile[j].height - profile[j - 1].height);
    travelled[j] = travelled[j - 1] + glm::length(step);
  }
  Mesh mesh;
  for (std::size_t j = 0; j < profile.size(); ++j) {
    addLatheRow(mesh, profile[j], travelled[j] / travelled.back(), segments);
  }
  for (std::uint32_t j = 0; j + 1 < profile.size(); ++j) {
    if (travelled[j] == travelled[j + 1]) continue; // a sharp edge
    for (std::uint32_t i = 0; i < segments; ++i) {
      const std::uint32_t topLeft = j * (segments + 1) + i;
      const std::uint32_t bottomLeft = topLeft + segments + 1;
      if (profile[j + 1].radius > 0.0F) addTriangle(mesh, topLeft, bottomLeft, bottomLeft + 1);
      if (profile[j].radius > 0.0F) addTriangle(mesh, topLeft, bottomLeft + 1, topLeft + 1);
    }
  }
  return mesh;
}

Mesh uvSphere(std::uint32_t segments, std::uint32_t rings) {
  std::vector<ProfilePoint> profile;
  constexpr double quarter = 0.5 * std::numbers::pi;
  for (std::uint32_t k = 0; k <= rings; ++k) profile.push_back(arcPoint(1.0F, 0.0F, quarter, -quarter, k, rings));
  return lathe(profile, segments);
}

Mesh capsule(float topRadius, float bottomRadius, float halfLength, std::uint32_t segments, std::uint32_t capRings) {
  constexpr double quarter = 0.5 * std::numbers::pi;
  // The cone touches both spheres where their normal is its own.
  const double slope = std::asin(static_cast<double>((bottomRadius - topRadius) / (2.0F * halfLength)));
  std::vector<ProfilePoint> profile;
  for (std::uint32_t k = 0; k <= capRings; ++k) {
    profile.push_back(arcPoint(topRadius, halfLength, quarter, slope, k, capRings));
  }
  for (std::uint32_t k = 0; k <= capRings; ++k) {
    profile.push_back(arcPoint(bottomRadius, -halfLength, slope, -quarter, k, capRings));
  }
  return lathe(profile, segments);
}

Mesh disc(float radius, float halfHeight, float bevel, std::uint32_t segments) {
  constexpr double quarter = 0.5 * std::numbers::pi;
  constexpr std::uint32_t bevelSteps = 6;
  const float inner = radius - bevel;
  std::vector<ProfilePoint> profile{{0.0F, halfHeight, {0.0F, 1.0F}}};
  const auto addBevel = [&](float centerHeight, double from, double to) {
    for (std::uint32_t k = 0; k <= bevelSteps; ++k) {
      ProfilePoint point = arcPoint(bevel, centerHeight, from, to, k, bevelSteps);
      point.radius += inner;
      profile.push_back(point);
    }
  };
  addBevel(halfHeight - bevel, quarter, 0.0);
  addBevel(bevel - halfHeight, 0.0, -quarter);
  profile.push_back({0.0F, -halfHeight, {0.0F, -1.0F}});
  return lathe(profile, segments);
}

Mesh torus(float radius, float tubeRadius, std::uint32_t segments, std::uint32_t sides) {
  std::vector<ProfilePoint> profile;
  for (std::uint32_t k = 0; k <= sides; ++k) {
    const Spoke direction = spoke(k, sides); // from the innermost point over the top and down the outside
    const glm::vec2 normal(-direction.cosine, direction.sine);
    profile.push_back({radius + tubeRadius * normal.x, tubeRadius * normal.y, normal});
  }
  return lathe(profile, segments);
}

Mesh quad(float halfWidth, float halfHeight) {
  Mesh mesh;
  for (const glm::vec2 corner : {glm::vec2(0.0F, 0.0F), {0.0F, 1.0F}, {1.0F, 1.0F}, {1.0F, 0.0F}}) {
    Vertex vertex;
    vertex.position = {(2.0F * corner.x - 1.0F) * halfWidth, (1.0F - 2.0F * corner.y) * halfHeight, 0.0F};
    vertex.texCoord0 = corner;
    vertex.texCoord1 = corner;
    mesh.add(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

Mesh tube(std::span<const glm::vec3> curve, std::span<const float> radii, std::uint32_t sides) {
  const std::vector<Frame> frames = transportFrames(curve);
  Mesh mesh;
  const auto addVertex = [&mesh](const glm::vec3& position, const glm::vec3& normal, const glm::vec3& tangent) {
    Vertex vertex;
    vertex.position = position;
    vertex.normal = glm::normalize(normal);
    vertex.tangent = glm::vec4(tangent, 1.0F);
    mesh.add(vertex);
  };
  for (std::size_t k = 0; k < curve.size(); ++k) {
    const Frame& frame = frames[k];
    for (std::uint32_t i = 0; i < sides; ++i) {
      const Spoke direction = spoke(i, sides);
      const glm::vec3 outward = direction.cosine * frame.normal + direction.sine * frame.binormal;
      const glm::vec3 around = direction.cosine * frame.binormal - direction.sine * frame.normal;
      addVertex(curve[k] + radii[k] * outward, outward, around);
    }
  }
  const auto firstTip = static_cast<std::uint32_t>(mesh.vertexCount());
  addVertex(curve.front() - radii.front() * frames.front().tangent, -frames.front().tangent, frames.front().normal);
  addVertex(curve.back() + radii.back() * frames.back().tangent, frames.back().tangent, frames.back().normal);

  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t right = (i + 1) % sides;
    for (std::uint32_t k = 0; k + 1 < curve.size(); ++k) {
      const std::uint32_t below = k * sides;
      const std::uint32_t above = below + sides;
      addTriangle(mesh, above + i, below + i, below + right);
      addTriangle(mesh, above + i, below + right, above + right);
    }
    addTriangle(mesh, firstTip, right, i);
    addTriangle(mesh, firstTip + 1, firstTip - sides + i, firstTip - sides + right);
  }
  return mesh;
}

void append(Mesh& mesh, const Mesh& part) {
  const auto first = static_cast<std::uint32_t>(mesh.vertexCount());
  for (std::size_t i = 0; i < part.vertexCount(); ++i) mesh.add(part.vertex(i));
  for (const std::uint32_t index : part.indices) mesh.indices.push_back(first + index);
}

} // namespace vitrail::tool
