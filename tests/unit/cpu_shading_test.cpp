// The shading on CPUs against docs/shading.md in double precision, and its textures against the Vulkan specification.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "../../tool/cpu/cpu_scene.h"
#include "../../tool/cpu/cpu_texture.h"
#include "../../tool/scene/exposure.h"
#include "../reference/shading.h"

namespace vitrail::tool::test {
namespace {

constexpr std::uint32_t kWidth = 320;
constexpr std::uint32_t kHeight = 200;
constexpr std::size_t kLanes = VITRAIL_CPU_LANES;

constexpr std::array kInstructions{VITRAIL_CPU_BASELINE, VITRAIL_CPU_SSE4, VITRAIL_CPU_AVX2, VITRAIL_CPU_AVX512};

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double number(double low = 0.0, double high = 1.0) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }
  bool chance(double share = 0.5) { return number() < share; }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  glm::dvec3 color(double most = 1.0) { return {number(0, most), number(0, most), number(0, most)}; }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 v(number(-1, 1), number(-1, 1), number(-1, 1));
      const double length = glm::length(v);
      if (length > 0.1 && length < 1.0) return v / length;
    }
  }

 private:
  std::mt19937_64 engine_;
};

// What the material of a scene is at a point, as textures of one texel each have it.
struct Texels {
  glm::dvec4 base{1.0};
  glm::dvec4 metallicRoughness{1.0};
  glm::dvec3 normal{0.5, 0.5, 1.0};
  double occlusion = 1.0;
  glm::dvec3 emissive{1.0};
  double transmission = 1.0;
  double specular = 1.0;
  glm::dvec3 specularColor{1.0};
  double clearcoat = 1.0;
  double clearcoatRoughness = 1.0;
  glm::dvec3 sheenColor{1.0};
  double sheenRoughness = 1.0;
  glm::dvec3 anisotropy{1.0, 0.5, 1.0};
  double iridescence = 1.0;
  double iridescenceThickness = 1.0;
  double thickness = 1.0;
};

// A scene of one draw, and the triangles that are seen at pixels of one block.
struct Case {
  Scene scene;
  View view;
  Texels texels;
  std::uint32_t x = 0; // of the block
  std::uint32_t y = 0;
  std::optional<float> opacity;
};

glm::dvec3 eyeOf(const View& view) { return glm::dvec3(view.cameraToWorld[3]); }

// The way from the eye through a point of the picture, and where it begins.
std::pair<glm::dvec3, glm::dvec3> rayAt(const View& view, double x, double y) {
  const double aspect = double{kWidth} / kHeight;
  const glm::dmat4 camera(view.cameraToWorld);
  const double across = (2.0 * x / kWidth - 1.0) * aspect;
  const double up = 1.0 - 2.0 * y / kHeight;
  if (view.orthographic) {
    const double half = view.halfHeight;
    return {glm::dvec3(camera * glm::dvec4(across * half, up * half, 0.0, 1.0)), -glm::dvec3(camera[2])};
  }
  const double tangent = std::tan(0.5 * double{view.verticalFov});
  return {eyeOf(view), glm::dmat3(camera) * glm::dvec3(across * tangent, up * tangent, -1.0)};
}

// One texel, and the slot that samples it.
glm::dvec4 addTexel(Scene& scene, TextureSlot& slot, Random& random, bool srgb, double alpha = -1.0) {
  Image image;
  image.width = image.height = 1;
  for (int i = 0; i < 4; ++i) image.rgba.push_back(static_cast<std::uint8_t>(random.below(256)));
  if (alpha >= 0.0) image.rgba[3] = static_cast<std::uint8_t>(std::lround(alpha * 255.0));
  slot.image = static_cast<std::int32_t>(scene.images.size());
  glm::dvec4 value;
  for (int i = 0; i < 4; ++i) {
    const double code = image.rgba[static_cast<std::size_t>(i)] / 255.0;
    value[i] = srgb && i < 3 ? reference::decodeSrgb(code) : code;
  }
  scene.images.push_back(std::move(image));
  return value;
}

