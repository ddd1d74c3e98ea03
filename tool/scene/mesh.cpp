// How meshes keep vertices.
#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "scene.h"

namespace vitrail::tool {
namespace {

// Makes an array of one element a vertex of an empty one that stands for `value`.
template <typename Value>
void fill(std::vector<Value>& values, std::size_t count, const Value& value) {
  if (values.empty()) values.resize(count, value);
}

float signOf(float value) { return value < 0.0F ? -1.0F : 1.0F; }

// The projection to [-1, 1] squared.
glm::vec2 octahedral(const glm::vec3& v) {
  const float sum = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
  if (!(sum > 0.0F)) return glm::vec2(0.0F);
  const glm::vec2 p = glm::vec2(v) / sum;
  if (v.z >= 0.0F) return p;
  return {(1.0F - std::abs(p.y)) * signOf(p.x), (1.0F - std::abs(p.x)) * signOf(p.y)};
}

glm::vec3 fromOctahedral(const glm::vec2& p) {
  glm::vec3 v(p, 1.0F - std::abs(p.x) - std::abs(p.y));
  const float fold = std::max(-v.z, 0.0F);
  v.x -= fold * signOf(v.x);
  v.y -= fold * signOf(v.y);
  return glm::normalize(v);
}

// A signed normalised number of so many steps from 0 to 1.
std::int32_t stepsOf(float value, float steps) {
  return static_cast<std::int32_t>(std::lround(std::clamp(value, -1.0F, 1.0F) * steps));
}

constexpr float kSteps = 32767.0F;
constexpr float kTangentSteps = 16383.0F; // a bit less

std::int32_t lowerHalf(std::uint32_t packed) { return static_cast<std::int16_t>(packed & 0xffffU); }
std::int32_t upperHalf(std::uint32_t packed) { return static_cast<std::int16_t>(packed >> 16U); }
std::uint32_t halves(std::int32_t lower, std::int32_t upper) {
  return (static_cast<std::uint32_t>(lower) & 0xffffU) | static_cast<std::uint32_t>(upper) << 16U;
}

} // namespace

std::uint32_t packDirection(const glm::vec3& unitVector) {
  const glm::vec2 p = octahedral(unitVector);
  return halves(stepsOf(p.x, kSteps), stepsOf(p.y, kSteps));
}

glm::vec3 unpackDirection(std::uint32_t packed) {
  return fromOctahedral(glm::vec2(static_cast<float>(lowerHalf(packed)), static_cast<float>(upperHalf(packed))) /
                        kSteps);
}

std::uint32_t packTangent(const glm::vec4& tangent) {
  const glm::vec2 p = octahedral(glm::vec3(tangent));
  const std::int32_t y = stepsOf(p.y, kTangentSteps) * 2 + (tangent.w < 0.0F ? 1 : 0);
  return halves(stepsOf(p.x, kSteps), y);
}

glm::vec4 unpackTangent(std::uint32_t packed) {
  const std::int32_t y = upperHalf(packed);
  const glm::vec2 p(static_cast<float>(lowerHalf(packed)) / kSteps, static_cast<float>(y >> 1) / kTangentSteps);
  return {fromOctahedral(p), (y & 1) != 0 ? -1.0F : 1.0F};
}

std::uint64_t packColor(const glm::vec4& color) {
  constexpr float largest = 65504.0F; // else they would be infinite
  return glm::packHalf4x16(glm::min(color, glm::vec4(largest)));
}

glm::vec4 unpackColor(std::uint64_t packed) { return glm::unpackHalf4x16(packed); }

Vertex Mesh::vertex(std::size_t i) const {
  Vertex vertex;
  vertex.position = positions[i];
  if (!normals.empty()) vertex.normal = unpackDirection(normals[i]);
  if (!tangents.empty()) vertex.tangent = unpackTangent(tangents[i]);
  if (!texCoords0.empty()) vertex.texCoord0 = texCoords0[i];
  if (!texCoords1.empty()) vertex.texCoord1 = texCoords1[i];
  if (!colors.empty()) vertex.color = unpackColor(colors[i]);
  return vertex;
}

std::vector<Vertex> Mesh::vertices() const {
  std::vector<Vertex> all(vertexCount());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = vertex(i);
  return all;
}

void Mesh::add(const Vertex& vertex) {
  positions.push_back(vertex.position);
  fill(normals, vertexCount() - 1, packDirection(Vertex{}.normal));
  normals.resize(vertexCount());
  if (!tangents.empty()) tangents.resize(vertexCount());
  if (!texCoords0.empty()) texCoords0.resize(vertexCount());
  if (!texCoords1.empty()) texCoords1.resize(vertexCount());
  if (!colors.empty()) colors.resize(vertexCount());
  set(vertexCount() - 1, vertex);
}

void Mesh::set(std::size_t i, const Vertex& vertex) {
  const Vertex none;
  const std::size_t count = vertexCount();
  positions[i] = vertex.position;
  if (vertex.normal != none.normal) fill(normals, count, packDirection(none.normal));
  if (vertex.tangent != none.tangent) fill(tangents, count, packTangent(none.tangent));
  if (vertex.texCoord0 != none.texCoord0) fill(texCoords0, count, none.texCoord0);
  if (vertex.texCoord1 != none.texCoord1) fill(texCoords1, count, none.texCoord1);
  if (vertex.color != none.color) fill(colors, count, packColor(none.color));
  if (!normals.empty()) normals[i] = packDirection(vertex.normal);
  if (!tangents.empty()) tangents[i] = packTangent(vertex.tangent);
  if (!texCoords0.empty()) texCoords0[i] = vertex.texCoord0;
  if (!texCoords1.empty()) texCoords1[i] = vertex.texCoord1;
  if (!colors.empty()) colors[i] = packColor(vertex.color);
}

} // namespace vitrail::tool
