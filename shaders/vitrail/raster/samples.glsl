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
#define VITRAIL_EACH_SAMPLE(what) what(0) what(1) what(2) what(3) what(4) what(5) what(6) what(7)
#else
#define VITRAIL_EACH_SAMPLE(what) what(0)
#endif

#ifdef VITRAIL_MULTISAMPLED
// Keeps the pixels of which a record covers samples: of each of four samples, or two, from `first` on the tile's upper
// and lower half.
void vitrailKeepSamples(uint record, uint first, uvec4 upper, uvec4 lower) {
  uint at = record * (VITRAIL_RASTER_SAMPLES / 2u);
  if (VITRAIL_RASTER_SAMPLES == 2u) {
    vitrailSampleMasks[at] = uvec4(upper.xy, lower.xy);
  } else {
    vitrailSampleMasks[at + first / 4u] = upper;
    vitrailSampleMasks[at + VITRAIL_RASTER_SAMPLES / 4u + first / 4u] = lower;
  }
}

// The samples of a pixel of its tile that a record covers, a bit each.
uint vitrailCoveredSamples(uint record, uint pixel) {
  uint lower = pixel >> 5;
  uint at = record * (VITRAIL_RASTER_SAMPLES / 2u);
  if (VITRAIL_RASTER_SAMPLES > 2u) at += lower * (VITRAIL_RASTER_SAMPLES / 4u);
  uvec4 words = vitrailSampleMasks[at];
  if (VITRAIL_RASTER_SAMPLES == 2u && lower != 0u) words.xy = words.zw;
  uvec4 bits = (words >> (pixel & 31u) & 1u) << uvec4(0u, 1u, 2u, 3u);
  uint covered = bits.x | bits.y;
  if (VITRAIL_RASTER_SAMPLES > 2u) covered |= bits.z | bits.w;
  if (VITRAIL_RASTER_SAMPLES == 8u) {
    bits = (vitrailSampleMasks[at + 1u] >> (pixel & 31u) & 1u) << uvec4(4u, 5u, 6u, 7u);
    covered |= bits.x | bits.y | bits.z | bits.w;
  }
  return covered;
}
#endif

#endif
