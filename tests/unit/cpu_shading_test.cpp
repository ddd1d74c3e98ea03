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
#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "../../tool/cpu/cpu_scene.h"
#include "../../tool/cpu/cpu_texture.h"
#include "../../tool/scene/exposure.h"
#include "../reference/shading.h"

namespace vitrail::tool::test {
namespace {

constexpr std::uint32_t kPictureWidth = 320;
constexpr std::uint32_t kPictureHeight = 200;
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
struct SlotTexels {
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
  SlotTexels texels;
  std::uint32_t x = 0; // of the block
  std::uint32_t y = 0;
  std::optional<float> opacity;
};

glm::dvec3 eyeOf(const View& view) { return glm::dvec3(view.cameraToWorld[3]); }

// The way from the eye through a point of the picture, and where it begins.
std::pair<glm::dvec3, glm::dvec3> rayAt(const View& view, double x, double y) {
  const double aspect = double{kPictureWidth} / kPictureHeight;
  const glm::dmat4 camera(view.cameraToWorld);
  const double across = (2.0 * x / kPictureWidth - 1.0) * aspect;
  const double up = 1.0 - 2.0 * y / kPictureHeight;
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
    // Where the tool's own light is mirrored, highlights are as sharp as they can be.
    const glm::dvec3 light = glm::dmat3(glm::dmat4(c.view.cameraToWorld)) * glm::normalize(glm::dvec3(-0.4, 0.7, 0.6));
    const bool highlight = random.chance(0.3);
    if (highlight) facing = glm::normalize(light - glm::normalize(way));
    for (int i = 0; i < 3; ++i) {
      const double angle = turn + i * 2.0 * 3.14159265 / 3.0 + random.number(-0.3, 0.3);
      const auto [from, along] = rayAt(c.view, c.x + 2.0 + 12.0 * std::cos(angle), c.y + 2.0 + 12.0 * std::sin(angle));
      Vertex vertex;
      vertex.position = glm::vec3(toMesh * glm::dvec4(from + along * (depth + random.number(-0.2, 0.2)), 1.0));
      const glm::dvec3 normal = glm::normalize(facing + (highlight ? 0.05 : 0.3) * random.direction());
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
  c.x = static_cast<std::uint32_t>(random.below(kPictureWidth / 4)) * 4;
  c.y = static_cast<std::uint32_t>(random.below(kPictureHeight / 4)) * 4;
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
  glm::mat4 transform = glm::scale(glm::mat4(1.0F), glm::vec3(0.7F));
  if (random.chance(0.7)) {
    transform =
        glm::rotate(glm::mat4(1.0F), static_cast<float>(random.number(0.0, 6.0)), glm::vec3(random.direction()));
    transform = glm::scale(transform, glm::vec3(random.color(2.0) + 0.3) * (random.chance() ? 1.0F : -1.0F));
  }
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

struct ExpectedFragment {
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
void setMaterial(reference::Surface& s, const Material& m, const SlotTexels& t) {
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
  s.filmThickness =
      glm::mix(double{m.iridescenceThickness.x}, double{m.iridescenceThickness.y}, t.iridescenceThickness);
  s.diffuseTransmission = m.diffuseTransmission;
  s.diffuseTransmissionColor = m.diffuseTransmissionColor;
}

ExpectedFragment expectedOf(const Case& c, const VitrailCpuFragments& f, std::size_t lane) {
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
double largestDifference(const Case& c, const VitrailCpuFragments& fragments, VitrailCpuInstructions instructions) {
  CpuScene scene(c.scene, c.opacity, DrawOrder::Forward, instructions);
  const auto draws = scene.draws(c.view, kPictureWidth, kPictureHeight);
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
    const ExpectedFragment expected = expectedOf(c, fragments, lane);
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
      const double steps = largestDifference(c, fragments, instructions);
      most = std::max(most, steps);
      ASSERT_LT(steps, 0.25) << "case " << i << ", instructions " << instructions;
    }
  }
  RecordProperty("most", fmt::format("{:.4f}", most));
  if (std::getenv("VITRAIL_PRINT") != nullptr) fmt::print("at most {:.4f} steps\n", most);
}

INSTANTIATE_TEST_SUITE_P(Kinds, CpuShading,
                         testing::Values(Kind::Plain, Kind::Textured, Kind::Everything, Kind::Unlit));

// ---- Textures

Image randomImage(Random& random, bool translucent) {
  Image image;
  image.width = 1 + static_cast<std::uint32_t>(random.below(9));
  image.height = 1 + static_cast<std::uint32_t>(random.below(9));
  for (std::size_t i = 0; i < std::size_t{image.width} * image.height; ++i) {
    for (int k = 0; k < 3; ++k) image.rgba.push_back(static_cast<std::uint8_t>(random.below(256)));
    image.rgba.push_back(translucent ? static_cast<std::uint8_t>(random.below(256)) : 255);
  }
  return image;
}

glm::dvec4 texelAt(const CpuTexture& texture, std::size_t level, std::int64_t x, std::int64_t y) {
  const auto i = static_cast<std::size_t>(texture.offset.at(level) + y * texture.width.at(level) + x);
  if (texture.kind == Texels::Premultiplied) {
    return {glm::unpackHalf2x16(texture.texels[2 * i]), glm::unpackHalf2x16(texture.texels[2 * i + 1])};
  }
  glm::dvec4 value;
  for (int k = 0; k < 4; ++k) {
    const double code = (texture.texels[i] >> (8 * k) & 255U) / 255.0;
    value[k] = texture.kind == Texels::Srgb && k < 3 ? reference::decodeSrgb(code) : code;
  }
  return value;
}

std::int64_t wrapped(std::int64_t i, std::int64_t size, Wrap wrap) {
  const auto modulo = [](std::int64_t a, std::int64_t b) { return (a % b + b) % b; };
  if (wrap == Wrap::Repeat) return modulo(i, size);
  if (wrap == Wrap::ClampToEdge) return std::clamp<std::int64_t>(i, 0, size - 1);
  const std::int64_t folded = modulo(i, 2 * size);
  return folded < size ? folded : 2 * size - 1 - folded;
}

// A sample as the Vulkan specification has it, and whether a rounding error could give another one.
struct Sample {
  glm::dvec4 value{0.0};
  bool unsure = false;
};

void addLevel(Sample& sample, const CpuTexture& texture, const Sampler& sampler, const glm::dvec2& uv,
              std::size_t level, bool linear, double weight) {
  const std::int64_t width = texture.width.at(level);
  const std::int64_t height = texture.height.at(level);
  const double shift = linear ? 0.5 : 0.0;
  const double x = uv.x * static_cast<double>(width) - shift;
  const double y = uv.y * static_cast<double>(height) - shift;
  const auto left = static_cast<std::int64_t>(std::floor(x));
  const auto top = static_cast<std::int64_t>(std::floor(y));
  const auto at = [&](std::int64_t column, std::int64_t line) {
    return texelAt(texture, level, wrapped(column, width, sampler.wrapU), wrapped(line, height, sampler.wrapV));
  };
  const auto nearEdge = [](double place) { return std::abs(place - std::round(place)) < 1e-3; };
  if (!linear) {
    sample.value += weight * at(left, top);
    sample.unsure = sample.unsure || nearEdge(x) || nearEdge(y);
    return;
  }
  const double a = x - static_cast<double>(left);
  const double b = y - static_cast<double>(top);
  sample.value += weight * glm::mix(glm::mix(at(left, top), at(left + 1, top), a),
                                    glm::mix(at(left, top + 1), at(left + 1, top + 1), a), b);
}

Sample sampleOf(const CpuTexture& texture, const Sampler& sampler, const glm::dvec2& uv, const glm::dvec2& dx,
                const glm::dvec2& dy) {
  const glm::dvec2 size(texture.width[0], texture.height[0]);
  const double detail = std::log2(std::max(glm::length(dx * size), glm::length(dy * size)));
  const double level = std::clamp(detail, 0.0, sampler.mipmaps ? texture.levels - 1.0 : 0.25);
  const bool linear = detail > 0.0 ? sampler.minLinear : sampler.magLinear;
  Sample sample;
  sample.unsure = std::abs(detail) < 1e-3 && sampler.minLinear != sampler.magLinear;
  if (!sampler.mipmaps || !sampler.mipLinear) {
    const double nearest = std::ceil(level + 0.5) - 1.0;
    sample.unsure = sample.unsure || std::abs(level + 0.5 - std::round(level + 0.5)) < 1e-3;
    addLevel(sample, texture, sampler, uv, static_cast<std::size_t>(nearest), linear, 1.0);
    return sample;
  }
  const double fine = std::floor(level);
  const double share = level - fine;
  addLevel(sample, texture, sampler, uv, static_cast<std::size_t>(fine), linear, 1.0 - share);
  if (share > 0.0) addLevel(sample, texture, sampler, uv, static_cast<std::size_t>(fine) + 1, linear, share);
  return sample;
}

// A triangle of an unlit material that shows a texture.
Scene texturedScene(Random& random, bool translucent) {
  Scene scene;
  scene.images = {randomImage(random, translucent)};
  Material material;
  material.unlit = true;
  if (translucent) material.alphaMode = AlphaMode::Blend;
  TextureSlot& slot = material.baseColorTexture;
  slot.image = 0;
  slot.texCoord = static_cast<std::uint32_t>(random.below(2));
  slot.sampler = {static_cast<Wrap>(random.below(3)),
                  static_cast<Wrap>(random.below(3)),
                  random.chance(),
                  random.chance(),
                  random.chance(),
                  random.chance(0.8)};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 2; ++k) slot.transform[i][k] = static_cast<float>(random.number(-2.0, 2.0));
  }
  scene.materials = {material};
  Mesh mesh;
  for (int i = 0; i < 3; ++i) {
    Vertex vertex;
    vertex.position = glm::vec3(random.direction());
    (slot.texCoord == 0 ? vertex.texCoord0 : vertex.texCoord1) = {random.number(-3.0, 3.0), random.number(-3.0, 3.0)};
    mesh.add(vertex);
  }
  mesh.indices = {0, 1, 2};
  scene.meshes = {mesh};
  scene.draws = {{0, 0, glm::mat4(1.0F)}};
  return scene;
}

TEST(CpuTextures, AreSampledAsTheSpecificationSays) {
  Random random(7);
  std::size_t compared = 0;
  for (int i = 0; i < 1500; ++i) {
    const bool translucent = random.chance(0.3);
    const Scene scene = texturedScene(random, translucent);
    const TextureSlot& slot = scene.materials[0].baseColorTexture;
    const bool anyAlpha = isTranslucent(scene.images[0]);
    const CpuTexture texture = makeCpuTexture(scene.images[0], anyAlpha ? Texels::Premultiplied : Texels::Srgb);
    VitrailCpuFragments fragments{};
    fragments.mask = 0xffff;
    const double scale = std::exp2(random.number(-6.0, 1.0));
    for (std::size_t k = 0; k < kLanes; ++k) {
      fragments.second[k] = static_cast<float>(random.number(-0.5, 1.0));
      fragments.third[k] = static_cast<float>(random.number(-0.5, 1.0));
      for (float* derivative : {fragments.secondDx, fragments.secondDy, fragments.thirdDx, fragments.thirdDy}) {
        derivative[k] = static_cast<float>(scale * random.number(-1.0, 1.0));
      }
    }
    const auto place = [&](double first, double second, double third, double one) {
      const Mesh& mesh = scene.meshes[0];
      const auto at = [&](std::size_t v) {
        return glm::dvec2(slot.texCoord == 0 ? mesh.vertex(v).texCoord0 : mesh.vertex(v).texCoord1);
      };
      const glm::dvec2 uv = first * at(0) + second * at(1) + third * at(2);
      return glm::dvec2(glm::dmat3(slot.transform) * glm::dvec3(uv, one));
    };
    for (const VitrailCpuInstructions instructions : kInstructions) {
      CpuScene cpu(scene, {}, DrawOrder::Forward, instructions);
      const VitrailCpuDraw draw = cpu.draws(View{}, kPictureWidth, kPictureHeight)[0];
      ASSERT_NE(draw.shade, nullptr);
      ASSERT_EQ(draw.shadeFlags, static_cast<std::uint32_t>(VITRAIL_CPU_SHADE_DERIVATIVES));
      VitrailCpuFragments f = fragments;
      draw.shade(draw.shadeUser, &f);
      for (std::size_t k = 0; k < kLanes; ++k) {
        const auto change = [&](const float* second, const float* third) {
          return place(-double{second[k]} - double{third[k]}, second[k], third[k], 0.0);
        };
        const glm::dvec2 uv = place(1.0 - double{f.second[k]} - double{f.third[k]}, f.second[k], f.third[k], 1.0);
        Sample sample =
            sampleOf(texture, slot.sampler, uv, change(f.secondDx, f.thirdDx), change(f.secondDy, f.thirdDy));
        if (sample.unsure) continue;
        ++compared;
        if (anyAlpha && sample.value.a > 0.0)
          sample.value = glm::dvec4(glm::dvec3(sample.value) / sample.value.a, sample.value.a);
        for (int channel = 0; channel < 3; ++channel) {
          ASSERT_LT(stepsBetween(double{f.color[channel][k]}, sample.value[channel]), 0.1)
              << "case " << i << ", lane " << k << ", channel " << channel << ", instructions " << instructions;
        }
        ASSERT_NEAR(double{f.color[3][k]}, translucent ? sample.value.a : 1.0, 1e-4);
      }
    }
  }
  EXPECT_GT(compared, 50000U);
}

TEST(CpuTextures, KnowWhereTheyAreEmpty) {
  Random random(8);
  constexpr std::int32_t kCells = CpuTexture::kCells;
  for (const auto& [width, height] : {std::pair(256U, 256U), std::pair(100U, 37U), std::pair(512U, 9U)}) {
    Image image{width, height, std::vector<std::uint8_t>(std::size_t{width} * height * 4)};
    // A patch that goes round the image's corner.
    for (std::uint32_t y = 0; y < height; ++y) {
      for (std::uint32_t x = 0; x < width; ++x) {
        const bool isThere = (x + width / 8) % width < width / 3 && (y + height / 8) % height < height / 2;
        for (std::size_t c = 0; c < 4; ++c) image.rgba[(std::size_t{y} * width + x) * 4 + c] = isThere ? 200 : 0;
      }
    }
    const CpuTexture texture = makeCpuTexture(image, Texels::Premultiplied);
    ASSERT_EQ(texture.emptyCells.size(), std::size_t{kCells} * kCells);
    std::size_t empty = 0;
    for (int i = 0; i < 20000; ++i) {
      const glm::dvec2 uv(random.number(0.0, 1.0), random.number(0.0, 1.0));
      const auto cell = static_cast<std::size_t>(std::floor(uv.y * kCells) * kCells + std::floor(uv.x * kCells));
      if (texture.emptyCells[cell] == 0) continue;
      ++empty;
      for (std::size_t level = 0; level <= static_cast<std::size_t>(CpuTexture::kEmptyLevels); ++level) {
        Sampler sampler;
        sampler.wrapU = static_cast<Wrap>(random.below(3));
        sampler.wrapV = static_cast<Wrap>(random.below(3));
        Sample sample;
        addLevel(sample, texture, sampler, uv, level, true, 1.0);
        ASSERT_EQ(sample.value, glm::dvec4(0.0)) << width << " x " << height << ", level " << level;
      }
    }
    EXPECT_GT(empty, 500U) << width << " x " << height;
  }
  Image full{64, 64, std::vector<std::uint8_t>(std::size_t{64} * 64 * 4, 128)};
  EXPECT_TRUE(makeCpuTexture(full, Texels::Premultiplied).emptyCells.empty());
}

TEST(CpuTextures, HaveMipmapsThatAreAveragedInLinearLight) {
  Image image{2, 2, {0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 255}};
  const CpuTexture srgb = makeCpuTexture(image, Texels::Srgb);
  ASSERT_EQ(srgb.levels, 2);
  EXPECT_EQ(srgb.texels[4], 0xffbcbcbcU); // 188: half the light
  EXPECT_EQ(makeCpuTexture(image, Texels::Linear).texels[4], 0xff808080U);

  // Three texels become one: the middle one, where the blit samples.
  Image three{3, 1, {10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120}};
  const CpuTexture linear = makeCpuTexture(three, Texels::Linear);
  ASSERT_EQ(linear.levels, 2);
  EXPECT_EQ(linear.texels[3], 50U | 60U << 8U | 70U << 16U | 80U << 24U);
}

TEST(CpuTextures, KeepEverySrgbCode) {
  Image image{256, 1, {}};
  for (std::uint32_t i = 0; i < 256; ++i) image.rgba.insert(image.rgba.end(), {std::uint8_t(i), 0, 0, 255});
  // Each texel twice: the first level holds what the base one does.
  Image twice{512, 1, {}};
  for (std::uint32_t i = 0; i < 512; ++i) twice.rgba.insert(twice.rgba.end(), {std::uint8_t(i / 2), 0, 0, 255});
  const CpuTexture texture = makeCpuTexture(twice, Texels::Srgb);
  for (std::size_t i = 0; i < 256; ++i) EXPECT_EQ(texture.texels[512 + i] & 255U, i);
}

// ---- Draws

Scene triangleScene(const Material& material, const glm::mat4& transform = glm::mat4(1.0F)) {
  Scene scene;
  Mesh mesh;
  for (const glm::vec3& position : {glm::vec3(0.0F), glm::vec3(1.0F, 0.0F, 0.0F), glm::vec3(0.0F, 1.0F, 0.0F)}) {
    Vertex vertex;
    vertex.position = position;
    mesh.add(vertex);
  }
  mesh.indices = {0, 1, 2};
  scene.meshes = {mesh};
  scene.materials = {material};
  scene.draws = {{0, 0, transform}};
  return scene;
}

TEST(CpuScene, HidesTheBacksOfOpaqueSurfacesAlsoInAMirror) {
  const glm::mat4 mirror = glm::scale(glm::mat4(1.0F), glm::vec3(-1.0F, 1.0F, 1.0F));
  Material material;
  const auto cull = [](const Scene& scene, std::optional<float> opacity) {
    CpuScene cpu(scene, opacity, DrawOrder::Forward);
    return cpu.draws(View{}, 8, 8)[0].cull;
  };
  EXPECT_EQ(cull(triangleScene(material), {}), VITRAIL_CPU_CULL_BACK);
  EXPECT_EQ(cull(triangleScene(material, mirror), {}), VITRAIL_CPU_CULL_FRONT);
  EXPECT_EQ(cull(triangleScene(material), 0.5F), VITRAIL_CPU_CULL_NONE);
  material.doubleSided = true;
  EXPECT_EQ(cull(triangleScene(material), {}), VITRAIL_CPU_CULL_NONE);
}

TEST(CpuScene, GivesUnlitSurfacesOneColour) {
  Material material;
  material.unlit = true;
  material.baseColor = {0.1F, 0.2F, 0.3F, 0.4F};
  material.alphaMode = AlphaMode::Blend;
  CpuScene cpu(triangleScene(material), 0.5F, DrawOrder::Forward);
  const VitrailCpuDraw& draw = cpu.draws(View{}, 8, 8)[0];
  EXPECT_EQ(draw.shade, nullptr);
  EXPECT_EQ(draw.color[0], 0.1F);
  EXPECT_EQ(draw.color[3], 0.2F);
  EXPECT_TRUE(cpu.hasTransparent());

  material.alphaMode = AlphaMode::Mask; // nothing of it is left
  CpuScene masked(triangleScene(material), {}, DrawOrder::Forward);
  EXPECT_TRUE(masked.draws(View{}, 8, 8).empty());
  EXPECT_FALSE(masked.hasTransparent());
}

TEST(CpuScene, DiscardsWhatTheMaskCutsAway) {
  Material material;
  material.unlit = true;
  material.alphaMode = AlphaMode::Mask;
  Scene scene = triangleScene(material);
  scene.meshes[0].colors = {packColor(glm::vec4(1.0F, 1.0F, 1.0F, 0.0F)), packColor(glm::vec4(1.0F)),
                            packColor(glm::vec4(1.0F))};
  CpuScene cpu(scene, {}, DrawOrder::Forward);
  const VitrailCpuDraw& draw = cpu.draws(View{}, 8, 8)[0];
  EXPECT_EQ(draw.shadeFlags, static_cast<std::uint32_t>(VITRAIL_CPU_SHADE_DISCARD));
  VitrailCpuFragments f{};
  f.mask = 0xffff;
  for (std::size_t i = 0; i < kLanes; ++i) f.second[i] = static_cast<float>(i) / 16.0F; // alpha, of which 0.5 is left
  draw.shade(draw.shadeUser, &f);
  EXPECT_EQ(f.discarded, 0x00ffU);
}

TEST(CpuScene, OcclusionDimsAmbientLightAlone) {
  Scene scene = triangleScene(Material{});
  scene.materials[0].occlusionTexture.image = 0;
  scene.images = {{1, 1, {51, 0, 0, 255}}}; // 0.2
  scene.materials[0].occlusionStrength = 0.5F;
  const auto red = [](const Scene& s) {
    CpuScene cpu(s, {}, DrawOrder::Forward);
    View view;
    view.cameraToWorld[3] = glm::vec4(0.0F, 0.0F, 5.0F, 1.0F);
    const VitrailCpuDraw& draw = cpu.draws(view, 8, 8)[0];
    VitrailCpuFragments f{};
    f.mask = f.front = 1;
    f.x = f.y = 4;
    draw.shade(draw.shadeUser, &f);
    return f.color[0][0];
  };
  Light light;
  light.kind = Light::Kind::Directional;
  light.direction = {0.0F, 0.0F, 1.0F}; // on the back
  scene.lights = {light};
  Scene clear = scene;
  clear.materials[0].occlusionTexture.image = -1;
  EXPECT_NEAR(red(scene), 0.6F * red(clear), 1e-6F);
  EXPECT_GT(red(clear), 0.1F);
}

TEST(CpuScene, TakesMeshesOver) {
  Scene scene = triangleScene(Material{});
  const glm::vec3* positions = scene.meshes[0].positions.data();
  CpuScene cpu(std::move(scene), {}, DrawOrder::Forward);
  EXPECT_EQ(cpu.draws(View{}, 8, 8)[0].positions, &positions->x);
}

TEST(CpuScene, DrawsTransparentTrianglesInTheOrderThatIsAskedFor) {
  Material material;
  material.alphaMode = AlphaMode::Blend;
  Scene scene = triangleScene(material);
  scene.meshes[0].indices = {0, 1, 2, 2, 1, 0};
  CpuScene cpu(scene, {}, DrawOrder::Reversed);
  const VitrailCpuDraw& draw = cpu.draws(View{}, 8, 8)[0];
  EXPECT_EQ(std::vector<std::uint32_t>(draw.indices, draw.indices + 6), (std::vector<std::uint32_t>{2, 1, 0, 0, 1, 2}));
}

TEST(CpuScene, CutsByPlanesInTheWorld) {
  glm::mat4 transform = glm::rotate(glm::mat4(1.0F), 0.7F, glm::normalize(glm::vec3(1.0F, 2.0F, 3.0F)));
  transform[3] = glm::vec4(1.0F, 2.0F, 3.0F, 1.0F);
  Scene scene = triangleScene(Material{}, transform);
  scene.clipPlanes = {glm::dvec4(0.6, 0.8, 0.0, 1.5)};
  CpuScene cpu(scene, {}, DrawOrder::Forward);
  const VitrailCpuDraw& draw = cpu.draws(View{}, 8, 8)[0];
  ASSERT_EQ(draw.clipPlaneCount, 1U);
  const glm::vec4 local(0.3F, -0.2F, 0.9F, 1.0F);
  // Planes are for what the draw's model matrix makes of its positions.
  glm::vec4 placed(0.0F, 0.0F, 0.0F, 1.0F);
  for (int row = 0; row < 3; ++row) {
    const float* m = draw.model + std::ptrdiff_t{4} * row;
    placed[row] = m[0] * local.x + m[1] * local.y + m[2] * local.z + m[3];
  }
  const glm::dvec3 world(transform * local);
  const float* p = draw.clipPlanes;
  EXPECT_NEAR(p[0] * placed.x + p[1] * placed.y + p[2] * placed.z + p[3],
              glm::dot(world, glm::dvec3(0.6, 0.8, 0.0)) - 1.5, 1e-6);
}

TEST(CpuScene, MovesLinesByHalfASubpixel) {
  Scene scene = triangleScene(Material{});
  View view;
  const auto clip = [&](Primitive primitive) {
    scene.meshes[0].primitive = primitive;
    scene.meshes[0].indices = {0, 1};
    if (primitive == Primitive::Triangles) scene.meshes[0].indices = {0, 1, 2};
    CpuScene cpu(scene, {}, DrawOrder::Forward);
    const float* m = cpu.draws(view, 64, 32)[0].transform;
    const glm::vec4 place = glm::vec4(m[8], m[9], m[10], m[11]) * -2.0F + glm::vec4(m[12], m[13], m[14], m[15]);
    return glm::vec2(place) / place.w * glm::vec2(32.0F, 16.0F); // in pixels
  };
  const glm::vec2 moved = clip(Primitive::Lines) - clip(Primitive::Triangles);
  EXPECT_NEAR(moved.x, 1.0F / 256.0F, 1e-5F);
  EXPECT_NEAR(moved.y, 1.0F / 256.0F, 1e-5F);
}

TEST(CpuScene, WarnsOfVolumesThatAreNotFollowed) {
  Material material;
  material.transmission = 1.0F;
  material.thickness = 1.0F;
  material.attenuationDistance = 1.0F;
  material.attenuationColor = glm::vec3(0.5F);
  Scene scene = triangleScene(material);
  const std::vector<std::string> open = CpuScene(scene, {}, DrawOrder::Forward).warnings();
  ASSERT_EQ(open.size(), 1U);
  EXPECT_NE(open[0].find("is not closed"), std::string::npos) << open[0]; // no method follows it
  Mesh& mesh = scene.meshes[0];
  Vertex top;
  top.position = {0.0F, 0.0F, 1.0F};
  mesh.add(top);
  mesh.indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  const std::vector<std::string> closed = CpuScene(scene, {}, DrawOrder::Forward).warnings();
  ASSERT_EQ(closed.size(), 1U);
  EXPECT_NE(closed[0].find("--method linked-list"), std::string::npos) << closed[0];
}

TEST(CpuBackground, IsThatOfThePage) {
  View view;
  view.cameraToWorld =
      glm::mat4(glm::inverse(glm::lookAt(glm::dvec3(0.0), glm::dvec3(1.0, 0.3, 0.4), glm::dvec3(0, 1, 0))));
  Background sky;
  sky.kind = Background::Kind::Sky;
  constexpr std::uint32_t kRows = 50;
  std::vector<float> rgba(std::size_t{kPictureWidth} * kRows * 4);
  drawBackground(sky, view, kPictureWidth, kPictureHeight, 90, kRows, rgba.data());
  for (std::uint32_t i = 0; i < kPictureWidth * kRows; ++i) {
    const auto along = rayAt(view, i % kPictureWidth + 0.5, 90 + i / kPictureWidth + 0.5).second;
    const glm::dvec3 expected = reference::skyColor(glm::normalize(along));
    for (int k = 0; k < 3; ++k)
      ASSERT_NEAR(double{rgba[4 * std::size_t{i} + static_cast<std::size_t>(k)]}, expected[k], 2e-3);
    ASSERT_EQ(rgba[4 * std::size_t{i} + 3], 1.0F);
  }
  Background gray;
  gray.srgb = glm::vec3(188.0F / 255.0F);
  drawBackground(gray, view, kPictureWidth, kPictureHeight, 0, 1, rgba.data());
  EXPECT_NEAR(double{rgba[4]}, reference::decodeSrgb(188.0 / 255.0), 1e-6);
  gray.kind = Background::Kind::Transparent;
  drawBackground(gray, view, kPictureWidth, kPictureHeight, 0, 1, rgba.data());
  EXPECT_EQ(rgba[4], 0.0F);
  EXPECT_EQ(rgba[7], 0.0F);
}

} // namespace
} // namespace vitrail::tool::test
