// What a host's transparent fragment shaders include. It binds the target's descriptor set and offers one function:
//
//   #extension GL_GOOGLE_include_directive : require
//   #define VITRAIL_SET 1
//   #include "vitrail/collect.glsl"
//   void main() { vitrailCollect(shade()); }   // linear colour, straight alpha
//
// The depth test runs before the shader (early_fragment_tests), so fragments behind opaque geometry never enter a list.
// With it, discard still works: call it before vitrailCollect(), or do not call vitrailCollect() at all.
#ifndef VITRAIL_COLLECT_GLSL
#define VITRAIL_COLLECT_GLSL

#include "node.glsl"

#ifndef VITRAIL_SET
#error define VITRAIL_SET, the descriptor set number of vitrailTargetDescriptorSet() in your pipeline layout
#endif

layout(early_fragment_tests) in;

layout(set = VITRAIL_SET, binding = 0, std140) uniform VitrailParametersBlock { VitrailParameters vitrailParameters; };
layout(set = VITRAIL_SET, binding = 1, std430) buffer VitrailControlBlock { VitrailControl vitrailControl; };
layout(set = VITRAIL_SET, binding = 2, std430) buffer VitrailHeadsBlock { uint vitrailHeads[]; };
layout(set = VITRAIL_SET, binding = 3, std430) writeonly buffer VitrailNodesBlock { VitrailNode vitrailNodes[]; };

// Gives back the node number that was taken beyond the pool and counts the fragment as missing. Giving it back keeps the
// counter from wrapping round to nodes that are in use, however many fragments overflow: the counter stays at or above
// the capacity once it has reached it.
void vitrailCountMissing() {
  atomicAdd(vitrailControl.stored, 0xffffffffu);
  if (atomicAdd(vitrailControl.missingLow, 1u) == 0xffffffffu) atomicAdd(vitrailControl.missingHigh, 1u);
}

// Pushes this fragment on the list of its pixel. `color` is linear with straight alpha. A fragment outside the target's
// extent, or one whose stored alpha is 0, is ignored. When the pool is full the list is left as it is.
void vitrailCollect(vec4 color) {
  uvec2 pixel = uvec2(gl_FragCoord.xy);
  if (pixel.x >= vitrailParameters.width || pixel.y >= vitrailParameters.height) return;
  uint bits = vitrailPackColor(color);
  if (vitrailAlphaBits(bits) == 0u) return;

  uint index = atomicAdd(vitrailControl.stored, 1u);
  if (index >= vitrailParameters.capacity) {
    vitrailCountMissing();
    return;
  }
  uint depth = vitrailPackDepth(gl_FragCoord.z, vitrailParameters.nearestIsOne != 0u);
  uint next = atomicExchange(vitrailHeads[pixel.y * vitrailParameters.width + pixel.x], index);
  vitrailNodes[index] = VitrailNode(bits, depth, next);
}

#endif