void addLights(Scene& scene, Random& random) {
  for (std::size_t i = 1 + random.below(3); i > 0; --i) {
    Light light;
    light.kind = static_cast<Light::Kind>(random.below(3));
    light.intensity = random.color(3.0);
    light.position = random.direction() * random.number(1.0, 6.0);
    light.direction = random.direction();
    light.range = random.chance() ? 8.0F : 0.0F;
    light.innerConeAngle = 0.3F;
    light.outerConeAngle = 1.2F;
    scene.lights.push_back(light);
  }
}

void addExtensions(Material& material, Random& random) {
  const auto factor = [&] { return static_cast<float>(random.number()); };
  if (random.chance(0.3)) material.ior = static_cast<float>(random.number(1.0, 2.5));
  if (random.chance(0.3)) material.specular = factor();
  if (random.chance(0.3)) material.specularColor = random.color(2.0);
  if (random.chance(0.3)) {
    material.clearcoat = factor();
    material.clearcoatRoughness = factor();
  }
  if (random.chance(0.3)) {
    material.sheenColor = random.color();
    material.sheenRoughness = factor();
  }
  if (random.chance(0.2)) {
    material.anisotropy = factor();
    material.anisotropyRotation = static_cast<float>(random.number(0.0, 6.28));
  }
  if (random.chance(0.2)) material.iridescence = factor();
  if (random.chance(0.2)) {
    material.diffuseTransmission = factor();
    material.diffuseTransmissionColor = random.color();
  }
  if (random.chance(0.3)) material.transmission = factor();
  if (material.transmission > 0.0F && random.chance(0.5)) {
    material.thickness = factor();
    material.attenuationDistance = 0.7F;
    material.attenuationColor = random.color();
  }
  if (random.chance(0.2)) {
    material.specularGlossiness = true;
    material.specularColor = random.color();
  }
}

void addTextures(Case& c, Material& m, Random& random) {
  Scene& scene = c.scene;
  const auto texel = [&](TextureSlot& slot, bool srgb) { return addTexel(scene, slot, random, srgb); };
  if (random.chance()) c.texels.base = addTexel(scene, m.baseColorTexture, random, true, random.number(0.3, 1.0));
  if (random.chance()) c.texels.metallicRoughness = texel(m.metallicRoughnessTexture, m.specularGlossiness);
  // The reference's coat has no other normal than what is below.
  if (random.chance() && m.clearcoat == 0.0F) c.texels.normal = texel(m.normalTexture, false);
  if (random.chance()) c.texels.emissive = texel(m.emissiveTexture, true);
  if (random.chance()) c.texels.transmission = texel(m.transmissionTexture, false).r;
  if (random.chance(0.3)) c.texels.specular = texel(m.specularTexture, false).a;
  if (random.chance(0.3)) c.texels.specularColor = texel(m.specularColorTexture, true);
  if (random.chance()) c.texels.clearcoat = texel(m.clearcoatTexture, false).r;
  if (random.chance()) c.texels.clearcoatRoughness = texel(m.clearcoatRoughnessTexture, false).g;
  if (random.chance()) c.texels.sheenColor = texel(m.sheenColorTexture, true);
  if (random.chance()) c.texels.sheenRoughness = texel(m.sheenRoughnessTexture, false).a;
  if (random.chance()) c.texels.anisotropy = texel(m.anisotropyTexture, false);
  if (random.chance()) c.texels.iridescence = texel(m.iridescenceTexture, false).r;
  if (random.chance()) c.texels.iridescenceThickness = texel(m.iridescenceThicknessTexture, false).g;
  if (random.chance()) c.texels.thickness = texel(m.thicknessTexture, false).g;
}

