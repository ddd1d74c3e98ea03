// After the fragments have been collected, where their shader left the nodes loose (VitrailListBuild): puts every node
// on the list of its pixel and finishes it. One thread a node, or several nodes where there are more than threads. Also
// does what prepare.comp does.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "arguments.glsl"
#include "vitrail/loose.glsl"

layout(local_size_x = 64) in; // kGroupNodes of kernels.h

// Whether a node was given to a fragment that left nothing in it (vitrail/collect.glsl): no other is empty but for the
// pixel, since a fragment without alpha is stored only where its blend mode is not 0.
bool isTurnedAway(uvec4 node) { return (node.x | node.y | node.z | (node.w & ~VITRAIL_PIXEL_MASK)) == 0u; }

void main() {
  if (gl_GlobalInvocationID.x == 0u) writeArguments();
  if (vitrailControl.staleNodes != 0u) { // no telling which: the frame has no lists, and none of its nodes counts
    if (gl_GlobalInvocationID.x == 0u) vitrailControl.misfitNodes = nodesInUse();
    return;
  }
#ifdef VITRAIL_NO_GROUP_COUNT // for languages that do not tell: as the kernel is dispatched (nodeGroups())
  uint groups = min(vitrailParameters.capacity / gl_WorkGroupSize.x + 1u, 32768u);
#else
  uint groups = gl_NumWorkGroups.x;
#endif
  uint threads = groups * gl_WorkGroupSize.x;
  uint nodes = nodesInUse();
  for (uint index = gl_GlobalInvocationID.x; index < nodes; index += threads) {
    uvec4 node = vitrailLoadNode(index, vitrailNodes());
    if (vitrailControl.misfitNodes != 0u && isTurnedAway(node)) continue;
    uint pixelIndex = node.w & VITRAIL_PIXEL_MASK;
    if (pixelIndex >= vitrailParameters.width * vitrailParameters.height) continue; // never, unless memory is corrupt
    uint next = atomicExchange(vitrailHeads[pixelIndex], index) & vitrailNextMask(vitrailNodes());
    if (vitrailIsRaw(vitrailNodes())) {
      node = vitrailFinish(node, vitrailNodes());
      node.w = next;
      vitrailStoreNode(index, node, vitrailNodes());
    } else {
      vitrailStoreNext(index, next, vitrailNodes());
    }
  }
}
