// A resolve of the tool's own, in place of the library's, for two kinds of pictures: without the nearest surfaces of
// each pixel, and with all of them blended in the order in which they arrived, whatever their depths. One thread a
// pixel walks its list (vitrail/list.glsl).
//
// RESOLVE_SAMPLES is the number of samples a pixel has at most, 1 or 8; RESOLVE_DEPTH is defined where coverage has not
// passed the depth test.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define VITRAIL_SET 0
#define VITRAIL_SORTED_LISTS
#include "vitrail/list.glsl"

#include "gpu/pixel_pass_shared.h"

#ifndef RESOLVE_SAMPLES
#define RESOLVE_SAMPLES 1
#endif

layout(local_size_x = PIXEL_GROUP_SIDE, local_size_y = PIXEL_GROUP_SIDE) in;

layout(constant_id = 0) const uint kSamples = 1u;
layout(constant_id = 1) const bool kSorted = true; // else as they arrived

layout(set = 1, binding = 0, rgba16f) uniform image2D colorImage;
#if RESOLVE_SAMPLES > 1
layout(set = 1, binding = 1) uniform texture2DMS opaqueImage;
#endif
#ifdef RESOLVE_DEPTH
layout(set = 1, binding = 2) uniform texture2DMS depthImage;
#endif
layout(push_constant) uniform PlainResolve {
  uint peeled;    // surfaces of each sample that are left out, the nearest
  uint showsLess; // 1: a picture that lacks fragments is drawn without them; 0: it is drawn again, and not now
};

// ---- In the order of arrival: a node's index is its fragment's number.

struct Arrivals {
  VitrailEntry batch[16]; // the next, the last that came first
  uint left;
  uint last; // the index that was handed over last
  bool more;
};

void fillArrivals(VitrailList list, inout Arrivals arrivals) {
  arrivals.batch = VitrailEntry[16](VITRAIL_LAST_16);
  uint index = list.head;
  uint count = 0u;
  uint found = 0u;
  while (max(index, count) < list.nodeCount) {
    uint next = vitrailLoadNext(index, list.nodes) & vitrailNextMask(list.nodes);
    if (next == index) break; // no node: idle lanes of CPU drivers read zeros
    if (index < arrivals.last) {
      vitrailInsert(arrivals.batch, VitrailEntry(uvec4(~index, 0u, 0u, 0u), index, 0u));
      ++found;
    }
    index = next;
    ++count;
  }
  bool cut = max(index, count) < list.nodeCount;
  arrivals.left = cut ? 0u : min(found, 16u);
  arrivals.more = cut || found > 16u;
}

bool nextArrival(VitrailList list, inout Arrivals arrivals, out VitrailLayer layer) {
  if (arrivals.left == 0u && arrivals.more && list.nodeCount > 0u) fillArrivals(list, arrivals);
  if (arrivals.left == 0u) {
    layer = vitrailLayerOf(uvec4(0u), 0u, list.nodes);
    return false;
  }
  uint index = arrivals.batch[0].index;
  layer = vitrailLayerOf(vitrailKey(vitrailLoadNode(index, list.nodes), list.nodes), 0u, list.nodes);
  arrivals.last = index;
  vitrailShift(arrivals.batch);
  --arrivals.left;
  return true;
}

// ---- Blending

// What is in front of the light behind a sample.
struct Front {
  vec3 color;
  vec4 transmittance; // w: of the picture's alpha
  uint met;           // surfaces
};

uint samplesOf(VitrailLayer layer, VitrailList list, ivec2 pixel) {
  uint samples = layer.coverage;
#ifdef RESOLVE_DEPTH
  for (int s = 0; s < RESOLVE_SAMPLES; ++s) {
    if (s >= int(kSamples)) break;
    uint behind = vitrailDepthOrder(texelFetch(depthImage, pixel, s).r, list.nodes);
    if (vitrailDepthOrder(layer.depth, list.nodes) > behind) samples &= ~(1u << s);
  }
#endif
  return samples;
}

// The second half of a surface that the fragment before it begins: what passes through it.
bool isFilterOf(VitrailLayer layer, VitrailLayer before) {
  return layer.blend == VITRAIL_MULTIPLY && before.blend == VITRAIL_PREMULTIPLIED && layer.depth == before.depth &&
         layer.coverage == before.coverage;
}

void put(inout Front front, VitrailLayer layer, bool isFilter) {
  if (!isFilter) ++front.met;
  if (front.met <= peeled) return;
  VitrailPair pair = vitrailPairOf(layer);
  front.color += front.transmittance.rgb * pair.color;
  front.transmittance *= pair.transmittance;
}

vec4 over(Front front, vec4 behind) {
  return vec4(front.color, 1.0 - front.transmittance.a) + front.transmittance * behind;
}

void resolve(ivec2 pixel) {
  VitrailList list = vitrailOpenList(pixel);
  bool isEmpty = list.head >= list.nodeCount;
  if (RESOLVE_SAMPLES == 1 && isEmpty) return;
  Arrivals arrivals = Arrivals(VitrailEntry[16](VITRAIL_LAST_16), 0u, 0xffffffffu, !isEmpty);
  Front fronts[RESOLVE_SAMPLES];
  for (int s = 0; s < RESOLVE_SAMPLES; ++s) fronts[s] = Front(vec3(0.0), vec4(1.0), 0u);
  VitrailLayer layer;
  VitrailLayer before = VitrailLayer(vec4(0.0), 0.0, VITRAIL_OVER, 0u, 0u);
  while (kSorted ? vitrailNextLayer(list, layer) : nextArrival(list, arrivals, layer)) {
    uint samples = samplesOf(layer, list, pixel);
    bool isFilter = isFilterOf(layer, before);
    for (int s = 0; s < RESOLVE_SAMPLES; ++s) {
      if (s < int(kSamples) && (samples & (1u << s)) != 0u) put(fronts[s], layer, isFilter);
    }
    before = layer;
  }
  if (kSorted ? vitrailListWasCut(list) : arrivals.left > 0u || arrivals.more) atomicAdd(vitrailControl.cutPixels, 1u);
#if RESOLVE_SAMPLES == 1
  imageStore(colorImage, pixel, over(fronts[0], imageLoad(colorImage, pixel)));
#else
  vec4 sum = vec4(0.0);
  for (int s = 0; s < RESOLVE_SAMPLES; ++s) {
    if (s < int(kSamples)) sum += over(fronts[s], texelFetch(opaqueImage, pixel, s));
  }
  imageStore(colorImage, pixel, sum / float(kSamples));
#endif
}

void main() {
  if (vitrailListsLackFragments() && showsLess == 0u) return;
  uvec2 local = gl_GlobalInvocationID.xy;
  if (local.x >= vitrailParameters.width || local.y >= vitrailParameters.height) return;
  resolve(ivec2(local + uvec2(vitrailParameters.x, vitrailParameters.y)));
}
