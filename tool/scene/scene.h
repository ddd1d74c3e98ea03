// What a model is once it is in memory: everything the renderer, the reference and the tests know about a scene.
// Right-handed, Y up, metres, as in glTF. Colours are linear unless a name says sRGB.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace vitrail::tool {

struct Vertex {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0.0F, 0.0F, 1.0F};        // unit length
  glm::vec4 tangent{1.0F, 0.0F, 0.0F, 1.0F}; // xyz unit length, w = +1 or -1: bitangent = w * cross(normal, tangent)
  glm::vec2 texCoord0{0.0F};
  glm::vec2 texCoord1{0.0F};
  glm::vec4 color{1.0F}; // linear, straight alpha
};

// A triangle list. Every index is below vertices.size(), and indices.size() is a multiple of 3. Counter-clockwise
// triangles, seen from outside, agree with their vertex normals.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
};

// 8-bit RGBA, straight alpha, rows top to bottom without padding. Whether the colours are sRGB is the texture slot's
// business: base colour and emissive are, the others are not.
struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba; // width * height * 4
};

enum class Wrap { Repeat, MirroredRepeat, ClampToEdge };

struct Sampler {
  Wrap wrapU = Wrap::Repeat;
  Wrap wrapV = Wrap::Repeat;
  bool magLinear = true;
  bool minLinear = true;
  bool mipLinear = true;
  bool mipmaps = true; // false: only the base level is sampled

  bool operator==(const Sampler&) const = default;
};

// One texture slot of a material. The coordinates are transform * (u, v, 1), from KHR_texture_transform.
struct TextureSlot {
  std::int32_t image = -1; // index into Scene::images, -1 = none
  Sampler sampler;
  std::uint32_t texCoord = 0; // 0 or 1
  glm::mat3 transform{1.0F};
};

enum class AlphaMode { Opaque, Mask, Blend };

// What a blended surface does to the light behind it.
enum class BlendMode {
  Over,    // covers it, by alpha
  Additive // adds to it and hides nothing
};

// glTF's metallic-roughness material; docs/shading.md states how it is shaded.
struct Material {
  std::string name;
  AlphaMode alphaMode = AlphaMode::Opaque;
  BlendMode blend = BlendMode::Over; // of AlphaMode::Blend
  float alphaCutoff = 0.5F;
  bool doubleSided = false; // transparent surfaces are always drawn two-sided
  bool unlit = false;       // KHR_materials_unlit: the base colour is the result
  glm::vec4 baseColor{1.0F};
  float metallic = 1.0F;
  float roughness = 1.0F;
  glm::vec3 emissive{0.0F}; // emissiveFactor * emissiveStrength
  float normalScale = 1.0F;
  float occlusionStrength = 1.0F;
  float transmission = 0.0F;    // KHR_materials_transmission: the share of the light behind that passes through, tinted
  TextureSlot baseColorTexture; // sRGB colour, linear alpha
  TextureSlot metallicRoughnessTexture; // g = roughness, b = metallic
  TextureSlot normalTexture;
  TextureSlot occlusionTexture;    // r
  TextureSlot emissiveTexture;     // sRGB
  TextureSlot transmissionTexture; // r
};

// Whether light passes through a surface: it is blended, or lit and transmissive.
bool isTransparent(const Material& material);

// One mesh placed in the world with a material.
struct Draw {
  std::uint32_t mesh = 0;
  std::uint32_t material = 0;
  glm::mat4 transform{1.0F}; // mesh to world
};

// A camera that came with a model, looking along its own -Z.
struct SceneCamera {
  std::string name;
  glm::mat4 cameraToWorld{1.0F}; // a rotation and a translation
  bool orthographic = false;
  float verticalFov = 0.785398F; // radians; perspective only
  float halfHeight = 1.0F;       // world units; orthographic only (glTF's ymag)
  float nearPlane = 0.1F;
  std::optional<float> farPlane; // none: infinite; perspective only
};

struct Background {
  enum class Kind { Color, Sky, Transparent };
  Kind kind = Kind::Color;
  glm::vec3 srgb{1.0F}; // [0, 1]; Color only
};

struct Bounds {
  glm::vec3 min{0.0F};
  glm::vec3 max{0.0F};
};

struct Scene {
  std::string name;
  std::vector<Mesh> meshes;
  std::vector<Image> images;
  std::vector<Material> materials;
  std::vector<Draw> draws;
  std::vector<SceneCamera> cameras;
  std::optional<Background> background; // what the scene asks for where the user does not choose
};

// The smallest box around all drawn triangles, in the world. The scene has at least one draw.
Bounds worldBounds(const Scene& scene);

// Calls `visit` once a draw with the world positions of all vertices that its triangles use. The span lasts as long as
// the call.
void visitPositions(const Scene& scene, const std::function<void(std::span<const glm::vec3>)>& visit);

// The number of triangles that the draws of a scene put on the GPU.
std::uint64_t triangleCount(const Scene& scene);

} // namespace vitrail::tool