// Triangles around the middle of the block, at different depths, each with vertices of its own.
void addMesh(Case& c, Random& random, std::size_t triangles, const glm::mat4& transform, bool flat, bool colors) {
  Mesh mesh;
  const glm::dmat4 toMesh = glm::inverse(glm::dmat4(transform));
  for (std::size_t t = 0; t < triangles; ++t) {
    const double turn = random.number(0.0, 6.28);
    const glm::dvec3 way = rayAt(c.view, c.x + 2.0, c.y + 2.0).second;
    const double depth = random.number(2.0, 6.0);
    glm::dvec3 facing = random.direction();
    if (glm::dot(facing, way) > 0.0) facing = -facing;
    for (int i = 0; i < 3; ++i) {
      const double angle = turn + i * 2.0 * 3.14159265 / 3.0 + random.number(-0.3, 0.3);
      const auto [from, along] = rayAt(c.view, c.x + 2.0 + 12.0 * std::cos(angle), c.y + 2.0 + 12.0 * std::sin(angle));
      Vertex vertex;
      vertex.position = glm::vec3(toMesh * glm::dvec4(from + along * (depth + random.number(-0.2, 0.2)), 1.0));
      const glm::dvec3 normal = glm::normalize(facing + 0.3 * random.direction());
      vertex.normal = glm::normalize(glm::transpose(glm::dmat3(glm::dmat4(transform))) * normal);
      vertex.tangent = glm::vec4(glm::vec3(random.direction()), random.chance() ? 1.0F : -1.0F);
      if (i > 0) vertex.tangent.w = mesh.vertex(mesh.vertexCount() - 1).tangent.w; // along a triangle it is the same
      vertex.texCoord0 = {random.number(), random.number()};
      vertex.texCoord1 = {random.number(), random.number()};
      if (colors) vertex.color = glm::vec4(glm::vec3(random.color()), static_cast<float>(random.number(0.2, 1.0)));
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertexCount()));
      mesh.add(vertex);
    }
  }
  if (flat) mesh.normals.clear();
  c.scene.meshes = {mesh};
  c.scene.draws = {{0, 0, transform}};
}

enum class Kind { Plain, Textured, Everything, Unlit };

Case makeCase(Random& random, Kind kind) {
  Case c;
  const glm::dvec3 eye = random.direction() * 3.0;
  c.view.cameraToWorld = glm::mat4(glm::inverse(glm::lookAt(eye, glm::dvec3(0.0), glm::dvec3(0.1, 0.9, 0.2))));
  c.view.verticalFov = static_cast<float>(random.number(0.4, 1.5));
  c.view.orthographic = random.chance(0.2);
  c.view.halfHeight = 2.0F;
  c.view.farPlane = c.view.orthographic ? 20.0F : 0.0F;
  c.x = static_cast<std::uint32_t>(random.below(kWidth / 4)) * 4;
  c.y = static_cast<std::uint32_t>(random.below(kHeight / 4)) * 4;
  Material m;
  m.baseColor = glm::vec4(glm::vec3(random.color()), static_cast<float>(random.number(0.2, 1.0)));
  m.alphaMode = random.chance() ? AlphaMode::Blend : AlphaMode::Opaque;
  m.metallic = random.chance() ? 0.0F : static_cast<float>(random.number());
  m.roughness = static_cast<float>(random.number(-0.1, 1.1));
  if (random.chance()) m.emissive = random.color(0.3);
  m.unlit = kind == Kind::Unlit;
  if (kind == Kind::Everything) addExtensions(m, random);
  if (kind != Kind::Plain) addTextures(c, m, random);
  if (kind == Kind::Everything && random.chance()) addLights(c.scene, random);
  glm::mat4 transform = glm::rotate(glm::mat4(1.0F), static_cast<float>(random.number(0.0, 6.0)),
                                    glm::vec3(random.direction()));
  transform = glm::scale(transform, glm::vec3(random.color(2.0) + 0.3) * (random.chance() ? 1.0F : -1.0F));
  transform[3] = glm::vec4(glm::vec3(random.color()), 1.0F);
  const bool colors = kind != Kind::Plain && random.chance();
  addMesh(c, random, 1 + random.below(random.chance() ? 3 : 16), transform, random.chance(0.2), colors);
  c.scene.materials = {m};
  if (random.chance(0.3)) c.opacity = static_cast<float>(random.number(0.2, 1.0));
  return c;
}

// Where the plane of a triangle is met: weights of its corners.
glm::dvec3 weightsAt(const Case& c, const std::array<glm::dvec3, 3>& corner, double x, double y) {
  const auto [from, along] = rayAt(c.view, x, y);
  const glm::dvec3 a = corner[1] - corner[0];
  const glm::dvec3 b = corner[2] - corner[0];
  const glm::dvec3 weights = glm::inverse(glm::dmat3(a, b, -along)) * (from - corner[0]);
  return {1.0 - weights.x - weights.y, weights.x, weights.y};
}

