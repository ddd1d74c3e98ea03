// Transparent surfaces of the method insertion: each fragment goes on its pixel's list.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "vitrail/node.glsl"

#include "insertion_shared.h"
#include "stage/surface.glsl"

layout(early_fragment_tests) in;

layout(set = 2, binding = 0, std430) buffer ControlBlock { InsertionControl control; };
layout(set = 2, binding = 1, r32ui) uniform uimage2D heads;
layout(set = 2, binding = 2, std430) writeonly buffer NodesBlock { InsertionNode nodes[]; };

const VitrailLayout kNodes = VitrailLayout(VITRAIL_FORMAT_STANDARD, 1u, true);

void collect(vec4 color, uint blend) {
  uvec4 node;
  if (!vitrailPack(color, blend, gl_FragCoord.z, 1u, kNodes, node)) return;
  uint index = atomicAdd(control.taken, 1u);
  if (index >= uint(nodes.length())) return;
  uint next = imageAtomicExchange(heads, ivec2(gl_FragCoord.xy), index);
  nodes[index] = InsertionNode(node.x, node.y, next);
}

void main() {
  Surface surface = shadeSurface();
  if (has(FEATURE_TRANSMISSION)) {
    collect(reflectionOf(surface), VITRAIL_PREMULTIPLIED);
    collect(filterOf(surface), VITRAIL_MULTIPLY);
  } else {
    collect(vec4(surface.color, surface.alpha), has(FEATURE_ADDITIVE) ? VITRAIL_ADDITIVE : VITRAIL_OVER);
  }
}
