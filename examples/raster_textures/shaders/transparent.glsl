// The same as a host of vitrail/raster.glsl, compiled once for each stage: scene.vert and transparent.frag in one, with
// vertices from the buffer that the hardware draws from.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 1
#define VITRAIL_COLOR_FORMAT rgba32f
#include "vitrail/raster.glsl"
#include "scene.glsl"

layout(set = 0, binding = 1, std430) readonly buffer VertexBlock { float vertices[]; }; // 8 each

vec3 vec3At(uint i) { return vec3(vertices[i], vertices[i + 1u], vertices[i + 2u]); }
vec3 positionOf(uint vertex) { return vec3At(8u * vertex); }
vec3 normalOf(uint vertex) { return vec3At(8u * vertex + 3u); }
vec2 texCoordOf(uint vertex) { return vec2(vertices[8u * vertex + 6u], vertices[8u * vertex + 7u]); }

vec4 vitrailPosition(VitrailVertex vertex) {
  return toClip(toWorld(vertex.instance, positionOf(vertex.vertex)));
}

// Only the stages that blend have what it takes.
#if VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_BLEND || VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_BLEND_DEEP
#include "material.glsl"

// What hardware interpolates is here the sum of three corners' values, by their weights.
vec4 vitrailShade(VitrailSurface surface) {
  mat3 positions, normals;
  mat3x2 texCoords;
  for (int i = 0; i < 3; ++i) {
    positions[i] = positionOf(surface.vertices[i]);
    normals[i] = normalOf(surface.vertices[i]);
    texCoords[i] = texCoordOf(surface.vertices[i]);
  }
  vec3 right, down;
  vitrailDerivatives(surface, right, down);
  Point point;
  point.position = toWorld(surface.instance, positions * surface.weights);
  point.normal = turned(surface.instance, normals * surface.weights);
  point.texCoord = texCoords * surface.weights;
  point.texCoordRight = texCoords * right;
  point.texCoordDown = texCoords * down;
  point.front = surface.front;
  return materialColor(surface.word, point);
}
#endif
