// What both dispatches of the compute resolve bind, and how a resolved list reaches the picture. VITRAIL_COLOR_FORMAT is
// the image's format.
#ifndef VITRAIL_RESOLVE_BINDINGS_GLSL
#define VITRAIL_RESOLVE_BINDINGS_GLSL

#include "vitrail/layout.h"

layout(set = 0, binding = 0, std140) uniform ParametersBlock { VitrailParameters parameters; };
layout(set = 0, binding = 1, std430) buffer ControlBlock { VitrailControl control; };
layout(set = 0, binding = 2, std430) readonly buffer HeadsBlock { uint heads[]; };
layout(set = 0, binding = 3, std430) buffer NodesBlock { VitrailNode nodes[]; };
layout(set = 0, binding = 4, std430) buffer LongListsBlock { uint longPixels[]; }; // control.longLists of them
layout(set = 1, binding = 0, VITRAIL_COLOR_FORMAT) uniform image2D colorImage;

VitrailNode vitrailLoadNode(uint index) { return nodes[index]; }

// The work groups of the second dispatch in a row: the least that maxComputeWorkGroupCount may be, rounded down.
const uint GROUPS_IN_ROW = 32768u;
const uint LONG_GROUP_SIZE = 32u;

uint nodesInUse() { return min(control.stored, parameters.capacity); }

// The opaque colour d, premultiplied, becomes C + T * d.
void blendOver(uvec2 pixel, vec3 color, float transmittance) {
  vec4 behind = imageLoad(colorImage, ivec2(pixel));
  // behind.a + (1 - behind.a) * (1 - T), without the rounding that would move an opaque 1
  float alpha = 1.0 - transmittance * (1.0 - behind.a);
  imageStore(colorImage, ivec2(pixel), vec4(color + transmittance * behind.rgb, alpha));
}

#endif