std::array<glm::dvec3, 3> worldCorners(const Case& c, std::size_t triangle) {
  std::array<glm::dvec3, 3> corner;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec4 local(glm::dvec3(c.scene.meshes[0].positions[3 * triangle + i]), 1.0);
    corner[i] = glm::dvec3(glm::dmat4(c.scene.draws[0].transform) * local);
  }
  return corner;
}

// Fragments of random triangles, seen at the pixels of the block.
VitrailCpuFragments makeFragments(const Case& c, Random& random) {
  VitrailCpuFragments f{};
  const std::size_t count = c.scene.meshes[0].indices.size() / 3;
  f.mask = random.chance() ? 0xffffU : 1U + static_cast<std::uint32_t>(random.below(0xffff));
  f.front = static_cast<std::uint32_t>(random.below(0x10000));
  f.x = c.x;
  f.y = c.y;
  for (std::size_t i = 0; i < kLanes; ++i) {
    f.triangle[i] = static_cast<std::uint32_t>(random.below(count));
    const std::array<glm::dvec3, 3> corner = worldCorners(c, f.triangle[i]);
    const double x = c.x + static_cast<double>(i % 4) + 0.5;
    const double y = c.y + static_cast<double>(i / 4) + 0.5;
    const glm::dvec3 weights = weightsAt(c, corner, x, y);
    const glm::dvec3 right = weightsAt(c, corner, x + 1.0, y) - weights;
    const glm::dvec3 down = weightsAt(c, corner, x, y + 1.0) - weights;
    f.second[i] = static_cast<float>(weights.y);
    f.third[i] = static_cast<float>(weights.z);
    f.secondDx[i] = static_cast<float>(right.y);
    f.secondDy[i] = static_cast<float>(down.y);
    f.thirdDx[i] = static_cast<float>(right.z);
    f.thirdDy[i] = static_cast<float>(down.z);
  }
  return f;
}

struct Expected {
  glm::dvec4 color{0.0};
  glm::dvec3 filter{1.0};
  bool faces = true; // the normal is on the eye's side of the surface
};

// The normal map's normal, on the side that is seen.
glm::dvec3 mapped(const glm::dvec3& seen, double side, const glm::dvec4& tangent, const glm::dvec3& texel) {
  const glm::dvec3 n = side * seen;
  const glm::dvec3 t = glm::normalize(glm::dvec3(tangent) - n * glm::dot(n, glm::dvec3(tangent)));
  const glm::dvec3 b = glm::cross(n, t) * tangent.w;
  const glm::dvec3 map = texel * 2.0 - 1.0;
  return side * glm::normalize(t * map.x + b * map.y + n * map.z);
}

// Fills in what the material and its texels are.
void setMaterial(reference::Surface& s, const Material& m, const Texels& t) {
  s.emissive = glm::dvec3(m.emissive) * t.emissive;
  s.metallic = double{m.metallic} * t.metallicRoughness.b;
  s.roughness = double{m.roughness} * t.metallicRoughness.g;
  s.ior = m.ior;
  s.specular = double{m.specular} * t.specular;
  s.specularColor = glm::dvec3(m.specularColor) * t.specularColor;
  s.specularGlossiness = m.specularGlossiness;
  if (m.specularGlossiness) {
    s.roughness = 1.0 - (1.0 - double{m.roughness}) * t.metallicRoughness.a;
    s.specularColor = glm::dvec3(m.specularColor) * glm::dvec3(t.metallicRoughness);
    s.specular = 1.0;
    s.ior = 1.5;
  }
  s.clearcoat = double{m.clearcoat} * t.clearcoat;
  s.clearcoatRoughness = double{m.clearcoatRoughness} * t.clearcoatRoughness;
  s.sheenColor = glm::dvec3(m.sheenColor) * t.sheenColor;
  s.sheenRoughness = double{m.sheenRoughness} * t.sheenRoughness;
  const glm::dvec2 turned = glm::dvec2(t.anisotropy) * 2.0 - 1.0;
  s.anisotropy = double{m.anisotropy} * t.anisotropy.z;
  s.anisotropyRotation = double{m.anisotropyRotation} + std::atan2(turned.y, turned.x);
  s.iridescence = double{m.iridescence} * t.iridescence;
  s.iridescenceIor = m.iridescenceIor;
  s.filmThickness = glm::mix(double{m.iridescenceThickness.x}, double{m.iridescenceThickness.y}, t.iridescenceThickness);
  s.diffuseTransmission = m.diffuseTransmission;
  s.diffuseTransmissionColor = m.diffuseTransmissionColor;
}

