// What a model is once it is in memory: everything the renderer, the reference and the tests know about a scene.
// Right-handed, Y up, metres, as in glTF. Colours are linear unless a name says sRGB. All places are relative to
// Scene::origin.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "objects.h"

namespace vitrail::tool {

// A vertex with all that it may have, as code makes and reads one. Meshes keep less (below).
struct Vertex {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0.0F, 0.0F, 1.0F};        // unit length
  glm::vec4 tangent{1.0F, 0.0F, 0.0F, 1.0F}; // xyz unit length, w = +1 or -1: bitangent = w * cross(normal, tangent)
  glm::vec2 texCoord0{0.0F};
  glm::vec2 texCoord1{0.0F};
  glm::vec4 color{1.0F}; // linear, straight alpha
};

// What three, two or one of a mesh's indices stand for. Lines are a pixel wide, points a number of pixels that is the
// picture's choice; those of a mesh without normals are not lit.
enum class Primitive { Triangles, Lines, Points };

// How many indices make one: 3, 2 or 1.
constexpr std::size_t cornersOf(Primitive primitive) {
  return primitive == Primitive::Triangles ? 3 : primitive == Primitive::Lines ? 2 : 1;
}

// A list of triangles, lines or points. Every index is below vertexCount(), and indices.size() is a multiple of 3, 2 or
// 1. Counter-clockwise triangles, seen from outside, agree with their vertex normals. Vertices are kept as the GPU
// reads them, an array for each attribute: as long as `positions`, or empty, which stands for the value that Vertex
// begins with. Triangles without normals are flat: each has that of its plane.
struct Mesh {
  Primitive primitive = Primitive::Triangles;
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> normals;  // packDirection()
  std::vector<std::uint32_t> tangents; // packTangent()
  std::vector<glm::vec2> texCoords0;
  std::vector<glm::vec2> texCoords1;
  std::vector<std::uint64_t> colors; // packColor()
  std::vector<std::uint32_t> indices;

  std::size_t vertexCount() const { return positions.size(); }
  // A vertex as it is kept: unpacked, and with the default for what the mesh does not have.
  Vertex vertex(std::size_t i) const;
  std::vector<Vertex> vertices() const;
  // Adds a vertex. Attributes other than position and normal are kept from the first vertex on that has them.
  void add(const Vertex& vertex);
  // Replaces vertex i by another one.
  void set(std::size_t i, const Vertex& vertex);
};

// A direction in 32 bits: its octahedral projection (Meyer et al., "On floating-point normal vectors", EGSR 2010) as
// two 16-bit signed normalised numbers, x in the lower half. At most 0.003 degrees off; the axes are exact.
std::uint32_t packDirection(const glm::vec3& unitVector);
glm::vec3 unpackDirection(std::uint32_t packed);
// The same with a sign, w < 0, in place of the last bit: at most 0.005 degrees off.
std::uint32_t packTangent(const glm::vec4& tangent);
glm::vec4 unpackTangent(std::uint32_t packed);
// Four 16-bit floats, red in the lowest bits: at most 2^-11 of the value off, up to 65504.
std::uint64_t packColor(const glm::vec4& color);
glm::vec4 unpackColor(std::uint64_t packed);

// 8-bit RGBA, straight alpha, rows top to bottom without padding. Whether the colours are sRGB is the texture slot's
// business: those of colours are, the others are not.
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

// glTF's metallic-roughness material with the extensions that docs/shading.md names; it states how each is shaded.
// What is 0 or empty is not there.
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

  float ior = 1.5F; // KHR_materials_ior; 0 stands for infinity: everything is reflected
  // KHR_materials_volume: what is between the surfaces of one object that faces both ways.
  float thickness = 0.0F;           // in the mesh's space; 0: the surface is a thin wall
  TextureSlot thicknessTexture;     // g
  float attenuationDistance = 0.0F; // in the world; 0: infinite, nothing is absorbed
  glm::vec3 attenuationColor{1.0F}; // what is left of white light after that distance
  float specular = 1.0F;            // KHR_materials_specular
  glm::vec3 specularColor{1.0F};    // may exceed 1
  TextureSlot specularTexture;      // a
  TextureSlot specularColorTexture; // sRGB
  float clearcoat = 0.0F;           // KHR_materials_clearcoat
  float clearcoatRoughness = 0.0F;
  TextureSlot clearcoatTexture;          // r
  TextureSlot clearcoatRoughnessTexture; // g
  glm::vec3 sheenColor{0.0F};            // KHR_materials_sheen
  float sheenRoughness = 0.0F;
  TextureSlot sheenColorTexture;     // sRGB
  TextureSlot sheenRoughnessTexture; // a
  // KHR_materials_pbrSpecularGlossiness in place of metallic and roughness: baseColor is the diffuse colour,
  // specularColor what is reflected straight on, roughness 1 - glossiness, and metallicRoughnessTexture holds the
  // specular colour (sRGB) and the glossiness (a).
  bool specularGlossiness = false;
  float anisotropy = 0.0F;         // KHR_materials_anisotropy: strength
  float anisotropyRotation = 0.0F; // radians, counter-clockwise from the tangent
  TextureSlot anisotropyTexture;   // rg: direction, b: strength
  float iridescence = 0.0F;        // KHR_materials_iridescence
  float iridescenceIor = 1.3F;
  glm::vec2 iridescenceThickness{100.0F, 400.0F}; // nanometres, of the texture's 0 and 1
  TextureSlot iridescenceTexture;                 // r
  TextureSlot iridescenceThicknessTexture;        // g; without it the film is as thick as the second number
  float diffuseTransmission = 0.0F;               // KHR_materials_diffuse_transmission
  glm::vec3 diffuseTransmissionColor{1.0F};
};

