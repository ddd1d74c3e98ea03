// The second pass of the method loop: colours go where the first pass has put their orders, the others to the tail.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "methods/shared/layers.glsl"

layout(set = 2, binding = 1, std430) buffer EntriesBlock { uint entries[]; }; // colour, order, colour, order, ...

// The layers of one order are as many as its fragments, or as there were left; its colours sort themselves in among
// them as the orders did. One below EMPTY is the largest colour: its red is 254/255.
void place(uvec2 entry) {
  uint moving = min(entry.x, LAYERS_EMPTY - 1u);
  for (uint layer = 0u; layer < kLayers; ++layer) {
    uint at = 2u * entryIndex(layer);
    uint order = entries[at + 1u];
    if (order > entry.y) break;
    if (order < entry.y) continue;
    uint before = atomicMin(entries[at], moving);
    moving = max(before, moving);
    if (moving == LAYERS_EMPTY) return;
  }
  addToTail(uvec2(moving, entry.y));
}

void main() {
  uvec2 found[2] = entriesOf(shadeSurface());
  for (uint i = 0u; i < mostEntries(); ++i) {
    if (found[i].y != LAYERS_EMPTY) place(found[i]);
  }
}
