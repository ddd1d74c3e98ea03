// The second dispatch of the compute resolve of a single-sample target: one thread a long list.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "resolve_bindings.glsl"

void vitrailStoreNode(uint index, uvec2 colorAndDepth) {
  nodes[index].color = colorAndDepth.x;
  nodes[index].depth = colorAndDepth.y;
}
void vitrailStoreNext(uint index, uint next) { nodes[index].next = next; }
#include "vitrail/resolve_long.glsl"

layout(local_size_x = 32) in; // LONG_GROUP_SIZE

void main() {
  uint group = gl_WorkGroupID.y * GROUPS_IN_ROW + gl_WorkGroupID.x;
  uint slot = group * LONG_GROUP_SIZE + gl_LocalInvocationIndex;
  if (slot >= min(control.longLists, uint(longPixels.length()))) return;
  uint pixelIndex = longPixels[slot];
  VitrailResolved r = vitrailResolveLong(heads[pixelIndex], nodesInUse(), parameters.nearestIsOne != 0u);
  blendOver(uvec2(pixelIndex % parameters.width, pixelIndex / parameters.width), r.color, r.transmittance);
  atomicMax(control.layersMax, r.layers);
  if (!r.complete) atomicAdd(control.cutPixels, 1u);
}