// KHR_lights_punctual. It shines along its own -Z.
struct Light {
  enum class Kind { Directional, Point, Spot };
  Kind kind = Kind::Point;
  std::string name;
  glm::vec3 intensity{1.0F};              // colour times intensity: lux (directional) or candela
  glm::vec3 position{0.0F};               // point and spot
  glm::vec3 direction{0.0F, 0.0F, -1.0F}; // unit length, where the light goes; directional and spot
  float range = 0.0F;                     // 0: infinite
  float innerConeAngle = 0.0F;            // radians from the direction; spot
  float outerConeAngle = 0.785398F;
};

// Whether light passes through a surface: it is blended, or lit and transmissive.
bool isTransparent(const Material& material);

// One mesh placed in the world with a material.
struct Draw {
  std::uint32_t mesh = 0;
  std::uint32_t material = 0;
  glm::mat4 transform{1.0F}; // mesh to world
  std::uint32_t object = ObjectTree::none;
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

// What a file holds, beside what the scene is made of, for people who ask (`vitrail info MODEL`).
struct FileFacts {
  struct Extension {
    std::string name;
    bool required = false;
    bool honoured = false;
    std::string lost; // what the picture lacks where it is not honoured, or only in part; empty: nothing
  };
  struct Animation {
    std::string name;
    double seconds = 0.0;
  };
  std::string format; // "glTF 2.0 (binary)", "OBJ", "PLY (binary)", "STL (text)"
  std::string generator;
  std::vector<Extension> extensions;
  std::vector<Animation> animations;
  std::vector<std::string> variants;
};

std::array<glm::vec3, 8> cornersOf(const Bounds& bounds);
// The box around what a mesh shows, in its own space. It has indices.
Bounds boundsOf(const Mesh& mesh);

struct Scene {
  std::string name;
  // The point of the file's space that is (0, 0, 0) here, in double precision: what lies millions of metres from its
  // own origin keeps its precision in 32-bit floats. All positions, cameras and lights are relative to it.
  glm::dvec3 origin{0.0};
  std::vector<Mesh> meshes;
  std::vector<Image> images;
  std::vector<Material> materials;
  std::vector<Draw> draws;
  ObjectTree objects; // what draws belong to
  std::vector<SceneCamera> cameras;
  std::vector<Light> lights;
  FileFacts file;
  std::vector<std::string> warnings;    // see warn()
  float pointSize = 3.0F;               // how many pixels a point is across
  std::optional<Background> background; // what the scene asks for where the user does not choose
  // What of it is drawn: points with dot(xyz, point) >= w of every plane. At most kMostClipPlanes. Cameras ignore them.
  std::vector<glm::dvec4> clipPlanes;
};

constexpr std::size_t kMostClipPlanes = 8; // what every device that has any has

// Notes what the picture of a scene lacks, or shows otherwise than the file says: one line that names what it is by the
// file's own name for it and says what is lost, as in "image 0: missing.png: no such file; the material is drawn
// without it". The same line is kept once.
void warn(Scene& scene, std::string line);

// The smallest box around all drawn triangles, in the world. The scene has at least one draw.
Bounds worldBounds(const Scene& scene);

// Calls `visit` with the world positions of all vertices that are shown, in pieces. The span lasts as long as the call.
// Where that would be very many, the corners of the boxes around the meshes stand for them.
void visitPositions(const Scene& scene, const std::function<void(std::span<const glm::vec3>)>& visit);

// The number of triangles that the draws of a scene put on the GPU.
std::uint64_t triangleCount(const Scene& scene);

} // namespace vitrail::tool