Expected expectedOf(const Case& c, const VitrailCpuFragments& f, std::size_t lane) {
  const Material& m = c.scene.materials[0];
  const Mesh& mesh = c.scene.meshes[0];
  const glm::dmat3 transform{glm::dmat4(c.scene.draws[0].transform)};
  const std::array<glm::dvec3, 3> corner = worldCorners(c, f.triangle[lane]);
  const double x = c.x + static_cast<double>(lane % 4) + 0.5;
  const double y = c.y + static_cast<double>(lane / 4) + 0.5;
  const glm::dvec3 weights = weightsAt(c, corner, x, y);
  const bool isMirrored = glm::determinant(transform) < 0.0;
  const bool front = ((f.front >> lane & 1U) != 0) != isMirrored;
  const double side = front ? 1.0 : -1.0;

  glm::dvec3 normal(0.0);
  glm::dvec4 color(0.0);
  glm::dvec3 tangent(0.0);
  double sign = 1.0;
  glm::dvec3 point(0.0);
  for (int i = 0; i < 3; ++i) {
    const Vertex vertex = mesh.vertex(3 * f.triangle[lane] + static_cast<std::size_t>(i));
    normal += weights[i] * glm::dvec3(vertex.normal);
    color += weights[i] * glm::dvec4(vertex.color);
    tangent += weights[i] * glm::dvec3(vertex.tangent);
    sign = vertex.tangent.w;
    point += weights[i] * corner[static_cast<std::size_t>(i)];
  }
  reference::Surface s;
  setMaterial(s, m, c.texels);
  const glm::dmat3 camera{glm::dmat4(c.view.cameraToWorld)};
  s.toEye = c.view.orthographic ? camera[2] : glm::normalize(eyeOf(c.view) - point);
  s.toLight = glm::normalize(camera * glm::dvec3(-0.4, 0.7, 0.6));
  s.normal = side * glm::normalize(glm::transpose(glm::inverse(transform)) * normal);
  s.tangent = glm::dvec4(transform * tangent, isMirrored ? -sign : sign);
  if (mesh.normals.empty()) {
    s.normal = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
    if (glm::dot(s.normal, s.toEye) < 0.0) s.normal = -s.normal;
  } else if (m.normalTexture.image >= 0) {
    s.normal = mapped(s.normal, side, s.tangent, c.texels.normal);
  }
  s.ownLight = c.scene.lights.empty();
  if (!s.ownLight) {
    const double exposure = lightExposure(c.scene);
    for (const Light& light : c.scene.lights) s.lights.push_back(reference::shineOf(light, exposure, point));
  }
  const glm::dvec4 base = glm::dvec4(m.baseColor) * color * c.texels.base;
  s.base = base;
  s.transmission = std::clamp(double{m.transmission} * c.texels.transmission, 0.0, 1.0);

  const double k = double{c.opacity.value_or(1.0F)} * (m.alphaMode == AlphaMode::Blend ? base.a : 1.0);
  if (m.unlit) return {glm::dvec4(s.base, k)};
  const bool faces = glm::dot(s.normal, s.toEye) > 0.0;
  const glm::dvec3 shaded = reference::shade(s);
  if (m.transmission == 0.0F) return {glm::dvec4(shaded, k), glm::dvec3(1.0), faces};
  const double metal = m.specularGlossiness ? 0.0 : std::clamp(s.metallic, 0.0, 1.0);
  const double q = s.transmission * (1.0 - metal);
  glm::dvec3 tint = s.base;
  if (m.thickness > 0.0F && front) {
    const double longer = std::cbrt(std::abs(glm::determinant(transform)));
    for (int i = 0; i < 3; ++i) {
      const double absorbed = -std::log(double{m.attenuationColor[i]}) / double{m.attenuationDistance};
      tint[i] *= std::exp(-absorbed * double{m.thickness} * c.texels.thickness * longer);
    }
  }
  // The two fragments multiply what is behind by mix(1, q * tint, k); the reflection leaves 1 - k (1 - q) of it.
  const double leaves = 1.0 - k * (1.0 - q);
  return {glm::dvec4(k * shaded, k * (1.0 - q)), glm::mix(glm::dvec3(1.0), q * tint, k) / leaves, faces};
}

