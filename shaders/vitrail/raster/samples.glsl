// Several samples a pixel (VITRAIL_MULTISAMPLED, VITRAIL_RASTER_SAMPLES): where they are. A surface is shaded and
// sorted once, at the middle of the pixel, for all the samples that it covers.
#ifndef VITRAIL_RASTER_SAMPLES_GLSL
#define VITRAIL_RASTER_SAMPLES_GLSL

#include "frame.glsl"

const uint VITRAIL_RASTER_MOST_SAMPLES = 8u;

// In sixteenths of a pixel from its upper left corner: Vulkan's standard sample locations, four bits a number, as
// arrays with an index that varies lie in memory.
ivec2 vitrailSamplePlace(uint i) {
  if (VITRAIL_RASTER_SAMPLES == 2u) return ivec2(uvec2(0x4cu) >> 4u * i & 15u);
  if (VITRAIL_RASTER_SAMPLES == 4u) return ivec2(uvec2(0xa2e6u, 0xea62u) >> 4u * i & 15u);
  if (VITRAIL_RASTER_SAMPLES == 8u) return ivec2(uvec2(0xfb135d79u, 0x1f7d39b5u) >> 4u * i & 15u);
  return ivec2(8);
}

// Spelled out: arrays stay in registers where their indices are constants, which those of loops are not for all
// drivers.
#ifdef VITRAIL_MULTISAMPLED
#define VITRAIL_RASTER_SAMPLES_KEPT 8 // VITRAIL_RASTER_MOST_SAMPLES
#define VITRAIL_EACH_SAMPLE(what) what(0) what(1) what(2) what(3) what(4) what(5) what(6) what(7)
#else
#define VITRAIL_RASTER_SAMPLES_KEPT 1
#define VITRAIL_EACH_SAMPLE(what) what(0)
#endif

#ifdef VITRAIL_MULTISAMPLED
#ifdef VITRAIL_MAKES_RECORDS
// Turns four words: bit 4 i + j of word k is bit 4 i + k of word j then.
void vitrailTurnFour(inout uvec4 words) {
  uvec2 other = (words.xy >> 2 ^ words.zw) & 0x33333333u;
  words.zw ^= other;
  words.xy ^= other << 2;
  other = (words.xz >> 1 ^ words.yw) & 0x55555555u;
  words.yw ^= other;
  words.xz ^= other << 1;
}

// The same of eight.
void vitrailTurnEight(inout uvec4 first, inout uvec4 last) {
  uvec4 other = (first >> 4 ^ last) & 0x0f0f0f0fu;
  last ^= other;
  first ^= other << 4;
  vitrailTurnFour(first);
  vitrailTurnFour(last);
}

bool vitrailHasPixels(uvec4 masks) { return (masks.x | masks.y | masks.z | masks.w) != 0u; }

// Keeps the samples that a record covers, those of a pixel side by side. They are given as the pixels of each sample in
// the tile's upper and in its lower half: of the last four samples, or two, and of four before. Nobody asks for pixels
// that no sample covers: a half of these is not written.
void vitrailKeepSamples(uint record, uvec4 upperBefore, uvec4 upper, uvec4 lowerBefore, uvec4 lower) {
  uint at = record * (VITRAIL_RASTER_SAMPLES / 2u);
  if (VITRAIL_RASTER_SAMPLES == 2u) {
    uvec2 first = uvec2(upper.z, lower.z);
    uvec2 last = uvec2(upper.w, lower.w);
    uvec2 other = (first >> 1 ^ last) & 0x55555555u;
    last ^= other;
    first ^= other << 1;
    vitrailSampleMasks[at] = uvec4(first.x, last.x, first.y, last.y);
  } else if (VITRAIL_RASTER_SAMPLES == 4u) {
    if (vitrailHasPixels(upper)) {
      vitrailTurnFour(upper);
      vitrailSampleMasks[at] = upper;
    }
    if (vitrailHasPixels(lower)) {
      vitrailTurnFour(lower);
      vitrailSampleMasks[at + 1u] = lower;
    }
  } else {
    if (vitrailHasPixels(upperBefore | upper)) {
      vitrailTurnEight(upperBefore, upper);
      vitrailSampleMasks[at] = upperBefore;
      vitrailSampleMasks[at + 1u] = upper;
    }
    if (vitrailHasPixels(lowerBefore | lower)) {
      vitrailTurnEight(lowerBefore, lower);
      vitrailSampleMasks[at + 2u] = lowerBefore;
      vitrailSampleMasks[at + 3u] = lower;
    }
  }
}

// The same, given as the pixels of each sample.
void vitrailKeepSamples(uint record, uvec2 samples[VITRAIL_RASTER_SAMPLES_KEPT]) {
  uvec4 upper = uvec4(samples[0].x, samples[1].x, samples[2].x, samples[3].x);
  uvec4 lower = uvec4(samples[0].y, samples[1].y, samples[2].y, samples[3].y);
  if (VITRAIL_RASTER_SAMPLES == 8u) {
    vitrailKeepSamples(record, upper, uvec4(samples[4].x, samples[5].x, samples[6].x, samples[7].x), lower,
                       uvec4(samples[4].y, samples[5].y, samples[6].y, samples[7].y));
  } else if (VITRAIL_RASTER_SAMPLES == 4u) {
    vitrailKeepSamples(record, uvec4(0u), upper, uvec4(0u), lower);
  } else {
    vitrailKeepSamples(record, uvec4(0u), upper.zwxy, uvec4(0u), lower.zwxy);
  }
}

#endif

// The samples of a pixel of its tile that a record covers, a bit each.
uint vitrailCoveredSamples(uint record, uint pixel) {
  const uint last = VITRAIL_RASTER_SAMPLES - 1u;
  uint word = record * (2u * VITRAIL_RASTER_SAMPLES) + (pixel >> 5) * VITRAIL_RASTER_SAMPLES + (pixel & last);
  return vitrailSampleWords[word] >> (pixel & 31u & ~last) & ((1u << VITRAIL_RASTER_SAMPLES) - 1u);
}
#endif

#endif
