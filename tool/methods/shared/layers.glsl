// Transparent surfaces of methods that keep the nearest fragments of a pixel and sum up those beyond: a fragment as an
// entry, and the tail of sums. Included by the fragment shaders of loop, loop-64 and interlock, each of which stores
// entries in its own way. The two words of an entry, colour and order, order as one number with the order on top, whose
// bits lie in a buffer as a 64-bit integer's do.
#ifndef VITRAIL_TOOL_LAYERS_GLSL
#define VITRAIL_TOOL_LAYERS_GLSL

#include "vitrail/sums.glsl"

#include "layers_shared.h"
#include "stage/surface.glsl"

layout(early_fragment_tests) in;

layout(constant_id = 1) const uint kLayers = 8u;

layout(push_constant) uniform Extent {
  uint width;
  uint height;
};

layout(set = 2, binding = 2, std430) buffer TailsBlock { uint tails[]; };

const VitrailLayout kNodes = VitrailLayout(VITRAIL_FORMAT_STANDARD, 1u, true);

uint pixelCount() { return width * height; }
uint pixelIndex() { return uint(gl_FragCoord.y) * width + uint(gl_FragCoord.x); }

// Where the entries of a layer are: those of neighbouring pixels lie together.
uint entryIndex(uint layer) { return layer * pixelCount() + pixelIndex(); }

// A surface has one fragment, or two that are the reflection and the filter.
uint mostEntries() { return has(FEATURE_TRANSMISSION) ? 2u : 1u; }

// The fragments of a surface, colour in x and order in y; empty ones would change nothing.
uvec2[2] entriesOf(Surface surface) {
  vec4 colors[2] = {vec4(surface.color, surface.alpha), vec4(0.0)};
  uint blends[2] = {has(FEATURE_ADDITIVE) ? VITRAIL_ADDITIVE : VITRAIL_OVER, VITRAIL_MULTIPLY};
  if (has(FEATURE_TRANSMISSION)) {
    colors[0] = reflectionOf(surface);
    colors[1] = filterOf(surface);
    blends[0] = VITRAIL_PREMULTIPLIED;
  }
  uvec2 entries[2] = {uvec2(LAYERS_EMPTY), uvec2(LAYERS_EMPTY)};
  for (uint i = 0u; i < mostEntries(); ++i) {
    uvec4 node;
    if (vitrailPack(colors[i], blends[i], gl_FragCoord.z, 1u, kNodes, node)) entries[i] = vitrailKey(node, kNodes).yx;
  }
  return entries;
}

void addToTail(uvec2 entry) {
  VitrailSums sums = vitrailMergeFilters(vitrailSumsOf(uvec4(entry.yx, 0u, 0u), kNodes, 1.0));
  uint words[LAYERS_TAIL_WORDS] = {sums.color.r, sums.color.g, sums.color.b, sums.opacity, sums.density, 1u};
  for (uint i = 0u; i < LAYERS_TAIL_WORDS; ++i) atomicAdd(tails[i * pixelCount() + pixelIndex()], words[i]);
}

#endif
