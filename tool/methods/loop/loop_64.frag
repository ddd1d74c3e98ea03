// Transparent surfaces of the method loop-64: entries sort themselves in by atomic minima.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "methods/shared/layers.glsl"

layout(set = 2, binding = 1, std430) buffer EntriesBlock { uint64_t entries[]; };

// Each layer keeps the least of what comes by and sends the others on, in whatever order they come.
void keep(uvec2 entry) {
  uint64_t moving = packUint2x32(entry);
  for (uint layer = 0u; layer < kLayers; ++layer) {
    uint64_t before = atomicMin(entries[entryIndex(layer)], moving);
    moving = max(before, moving);
    if (unpackUint2x32(moving).y == LAYERS_EMPTY) return;
  }
  addToTail(unpackUint2x32(moving));
}

void main() {
  uvec2 found[2] = entriesOf(shadeSurface());
  for (uint i = 0u; i < mostEntries(); ++i) {
    if (found[i].y != LAYERS_EMPTY) keep(found[i]);
  }
}
