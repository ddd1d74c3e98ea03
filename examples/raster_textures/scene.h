// The scene of raster_textures.cpp, made here: meshes, where they are, and textures.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

constexpr uint32_t kTextureSide = 256;
constexpr uint32_t kTextureLevels = 9;
constexpr uint32_t kTextures = 2;

// ---- The scene

using Vec3 = std::array<float, 3>;
struct Vertex { // as transparent.glsl reads it
  Vec3 position;
  Vec3 normal;
  std::array<float, 2> texCoord;
};
using Matrix = std::array<std::array<float, 4>, 4>; // columns

struct Mesh {
  uint32_t firstIndex, indexCount, firstVertex, vertexCount;
};

struct Scene {
  std::vector<Vertex> vertices;
  std::vector<uint16_t> indices;
  std::vector<Matrix> instances;
  Mesh ball, floor, leaf, pane;
  static constexpr uint32_t kOpaque = 2, kLeaves = 30, kPanes = 2; // instances, in this order

  Scene();

 private:
  template <typename At>
  Mesh addGrid(uint32_t columns, uint32_t rows, std::array<float, 2> repeats, const At& at);
};

// A surface over (u, v) in the unit square. Its front is counter-clockwise, and its normal points there.
template <typename At>
Mesh Scene::addGrid(uint32_t columns, uint32_t rows, std::array<float, 2> repeats, const At& at) {
  const uint32_t triangles = 2 * columns * rows;
  const Mesh mesh{uint32_t(indices.size()), 3 * triangles, uint32_t(vertices.size()), (columns + 1) * (rows + 1)};
  for (uint32_t i = 0; i < mesh.vertexCount; ++i) {
    const uint32_t x = i % (columns + 1), y = i / (columns + 1);
    const float u = float(x) / float(columns), v = float(y) / float(rows), step = 0.001F;
    const Vec3 p = at(u, v), right = at(u + step, v), up = at(u, v + step);
    Vec3 a, b;
    for (int k = 0; k < 3; ++k) a[k] = right[k] - p[k], b[k] = up[k] - p[k];
    Vec3 normal{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const float length = std::hypot(normal[0], normal[1], normal[2]);
    for (float& n : normal) n /= length;
    vertices.push_back({p, normal, {repeats[0] * u, repeats[1] * (1.0F - v)}});
    if (x == columns || y == rows) continue;
    for (const uint32_t corner : {i, i + 1, i + columns + 1, i + columns + 1, i + 1, i + columns + 2})
      indices.push_back(uint16_t(corner));
  }
  return mesh;
}

constexpr float kPi = 3.14159265F;

inline Scene::Scene() {
  ball = addGrid(48, 24, {1, 1}, [](float u, float v) -> Vec3 {
    const float a = 2 * kPi * u, b = kPi * (0.001F + 0.997F * v);
    return {0.5F * std::sin(a) * std::sin(b), -0.5F * std::cos(b), 0.5F * std::cos(a) * std::sin(b)};
  });
  floor = addGrid(1, 1, {1, 1}, [](float u, float v) -> Vec3 { return {80 * u - 40, -1, 40 - 80 * v}; });
  leaf = addGrid(8, 8, {1, 1}, [](float u, float v) -> Vec3 {
    const float x = u - 0.5F;
    return {x, v, 0.3F * v * v - 0.5F * x * x};
  });
  pane = addGrid(48, 1, {3, 1}, [](float u, float v) -> Vec3 {
    return {0.8F * std::sin(2 * kPi * u), 1.4F * v - 1, 0.8F * std::cos(2 * kPi * u)};
  });
  const Matrix unit{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  instances.assign(kOpaque, unit);
  for (uint32_t i = 0; i < kLeaves; ++i) { // around the glass, in three rings
    const float a = 0.63F * float(i) + 0.2F * float(i / 10), lean = 0.25F + 0.2F * float(i % 3), size = 0.55F;
    const float s = size * std::sin(a), c = size * std::cos(a), out = std::sin(lean), up = std::cos(lean);
    const Vec3 at{0.9F * std::sin(a), -0.95F + 0.5F * float(i / 10), 0.9F * std::cos(a)};
    instances.push_back({{{c, 0, -s, 0},
                          {s * out, size * up, c * out, 0},
                          {s * up, -size * out, c * up, 0},
                          {at[0], at[1], at[2], 1}}});
  }
  const float s = std::sin(0.5F), c = std::cos(0.5F);
  instances.push_back(unit);
  instances.push_back({{{0.8F * c, 0.8F * s, 0, 0}, {-0.8F * s, 0.8F * c, 0, 0}, {0, 0, 0.8F, 0}, {0, 0.1F, 0, 1}}});
}

// ---- Textures

using Texel = std::array<float, 4>; // linear

inline Texel leafTexel(float x, float y) {
  const float away = std::fabs(x - 0.5F), along = 1 - y; // from the stem
  const bool inside = away < 0.42F * std::pow(std::sin(kPi * std::pow(along, 0.8F)), 0.8F);
  const float veins = std::fabs(std::remainder(7 * along - 5 * away, 1.0F));
  if (away < 0.015F || (veins < 0.06F && away < 0.4F)) return {0.42F, 0.6F, 0.16F, inside ? 0.95F : 0.0F};
  return {0.10F + 0.25F * along, 0.38F, 0.05F, inside ? 0.6F : 0.0F};
}

inline Texel glassTexel(float x, float y) {
  static constexpr Texel kColors[] = {
      {0.8F, 0.1F, 0.08F, 0.5F}, {0.1F, 0.25F, 0.75F, 0.45F}, {0.9F, 0.65F, 0.1F, 0.4F}, {0.85F, 0.9F, 0.95F, 0.2F}};
  const float a = 4 * (x + y), b = 4 * (x - y) + 4;
  if (std::fabs(std::remainder(a, 1.0F)) < 0.05F || std::fabs(std::remainder(b, 1.0F)) < 0.05F)
    return {0.05F, 0.05F, 0.06F, 1.0F}; // lead
  return kColors[(int(a) + 2 * int(b)) % 4];
}

inline float toSrgb(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(std::fmin(linear, 1.0F), 1 / 2.4F) - 0.055F;
}

// All levels of one texture, each the mean of four texels of the last, in sRGB.
inline std::vector<uint8_t> makeTexture(Texel (*at)(float x, float y)) {
  std::vector<uint8_t> bytes;
  std::vector<Texel> level(kTextureSide * kTextureSide);
  for (uint32_t i = 0; i < level.size(); ++i) {
    level[i] = at((float(i % kTextureSide) + 0.5F) / kTextureSide, (float(i / kTextureSide) + 0.5F) / kTextureSide);
  }
  for (uint32_t side = kTextureSide; side > 0; side /= 2) {
    for (const Texel& t : level) {
      for (int k = 0; k < 4; ++k) bytes.push_back(uint8_t(std::lround(255 * (k < 3 ? toSrgb(t[k]) : t[k]))));
    }
    std::vector<Texel> half(level.size() / 4);
    for (uint32_t i = 0; i < half.size(); ++i) {
      const Texel* t = &level[2 * (i % (side / 2)) + 2 * side * (i / (side / 2))];
      for (int k = 0; k < 4; ++k) half[i][k] = (t[0][k] + t[1][k] + t[side][k] + t[side + 1][k]) / 4;
    }
    level = half;
  }
  return bytes;
}
