// The second geometry pass of the method a-buffer: each fragment goes to the next place of its pixel's array.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "vitrail/node.glsl"

#include "stage/surface.glsl"

layout(early_fragment_tests) in;

layout(set = 2, binding = 0, std430) readonly buffer OffsetsBlock { uint offsets[]; };
layout(set = 2, binding = 1, std430) buffer FilledBlock { uint filled[]; };
layout(set = 2, binding = 2, std430) writeonly buffer FragmentsBlock { uvec2 fragments[]; };

layout(push_constant) uniform PictureBlock { uint width; };

const VitrailLayout kNodes = VitrailLayout(VITRAIL_FORMAT_STANDARD, 1u, true);

void store(vec4 color, uint blend) {
  uvec4 node;
  if (!vitrailPack(color, blend, gl_FragCoord.z, 1u, kNodes, node)) return;
  uvec2 pixel = uvec2(gl_FragCoord.xy);
  uint number = pixel.y * width + pixel.x;
  uint place = offsets[number] + atomicAdd(filled[number], 1u);
  if (place < uint(fragments.length())) fragments[place] = node.xy;
}

void main() {
  Surface surface = shadeSurface();
  if (has(FEATURE_TRANSMISSION)) {
    store(reflectionOf(surface), VITRAIL_PREMULTIPLIED);
    store(filterOf(surface), VITRAIL_MULTIPLY);
  } else {
    store(vec4(surface.color, surface.alpha), has(FEATURE_ADDITIVE) ? VITRAIL_ADDITIVE : VITRAIL_OVER);
  }
}
