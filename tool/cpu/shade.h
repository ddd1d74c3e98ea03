// Shades fragments of the rasteriser for CPUs as docs/shading.md states it, with the vector instructions that the
// processor has. What surface.vert and surface.glsl do on GPUs is done here in one: a fragment's attributes are those
// of its triangle's corners, interpolated.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <vitrail/cpu.h>
#include <glm/glm.hpp>

#include "../stage/surface_shared.h"
#include "cpu_texture.h"

namespace vitrail::tool {

// What all draws of a picture share.
struct ShadeFrame {
  shaders::FrameData data{};
  // The way from a perspective camera's pixel at (x, y) to the eye, not of unit length: toEye + x * toEyeX + y *
  // toEyeY.
  glm::vec3 toEye{0.0F};
  glm::vec3 toEyeX{0.0F};
  glm::vec3 toEyeY{0.0F};
  std::vector<shaders::LightData> lights; // the scene's own
};

ShadeFrame makeShadeFrame(const shaders::FrameData& data, std::vector<shaders::LightData> lights);

// The vertices that draws of one mesh are made of, as Mesh keeps them; null for what it does not have.
struct ShadeMesh {
  std::uint32_t corners = 3; // indices a triangle, line or point
  const std::uint32_t* indices = nullptr;
  const glm::vec3* positions = nullptr;
  const std::uint32_t* normals = nullptr;
  const std::uint32_t* tangents = nullptr;
  const glm::vec2* texCoords0 = nullptr;
  const glm::vec2* texCoords1 = nullptr;
  const std::uint64_t* colors = nullptr;
};

// What the plainest lit surfaces are shaded with, worked out from their material (shade_plain-inl.h). By channel.
struct PlainSurface {
  float a2 = 1.0F; // of the roughness
  float alpha = 1.0F;
  std::array<float, 3> diffuseOverPi{};
  std::array<float, 3> f0{};
  std::array<float, 3> rest{};          // 1 - f0
  std::array<float, 3> ambientRise{};   // how much more of the ambient light is mirrored at grazing angles
  std::array<float, 3> ambientAndOwn{}; // the ambient light that is scattered where it comes from below, and emission
  std::array<float, 3> ambientSky{};    // how much more there is where it comes from above
};

PlainSurface makePlainSurface(const shaders::MaterialData& material);

// What draws of one mesh with one material share.
struct ShadeSurface {
  ShadeMesh mesh;
  std::uint32_t features = 0; // surface_shared.h
  bool isOpaque = false;
  shaders::MaterialData material{};
  PlainSurface plain; // of the material
  CpuSlots slots;
};

// One draw: VitrailCpuDraw::shadeUser. What it points to outlives it.
struct ShadeDraw {
  const ShadeFrame* frame = nullptr;
  const ShadeSurface* surface = nullptr;
  // From the mesh's space to that of the frame: rows.
  std::array<glm::vec4, 3> rows{};
  glm::mat3 normals{1.0F}; // turns normals: columns are what each row's dot product is taken with
  glm::mat3 tangents{1.0F};
  float longer = 1.0F;          // how much longer things become
  std::uint32_t flipped = 0;    // bits to turn round of those that say which fragments show the front, and
  std::uint32_t front = 0;      // bits to set
  bool keepsDirections = false; // the transform moves and scales alike in all directions, and does nothing else
  float mirrored = 1.0F;        // -1: the transform turns counter-clockwise into clockwise
};

ShadeDraw makeShadeDraw(const ShadeFrame& frame, const ShadeSurface& surface, const glm::mat4& place, bool mirrored);

// The function that shades draws of a surface, whose `user` is a ShadeDraw, and the flags that go with it. None for one
// whose fragments all have one colour.
struct ShadeFunction {
  VitrailCpuShade shade = nullptr;
  std::uint32_t flags = 0; // VitrailCpuShadeBits
};
ShadeFunction shadeFunction(const ShadeSurface& surface, VitrailCpuInstructions instructions);

// What the alpha of a surface's fragments is never below; 0 where that is not known.
float leastAlphaOf(const ShadeSurface& surface);

// The colour of a surface that needs no function, as its blend mode takes it.
glm::vec4 constantColor(const ShadeSurface& surface);

// Whether the mask leaves nothing of such a surface.
bool isMaskedAway(const ShadeSurface& surface);

// Fills a row of an RGBA32F picture with the sky.
void shadeSky(const shaders::FrameData& frame, std::uint32_t row, std::span<float> rgba);

} // namespace vitrail::tool
