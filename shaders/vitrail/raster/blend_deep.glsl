// Blends the sorted fragments of deep tiles, a work group a tile and a thread a pixel, as many as a dispatch may take.
#ifndef VITRAIL_RASTER_BLEND_DEEP_GLSL
#define VITRAIL_RASTER_BLEND_DEEP_GLSL

#include "batch.glsl"
#include "deep.glsl"
#include "light.glsl"

layout(local_size_x = VITRAIL_RASTER_PIXELS) in;

// What of a pixel is left for the next dispatch.
struct VitrailPixelState {
  vec3 color;
  uint at; // the next fragment
  vec4 transmittance;
};
// Of each sample, with the colour of the pixel.
layout(VITRAIL_RASTER_BOUND(16), std430) buffer VitrailStateBlock { VitrailPixelState vitrailStates[]; };

layout(push_constant) uniform VitrailSliceBlock {
  uint vitrailSlice;
  uint vitrailInSorted; // where the fragments are
  uint vitrailLastSlice;     // whether this is the last dispatch
};

uint vitrailAlikeFirst; // of the surfaces that are blended

uvec2 vitrailFragmentAt(uint i) { return vitrailInSorted != 0u ? vitrailSortedFragments[i] : vitrailDeepFragments[i]; }
uint vitrailAlikeRecord(uint i) { return vitrailFragmentAt(vitrailAlikeFirst + i).y; }
VitrailSurface vitrailAlikeSurface(uint i, ivec2 pixel, bool alone) {
  return vitrailSurfaceOf(vitrailRecords[vitrailAlikeRecord(i)].zw, pixel);
}

void main() {
  vitrailThread = gl_LocalInvocationIndex;
  uint deep = vitrailFlatGroup();
  if (deep >= min(vitrailRasterControl.deep.count, vitrailRaster.deepCapacity)) return;
  uint number = deep * VITRAIL_RASTER_PIXELS + vitrailThread;
  uvec4 collected = vitrailDeepPixels[number];
  ivec2 pixel = vitrailFirstPixel(vitrailDeepTiles[deep].x) + ivec2(vitrailThread & 7u, vitrailThread >> 3);
  if (collected.y == VITRAIL_NO_PLACE || !vitrailIsInside(pixel)) return;
#ifndef VITRAIL_MULTISAMPLED
  if (collected.x == 0u) return;
#endif
  VitrailPixelLight light = vitrailLightBehind(pixel);
  uint at = 0u;
#define VITRAIL_LOAD_STATE(i) \
  if (i < VITRAIL_RASTER_SAMPLES) { \
    VitrailPixelState state = vitrailStates[number * VITRAIL_RASTER_SAMPLES + i]; \
    light.color = state.color; \
    light.through[i] = state.transmittance; \
    at = state.at; \
  }
  if (vitrailSlice > 0u) {
    VITRAIL_EACH_SAMPLE(VITRAIL_LOAD_STATE)
  }
  uint until = min(collected.x, at + VITRAIL_RASTER_SLICE);
  while (at < until) {
    vitrailAlikeFirst = collected.y + at;
    uint key = vitrailFragmentAt(vitrailAlikeFirst).x;
    if (key == VITRAIL_NO_FRAGMENT) { // hidden, as all behind it
      at = collected.x;
      break;
    }
    uint alike = 1u;
    // Else they are more than VITRAIL_RASTER_TIES, which come one by one.
    if (at == 0u || vitrailFragmentAt(vitrailAlikeFirst - 1u).x != key) {
      while (alike <= VITRAIL_RASTER_TIES && at + alike < collected.x &&
             vitrailFragmentAt(vitrailAlikeFirst + alike).x == key) {
        ++alike;
      }
      if (alike > VITRAIL_RASTER_TIES) alike = 1u;
    }
    vitrailBlendAlike(light, pixel, vitrailThread, alike);
    at += alike;
    if (vitrailHasEnough(light)) at = collected.x;
  }
  if (at < until) atomicAdd(vitrailRasterControl.cutPixels, 1u); // the driver has ended the loop
  if (vitrailLastSlice != 0u) {
    vitrailBlendOver(pixel, light);
  } else {
#define VITRAIL_STORE_STATE(i) \
    if (i < VITRAIL_RASTER_SAMPLES) \
      vitrailStates[number * VITRAIL_RASTER_SAMPLES + i] = \
          VitrailPixelState(light.color, at, light.through[i]);
    VITRAIL_EACH_SAMPLE(VITRAIL_STORE_STATE)
  }
}

#endif
