// The resolve of the method a-buffer: each pixel's array is sorted and blended over the picture.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "vitrail/node.glsl"

#include "a_buffer_shared.h"
#include "gpu/pixel_pass_shared.h"

layout(local_size_x = PIXEL_GROUP_SIDE, local_size_y = PIXEL_GROUP_SIDE) in;

layout(set = 0, binding = 0, std430) readonly buffer OffsetsBlock { uint offsets[]; };
layout(set = 0, binding = 1, std430) readonly buffer FilledBlock { uint filled[]; };
layout(set = 0, binding = 2, std430) readonly buffer FragmentsBlock { uvec2 fragments[]; };
layout(set = 0, binding = 3, std430) buffer ControlBlock { ABufferControl control; };
layout(set = 0, binding = 4, rgba16f) uniform image2D colorImage;

layout(push_constant) uniform ResolveBlock { ABufferResolve picture; };

const VitrailLayout kNodes = VitrailLayout(VITRAIL_FORMAT_STANDARD, 1u, true);

uint arrayStart; // of the pixel

uvec4 arrayKey(uint i) {
  uvec4 key = vitrailKey(uvec4(fragments[arrayStart + i], 0u, 0u), kNodes);
  key.w = i; // fragments that are the same in all else may change places
  return key;
}

VitrailPair arrayPair(uvec4 key) { return vitrailPairOf(key, kNodes); }

#include "methods/shared/array_blend.glsl"

shared uint groupCovered;
shared uint groupLayers;
shared uint groupCut;
shared uint groupFragments;

void resolve(ivec2 pixel) {
  uint number = pixel.y * picture.width + pixel.x;
  uint count = filled[number];
  if (count == 0u) return;
  arrayStart = offsets[number];
  VitrailPair front = VitrailPair(vec3(0.0), vec4(1.0));
  if (!blendArray(count, front)) atomicAdd(groupCut, 1u);
  vec4 behind = imageLoad(colorImage, pixel);
  imageStore(colorImage, pixel, vec4(front.color, 1.0 - front.transmittance.a) + front.transmittance * behind);
  atomicAdd(groupCovered, 1u);
  atomicMax(groupLayers, count);
  atomicAdd(groupFragments, count);
}

void main() {
  bool first = gl_LocalInvocationIndex == 0u;
  if (first) groupCovered = groupLayers = groupCut = groupFragments = 0u;
  if (gl_GlobalInvocationID.xy == uvec2(0u)) control.total = offsets[picture.total];
  barrier();
  uvec2 pixel = gl_GlobalInvocationID.xy;
  bool fits = offsets[picture.total] <= uint(fragments.length()); // else the picture is drawn again
  if (fits && pixel.x < picture.width && pixel.y < picture.height) resolve(ivec2(pixel));
  barrier();
  if (!first || groupCovered == 0u) return;
  uint slot = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) % COUNT_SLOTS;
  atomicAdd(control.counts[slot].coveredPixels, groupCovered);
  atomicMax(control.counts[slot].layersMax, groupLayers);
  atomicAdd(control.counts[slot].cutPixels, groupCut);
  atomicAdd(control.counts[slot].fragments, groupFragments);
}
