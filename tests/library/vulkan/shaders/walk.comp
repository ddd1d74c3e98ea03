// Writes down what lies under each pixel of an area, front to back.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/list.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Constants {
  uvec4 area; // x, y, width, height
  uint most;  // layers that are written down of a pixel
};
// Of each pixel: how many layers it has, whether the walk was cut, and the layers, 8 words each.
layout(set = 1, binding = 0, std430) writeonly buffer WalkedBlock { uint walked[]; };

void main() {
  uvec2 place = gl_GlobalInvocationID.xy;
  if (place.x >= area.z || place.y >= area.w) return;
  uint first = (place.y * area.z + place.x) * (2u + 8u * most);
  VitrailList list = vitrailOpenList(ivec2(place + area.xy));
  VitrailLayer layer;
  uint count = 0u;
  while (vitrailNextLayer(list, layer)) {
    if (count < most) {
      uint at = first + 2u + 8u * count;
      for (uint i = 0u; i < 4u; ++i) walked[at + i] = floatBitsToUint(layer.color[i]);
      walked[at + 4u] = floatBitsToUint(layer.depth);
      walked[at + 5u] = layer.blend;
      walked[at + 6u] = layer.coverage;
      walked[at + 7u] = layer.word;
    }
    ++count;
  }
  walked[first] = count;
  walked[first + 1u] = vitrailListWasCut(list) ? 1u : 0u;
}
