// The first pass of the method loop: the orders of a pixel's nearest fragments sort themselves in by atomic minima.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "methods/shared/layers.glsl"

layout(set = 2, binding = 1, std430) buffer EntriesBlock { uint entries[]; }; // colour, order, colour, order, ...

// Each layer keeps the least of what comes by and sends the others on, in whatever order they come.
void keep(uint moving) {
  for (uint layer = 0u; layer < kLayers; ++layer) {
    uint before = atomicMin(entries[2u * entryIndex(layer) + 1u], moving);
    moving = max(before, moving);
    if (moving == LAYERS_EMPTY) return;
  }
}

void main() {
  uvec2 found[2] = entriesOf(shadeSurface());
  for (uint i = 0u; i < mostEntries(); ++i) {
    if (found[i].y != LAYERS_EMPTY) keep(found[i].y);
  }
}
