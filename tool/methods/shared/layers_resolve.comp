// The resolve of the methods loop, loop-64 and interlock: the entries, which are in order, front to back, and the tail
// under them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "vitrail/sums.glsl"

#include "layers_shared.h"
#include "gpu/pixel_pass_shared.h"

layout(local_size_x = PIXEL_GROUP_SIDE, local_size_y = PIXEL_GROUP_SIDE) in;

layout(constant_id = 1) const uint kLayers = 8u;

layout(set = 0, binding = 0, std430) buffer ControlBlock { LayersControl control; };
layout(set = 0, binding = 1, std430) readonly buffer EntriesBlock { uvec2 entries[]; }; // colour, order
layout(set = 0, binding = 2, std430) readonly buffer TailsBlock { uint tails[]; };
layout(set = 0, binding = 3, rgba16f) uniform image2D colorImage;

const VitrailLayout kNodes = VitrailLayout(VITRAIL_FORMAT_STANDARD, 1u, true);

shared uint groupCovered;
shared uint groupLayers;
shared uint groupFragments;
shared uint groupTails;

vec3 color = vec3(0.0);
vec4 transmittance = vec4(1.0);

void blend(VitrailPair pair) {
  color += transmittance.rgb * pair.color;
  transmittance *= pair.transmittance;
}

void resolve(ivec2 pixel, ivec2 size) {
  uint pixels = uint(size.x * size.y);
  uint index = uint(pixel.y * size.x + pixel.x);
  uint layers = 0u;
  for (; layers < kLayers; ++layers) {
    uvec2 entry = entries[layers * pixels + index];
    if (entry.y == LAYERS_EMPTY) break;
    blend(vitrailPairOf(uvec4(entry.yx, 0u, 0u), kNodes));
  }
  if (layers == 0u) return;
  uint words[LAYERS_TAIL_WORDS];
  for (uint i = 0u; i < LAYERS_TAIL_WORDS; ++i) words[i] = tails[i * pixels + index];
  uint tail = words[LAYERS_TAIL_WORDS - 1u];
  if (tail > 0u) {
    VitrailSums sums = VITRAIL_NO_SUMS;
    sums.color = uvec3(words[0], words[1], words[2]);
    sums.opacity = words[3];
    sums.density = words[4];
    blend(vitrailPairOfSums(sums));
  }
  vec4 behind = imageLoad(colorImage, pixel);
  imageStore(colorImage, pixel, vec4(color, 1.0 - transmittance.a) + transmittance * behind);
  atomicAdd(groupCovered, 1u);
  atomicMax(groupLayers, layers + tail);
  atomicAdd(groupFragments, layers + tail);
  if (tail > 0u) atomicAdd(groupTails, 1u);
}

void main() {
  bool first = gl_LocalInvocationIndex == 0u;
  if (first) groupCovered = groupLayers = groupFragments = groupTails = 0u;
  barrier();
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(colorImage);
  if (all(lessThan(pixel, size))) resolve(pixel, size);
  barrier();
  if (!first || groupCovered == 0u) return;
  uint slot = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) % COUNT_SLOTS;
  atomicAdd(control.counts[slot].coveredPixels, groupCovered);
  atomicMax(control.counts[slot].layersMax, groupLayers);
  atomicAdd(control.counts[slot].fragments, groupFragments);
  atomicAdd(control.counts[slot].cutPixels, groupTails);
}
