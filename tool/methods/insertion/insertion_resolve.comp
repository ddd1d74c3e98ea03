// The resolve of the method insertion: a list is copied into an array, sorted by insertion, blended front to back.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "vitrail/node.glsl"

#include "insertion_shared.h"
#include "gpu/pixel_pass_shared.h"

layout(local_size_x = PIXEL_GROUP_SIDE, local_size_y = PIXEL_GROUP_SIDE) in;

layout(set = 0, binding = 0, std430) buffer ControlBlock { InsertionControl control; };
layout(set = 0, binding = 1, r32ui) uniform readonly uimage2D heads;
layout(set = 0, binding = 2, std430) readonly buffer NodesBlock { InsertionNode nodes[]; };
layout(set = 0, binding = 3, rgba16f) uniform image2D colorImage;

const VitrailLayout kNodes = VitrailLayout(VITRAIL_FORMAT_STANDARD, 1u, true);

shared uint groupCovered;
shared uint groupLayers;
shared uint groupCut;
shared uint groupDropped;

bool isBehind(uvec2 a, uvec2 b) { return a.x > b.x || (a.x == b.x && a.y > b.y); }

// Blends the list over the picture. Returns its length.
uint resolve(ivec2 pixel) {
  uint index = imageLoad(heads, pixel).x;
  if (index == VITRAIL_END) return 0u;
  uvec2 list[INSERTION_LAYERS]; // of each fragment, the words of the key that the standard format uses
  uint layers = 0u;
  uint bound = min(control.taken, uint(nodes.length()));
  while (index < bound && layers < bound) {
    InsertionNode node = nodes[index];
    if (layers < INSERTION_LAYERS) list[layers] = vitrailKey(uvec4(node.color, node.depth, 0u, 0u), kNodes).xy;
    index = node.next;
    ++layers;
  }
  uint kept = min(layers, INSERTION_LAYERS);
  for (uint i = 1u; i < kept; ++i) {
    uvec2 moving = list[i];
    uint hole = i;
    while (hole > 0u && isBehind(list[hole - 1u], moving)) {
      list[hole] = list[hole - 1u];
      --hole;
    }
    list[hole] = moving;
  }
  vec3 color = vec3(0.0);
  vec4 transmittance = vec4(1.0);
  for (uint i = 0u; i < kept; ++i) {
    VitrailPair pair = vitrailPairOf(uvec4(list[i], 0u, 0u), kNodes);
    color += transmittance.rgb * pair.color;
    transmittance *= pair.transmittance;
  }
  vec4 behind = imageLoad(colorImage, pixel);
  imageStore(colorImage, pixel, vec4(color, 1.0 - transmittance.a) + transmittance * behind);
  return layers;
}

void countInGroup(uint layers) {
  if (layers == 0u) return;
  atomicAdd(groupCovered, 1u);
  atomicMax(groupLayers, layers);
  if (layers <= INSERTION_LAYERS) return;
  atomicAdd(groupCut, 1u);
  atomicAdd(groupDropped, layers - INSERTION_LAYERS);
}

void main() {
  bool first = gl_LocalInvocationIndex == 0u;
  if (first) groupCovered = groupLayers = groupCut = groupDropped = 0u;
  barrier();
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (all(lessThan(pixel, imageSize(colorImage)))) countInGroup(resolve(pixel));
  barrier();
  if (!first || groupCovered == 0u) return;
  uint slot = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) % COUNT_SLOTS;
  atomicAdd(control.counts[slot].coveredPixels, groupCovered);
  atomicMax(control.counts[slot].layersMax, groupLayers);
  if (groupCut == 0u) return;
  atomicAdd(control.counts[slot].cutPixels, groupCut);
  atomicAdd(control.counts[slot].fragments, groupDropped);
}
