// Transparent surfaces of the method interlock: a pixel's entries are sorted in by one fragment at a time.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_fragment_shader_interlock : require
#include "methods/shared/layers.glsl"

layout(pixel_interlock_unordered) in;

layout(set = 2, binding = 1, std430) coherent buffer EntriesBlock { uvec2 entries[]; };

bool isBefore(uvec2 a, uvec2 b) { return a.y < b.y || (a.y == b.y && a.x < b.x); }

// Returns what has no place among the nearest: the farthest entry, or one that is empty.
uvec2 keep(uvec2 entry) {
  for (uint layer = 0u; layer < kLayers && entry.y != LAYERS_EMPTY; ++layer) {
    uvec2 before = entries[entryIndex(layer)];
    if (!isBefore(entry, before)) continue;
    entries[entryIndex(layer)] = entry;
    entry = before;
  }
  return entry;
}

void main() {
  uvec2 found[2] = entriesOf(shadeSurface());
  beginInvocationInterlockARB();
  for (uint i = 0u; i < mostEntries(); ++i) found[i] = keep(found[i]);
  endInvocationInterlockARB();
  for (uint i = 0u; i < mostEntries(); ++i) {
    if (found[i].y != LAYERS_EMPTY) addToTail(found[i]);
  }
}
