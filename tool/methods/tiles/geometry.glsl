// The scene's draws for compute shaders: vertices, instances, materials. Set 2 of the method tiles.
#ifndef VITRAIL_TOOL_TILES_GEOMETRY_GLSL
#define VITRAIL_TOOL_TILES_GEOMETRY_GLSL

#include "tiles_shared.h"

layout(set = 0, binding = 0, std140) uniform FrameBlock { FrameData frame; };

layout(set = 2, binding = 0, std430) readonly buffer PositionBlock { float positions[]; };
layout(set = 2, binding = 1, std430) readonly buffer NormalBlock { uint normals[]; };
layout(set = 2, binding = 2, std430) readonly buffer TangentBlock { uint tangents[]; };
layout(set = 2, binding = 3, std430) readonly buffer TexCoord0Block { float texCoords0[]; };
layout(set = 2, binding = 4, std430) readonly buffer TexCoord1Block { float texCoords1[]; };
layout(set = 2, binding = 5, std430) readonly buffer ColorBlock { uint colors[]; };
layout(set = 2, binding = 6, std430) readonly buffer InstanceBlock { vec4 instanceRows[]; };
layout(set = 2, binding = 7, std430) readonly buffer MaterialsBlock { TilesMaterial materials[]; };
layout(set = 2, binding = 8, std430) readonly buffer DrawBlock { TilesDraw draws[]; };

// Of each vertex of each instance its normal in the world, where positions are kept: by the same places.
#if VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_POSITIONS
layout(set = 2, binding = 9, std430) writeonly buffer NormalInWorldBlock { vec4 normalsInWorld[]; };
#else
layout(set = 2, binding = 9, std430) readonly buffer NormalInWorldBlock { vec4 normalsInWorld[]; };
#endif

struct InstancePlace {
  vec4 row0;
  vec4 row1;
  vec4 row2;
};

InstancePlace placeOf(uint instance) {
  return InstancePlace(instanceRows[3u * instance], instanceRows[3u * instance + 1u], instanceRows[3u * instance + 2u]);
}

vec3 positionOf(uint draw, uint vertex) {
  uint at = draws[draw].firstWords[0] + vertex * draws[draw].vertexWords[0];
  return vec3(positions[at], positions[at + 1u], positions[at + 2u]);
}

// In the steps of surface.vert, each rounded as there.
vec4 worldOf(InstancePlace place, vec3 local) {
  vec4 position = vec4(local, 1.0);
  precise vec4 world = vec4(dot(place.row0, position), dot(place.row1, position), dot(place.row2, position), 1.0);
  return world;
}
vec4 clipOf(vec4 world) {
  precise vec4 clip = frame.viewProjection * world;
  return clip;
}

vec3 fromOctahedral(vec2 p) {
  vec3 v = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float fold = max(-v.z, 0.0);
  v.x -= v.x < 0.0 ? -fold : fold;
  v.y -= v.y < 0.0 ? -fold : fold;
  return normalize(v);
}

uint word(uint draw, uint stream, uint vertex) {
  return draws[draw].firstWords[stream] + vertex * draws[draw].vertexWords[stream];
}

vec3 normalOf(uint draw, uint vertex) { return fromOctahedral(unpackSnorm2x16(normals[word(draw, 1u, vertex)])); }

// How directions turn with an instance. As surface.vert: normals by the cofactors.
struct InstanceTurn {
  mat3 rows;  // of the transform over its largest number
  float size; // that number
  mat3 cofactors;
  float volume;
  float mirrored; // -1 or 1
};

InstanceTurn turnOf(InstancePlace place) {
  InstanceTurn turn;
  vec3 largest = max(max(abs(place.row0.xyz), abs(place.row1.xyz)), abs(place.row2.xyz));
  turn.size = max(max(largest.x, largest.y), largest.z);
  turn.rows = mat3(place.row0.xyz, place.row1.xyz, place.row2.xyz) * (turn.size > 0.0 ? 1.0 / turn.size : 0.0);
  turn.cofactors =
      mat3(cross(turn.rows[1], turn.rows[2]), cross(turn.rows[2], turn.rows[0]), cross(turn.rows[0], turn.rows[1]));
  turn.volume = dot(turn.rows[0], turn.cofactors[0]);
  turn.mirrored = turn.volume < 0.0 ? -1.0 : 1.0;
  return turn;
}

vec3 turnedNormal(InstanceTurn turn, vec3 normal) { return turn.mirrored * (normal * turn.cofactors); }

#endif
