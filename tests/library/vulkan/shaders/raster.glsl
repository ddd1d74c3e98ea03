// The raster host's shader: vertices in clip space, colours by the draw's word. A word's upper half says what else of a
// surface becomes its colour.
#version 460
#pragma shader_stage(compute)
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 1
#include "vitrail/raster.glsl"

layout(set = 0, binding = 0, std430) readonly buffer VertexBlock { vec4 vertices[]; };
layout(set = 0, binding = 1, std430) readonly buffer ColorBlock { vec4 colors[]; };
layout(set = 0, binding = 2, std430) readonly buffer ShiftBlock { vec4 shifts[]; }; // of instances

vec4 vitrailPosition(VitrailVertex vertex) { return vertices[vertex.vertex] + shifts[vertex.instance]; }

#if VITRAIL_RASTER_FRAGMENTS == 2

VitrailFragments vitrailShadeTwice(VitrailSurface surface) { // of which there is one
  VitrailFragments fragments;
  fragments.colors[0] = colors[surface.word & 0xffffu];
  fragments.blends[0] = VITRAIL_OVER;
  fragments.colors[1] = vec4(0.0);
  fragments.blends[1] = VITRAIL_OVER;
  fragments.count = 1u;
  return fragments;
}

#else

vec4 vitrailShade(VitrailSurface surface) {
  vec4 color = colors[surface.word & 0xffffu];
  uint shows = surface.word >> 16;
  if (shows == 1u) color.rgb = surface.front ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 0.0, 1.0);
  if (shows == 2u) color.rgb = surface.weights;
  if (shows == 3u) color.rgb = vec3(surface.vertices) / 256.0;
  if (shows == 4u) color.rgb = vec3(surface.primitive, surface.instance, surface.draw) / 256.0;
  if (shows == 5u) {
    vec3 right, down;
    vitrailDerivatives(surface, right, down);
    color.rgb = abs(right) + abs(down);
  }
  if (shows == 6u && (surface.pixel.x & 1) != 0) color.a = 0.0; // a mask
  return color;
}

#endif
