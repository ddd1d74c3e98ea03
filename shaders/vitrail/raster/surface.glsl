// What the host's functions are given: vertices and surfaces.
#ifndef VITRAIL_RASTER_SURFACE_GLSL
#define VITRAIL_RASTER_SURFACE_GLSL

#include "frame.glsl"

// Of each vertex of each instance its place in clip space, where they are kept.
#if VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_POSITIONS
layout(VITRAIL_RASTER_BOUND(27), std430) writeonly buffer VitrailPositionBlock { vec4 vitrailPositions[]; };
#else
layout(VITRAIL_RASTER_BOUND(27), std430) readonly buffer VitrailPositionBlock { vec4 vitrailPositions[]; };
#endif

// The host's position of a vertex, with a depth of which 1 is nearest.
vec4 vitrailAskPosition(uint draw, uint item, uint index) {
  VitrailVertex vertex;
  vertex.draw = draw;
  vertex.instance = vitrailInstance(draw, item);
  vertex.vertex = vitrailVertexOf(draw, index);
  vertex.place = VITRAIL_RASTER_POSITIONS ? vitrailVertexPlace(draw, item, index) : VITRAIL_NOT_KEPT;
  vertex.word = vitrailWordOf(draw);
  vec4 position = vitrailPosition(vertex);
  if (VITRAIL_RASTER_NEAREST_IS_ZERO) {
    precise float z = position.w - position.z;
    position.z = z;
  }
  return position;
}

#if VITRAIL_RASTER_STAGE != VITRAIL_RASTER_STAGE_POSITIONS
vec4 vitrailClipPosition(uint draw, uint item, uint index) {
#if VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_SET_UP
  if (VITRAIL_RASTER_POSITIONS) return vitrailPositions[vitrailVertexPlace(draw, item, index)];
#else // which knows the item sooner than the draw
  if (VITRAIL_RASTER_POSITIONS) return vitrailPositions[vitrailItems[item].y + index];
#endif
  return vitrailAskPosition(draw, item, index);
}
#endif

// Weights of a triangle's corners at a place, with perspective, from the corners' x, y and w in clip space after the
// place has been moved to the origin (Olano and Greer, "Triangle scan conversion using 2D homogeneous coordinates",
// 1997): right also where a corner lies behind the eye.
vec3 vitrailWeightsOf(vec2 a, vec2 b, vec2 c) {
  vec3 e = vec3(b.x * c.y - b.y * c.x, c.x * a.y - c.y * a.x, a.x * b.y - a.y * b.x);
  float sum = e.x + e.y + e.z;
  return sum != 0.0 ? e / sum : vec3(1.0 / 3.0);
}

// Of a line, at the place nearest to another along the axis along which it is longer.
vec2 vitrailWeightsOf(vec3 a, vec3 b, vec2 ndc, vec2 size) {
  vec2 way = abs((b.xy * a.z - a.xy * b.z) * size);
  vec2 from = a.xy - ndc * a.z;
  vec2 to = b.xy - ndc * b.z;
  vec2 ends = way.y > way.x ? vec2(from.y, to.y) : vec2(from.x, to.x);
  float t = ends.x != ends.y ? clamp(ends.x / (ends.x - ends.y), 0.0, 1.0) : 0.0;
  return vec2(1.0 - t, t);
}

vec3 vitrailWeightsAt(VitrailSurface surface, vec2 place) {
  vec2 size = vec2(vitrailRaster.width, vitrailRaster.height);
  vec2 ndc = place * 2.0 / size - 1.0;
  mat3 c = surface.clip;
  if (surface.corners == 1u) return vec3(1.0, 0.0, 0.0);
  if (surface.corners == 2u) return vec3(vitrailWeightsOf(c[0], c[1], ndc, size), 0.0);
  return vitrailWeightsOf(c[0].xy - ndc * c[0].z, c[1].xy - ndc * c[1].z, c[2].xy - ndc * c[2].z);
}

void vitrailDerivatives(VitrailSurface surface, out vec3 right, out vec3 down) {
  vec2 way = mix(vec2(1.0), vec2(-1.0), equal(surface.pixel & 1, ivec2(1))); // from the even pixel to the odd one
  vec2 middle = vec2(surface.pixel) + 0.5;
  right = (vitrailWeightsAt(surface, vec2(middle.x + way.x, middle.y)) - surface.weights) * way.x;
  down = (vitrailWeightsAt(surface, vec2(middle.x, middle.y + way.y)) - surface.weights) * way.y;
}

#if VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_BLEND || VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_BLEND_DEEP
// `source`: the name of the primitive, with the side in its highest bit, and the item.
VitrailSurface vitrailSurfaceOf(uvec2 source, ivec2 pixel) {
  uvec4 item = vitrailItems[source.y];
  uint draw = item.z;
  VitrailSurface surface;
  surface.pixel = pixel;
  surface.draw = draw;
  surface.instance = item.w;
  uint name = source.x & 0x7fffffffu;
  surface.primitive = vitrailPrimitiveOf(item.x, name);
  surface.front = (source.x & 0x80000000u) != 0u;
  surface.word = vitrailWordOf(draw);
  surface.corners = vitrailCornersOf(vitrailFlagsOf(draw));
  uint first = vitrailFirstIndexOf(item.x, surface.corners, name);
  for (uint i = 0u; i < 3u; ++i) {
    uint index = vitrailIndex(draw, first + (i < surface.corners ? i : 0u));
    surface.vertices[i] = vitrailVertexOf(draw, index);
    surface.places[i] = VITRAIL_RASTER_POSITIONS ? item.y + index : VITRAIL_NOT_KEPT;
    if (VITRAIL_RASTER_POSITIONS) {
      surface.clip[i] = vitrailPositions[surface.places[i]].xyw;
    } else {
      surface.clip[i] = vitrailAskPosition(draw, source.y, index).xyw;
    }
  }
  surface.weights = vitrailWeightsAt(surface, vec2(pixel) + 0.5);
  return surface;
}
#endif

#endif
