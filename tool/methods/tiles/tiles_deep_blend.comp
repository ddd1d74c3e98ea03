// Blends the sorted fragments of deep tiles, a work group a tile and a thread a pixel, as many as a dispatch may take.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#include "blending.glsl"
#include "batch.glsl"
#include "tiles_deep.glsl"

layout(local_size_x = TILES_PIXELS) in;

// What of a pixel is left for the next dispatch.
struct PixelState {
  vec3 color;
  uint at; // the next fragment
  vec4 transmittance;
};
layout(set = 3, binding = 16, std430) buffer StateBlock { PixelState states[]; }; // of each sample

layout(push_constant) uniform SliceBlock {
  uint slice;
  uint inSorted; // where the fragments are
  uint last;     // whether this is the last dispatch
};

uint alikeFirst; // of the surfaces that are blended

uvec2 fragmentAt(uint i) { return inSorted != 0u ? sortedFragments[i] : fragments[i]; }
uint alikeRecord(uint i) { return fragmentAt(alikeFirst + i).y; }
Surface alikeSurface(uint i, ivec2 pixel) {
  uvec2 source = records[2u * alikeRecord(i)].zw;
  return shadeFragment(source, drawOfInstance[2u * source.y], pixel, vec2(tiles.width, tiles.height));
}

void main() {
  thread = gl_LocalInvocationIndex;
  uint deep = flatGroup();
  if (deep >= min(control.deep.count, tiles.deepCapacity)) return;
  uint number = deep * TILES_PIXELS + thread;
  uvec4 collected = deepPixels[number];
  ivec2 pixel = firstPixel(deepTiles[deep].x) + ivec2(thread & 7u, thread >> 3);
  if (collected.x == 0u || collected.y == NO_PLACE || !isInside(pixel)) return;
  PixelLight light = lightBehind(pixel);
  uint at = 0u;
#define LOAD_STATE(i) \
  if (i < kSamples) { \
    PixelState state = states[number * kSamples + i]; \
    light.fronts[i] = VitrailPair(state.color, state.transmittance); \
    at = state.at; \
  }
  if (slice > 0u) {
    EACH_SAMPLE(LOAD_STATE)
  }
  uint until = min(collected.x, at + TILES_SLICE);
  while (at < until) {
    alikeFirst = collected.y + at;
    uint key = fragmentAt(alikeFirst).x;
    if (key == NO_FRAGMENT) { // hidden, as all behind it
      at = collected.x;
      break;
    }
    uint alike = 1u;
    if (at == 0u || fragmentAt(alikeFirst - 1u).x != key) { // else they are more than TILES_TIES, which come one by one
      while (alike <= TILES_TIES && at + alike < collected.x && fragmentAt(alikeFirst + alike).x == key) ++alike;
      if (alike > TILES_TIES) alike = 1u;
    }
    blendAlike(light, pixel, thread, alike);
    at += alike;
    if (hasEnough(light)) at = collected.x;
  }
  if (at < until) atomicAdd(control.cutPixels, 1u); // the driver has ended the loop
  if (last != 0u) {
    blendOver(pixel, light);
  } else {
#define STORE_STATE(i) \
    if (i < kSamples) \
      states[number * kSamples + i] = PixelState(light.fronts[i].color, at, light.fronts[i].transmittance);
    EACH_SAMPLE(STORE_STATE)
  }
}