// How far apart two linear values are in the picture, in steps of 1/255.
double stepsBetween(double a, double b) {
  const auto code = [](double v) { return 255.0 * reference::encodeSrgb(std::clamp(v, 0.0, 1.0)); };
  return std::abs(code(a) - code(b));
}

bool anyExtension(const Material& m) {
  return m.clearcoat > 0.0F || m.anisotropy > 0.0F || m.iridescence > 0.0F || m.diffuseTransmission > 0.0F;
}

// Checks the fragments of a case, and returns the largest difference in steps of 1/255.
double check(const Case& c, const VitrailCpuFragments& fragments, VitrailCpuInstructions instructions) {
  CpuScene scene(c.scene, c.opacity, DrawOrder::Forward, instructions);
  const auto draws = scene.draws(c.view, kWidth, kHeight);
  EXPECT_EQ(draws.size(), 1U);
  const VitrailCpuDraw& draw = draws[0];
  VitrailCpuFragments f = fragments;
  if (draw.shade != nullptr) {
    draw.shade(draw.shadeUser, &f);
  } else {
    for (std::size_t i = 0; i < 4; ++i) std::fill_n(f.color[i], kLanes, draw.color[i]);
  }
  const bool timesAlpha = draw.surface == VITRAIL_CPU_TRANSPARENT && draw.blend != VITRAIL_BLEND_PREMULTIPLIED;
  double most = 0.0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if ((f.mask >> lane & 1U) == 0) continue;
    const Expected expected = expectedOf(c, fragments, lane);
    // docs/shading.md leaves open what extensions make of a normal that points away from the eye.
    if (!expected.faces && anyExtension(c.scene.materials[0])) continue;
    for (int i = 0; i < 4; ++i) {
      most = std::max(most, stepsBetween(double{f.color[i][lane]}, expected.color[i]));
      const float light = f.color[i][lane] * (timesAlpha ? f.color[3][lane] : 1.0F);
      if (draw.shade != nullptr && i < 3) {
        EXPECT_LE(light, draw.brightest);
      }
      if ((draw.shadeFlags & VITRAIL_CPU_SHADE_FILTER) == 0 || i == 3) continue;
      most = std::max(most, stepsBetween(double{f.filter[i][lane]}, expected.filter[i]));
    }
  }
  return most;
}

class CpuShading : public testing::TestWithParam<Kind> {};

TEST_P(CpuShading, IsThatOfTheReference) {
  Random random(static_cast<std::uint64_t>(GetParam()) + 1);
  double most = 0.0;
  for (int i = 0; i < 1500; ++i) {
    const Case c = makeCase(random, GetParam());
    const VitrailCpuFragments fragments = makeFragments(c, random);
    for (const VitrailCpuInstructions instructions : kInstructions) {
      const double steps = check(c, fragments, instructions);
      most = std::max(most, steps);
      ASSERT_LT(steps, 0.25) << "case " << i << ", instructions " << instructions;
    }
  }
  RecordProperty("most", fmt::format("{:.4f}", most));
  if (std::getenv("VITRAIL_PRINT") != nullptr) fmt::print("at most {:.4f} steps\n", most);
}

INSTANTIATE_TEST_SUITE_P(Kinds, CpuShading,
                         testing::Values(Kind::Plain, Kind::Textured, Kind::Everything, Kind::Unlit));

} // namespace
} // namespace vitrail::tool::test
