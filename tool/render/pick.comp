// Walks the list of one pixel, nearest first, to the nearest opaque surface, and tells the host what is there.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#define VITRAIL_SORTED_LISTS
#include "vitrail/list.glsl"

#include "pick_shared.h"

layout(local_size_x = 1) in;

layout(set = 1, binding = 0, std430) writeonly buffer PickBlock {
  uint count;
  uint cut; // 1: there are more
  uint unused[2];
  VitrailLayer layers[];
};
layout(push_constant) uniform Pixel { ivec2 pixel; };

void main() {
  VitrailList list = vitrailOpenList(pixel);
  VitrailLayer layer;
  uint found = 0u;
  bool isOpaque = false;
  while (!isOpaque && found < PICK_MOST_LAYERS && vitrailNextLayer(list, layer)) {
    layers[found++] = layer;
    isOpaque = (layer.word & PICK_OPAQUE) != 0u;
  }
  count = found;
  cut = !isOpaque && vitrailListWasCut(list) ? 1u : 0u;
}
