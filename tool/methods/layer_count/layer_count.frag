// Transparent surfaces of the method layer-count: each fragment that fragment lists would keep adds 1 at its pixel.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "vitrail/node.glsl"

#include "stage/surface.glsl"

layout(early_fragment_tests) in;

layout(set = 2, binding = 0, r32ui) uniform uimage2D counts;

const VitrailLayout kNodes = VitrailLayout(VITRAIL_FORMAT_HDR, 1u, true);

// 1, or 0 for a fragment that cannot be seen.
uint kept(vec4 color, uint blend) {
  uvec4 node;
  return vitrailPack(color, blend, gl_FragCoord.z, 1u, kNodes, node) ? 1u : 0u;
}

void main() {
  Surface surface = shadeSurface();
  uint fragments;
  if (has(FEATURE_TRANSMISSION)) {
    fragments = kept(reflectionOf(surface), VITRAIL_PREMULTIPLIED) + kept(filterOf(surface), VITRAIL_MULTIPLY);
  } else {
    fragments = kept(vec4(surface.color, surface.alpha), has(FEATURE_ADDITIVE) ? VITRAIL_ADDITIVE : VITRAIL_OVER);
  }
  imageAtomicAdd(counts, ivec2(gl_FragCoord.xy), fragments);
}
