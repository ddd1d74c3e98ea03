// Several samples a pixel (VITRAIL_MULTISAMPLED, VITRAIL_RASTER_SAMPLES): where they are. A surface is shaded and
// sorted once, at the middle of the pixel, for all the samples that it covers.
#ifndef VITRAIL_RASTER_SAMPLES_GLSL
#define VITRAIL_RASTER_SAMPLES_GLSL

#include "frame.glsl"

const uint VITRAIL_RASTER_MOST_SAMPLES = 8u;

// In sixteenths of a pixel from its upper left corner: Vulkan's standard sample locations.
ivec2 vitrailSamplePlace(uint i) {
  if (VITRAIL_RASTER_SAMPLES == 2u) return i == 0u ? ivec2(12) : ivec2(4);
  if (VITRAIL_RASTER_SAMPLES == 4u) {
    return i == 0u ? ivec2(6, 2) : i == 1u ? ivec2(14, 6) : i == 2u ? ivec2(2, 10) : ivec2(10, 14);
  }
  if (VITRAIL_RASTER_SAMPLES == 8u) {
    const ivec2 places[8] = ivec2[](ivec2(9, 5), ivec2(7, 11), ivec2(13, 9), ivec2(5, 3), ivec2(3, 13), ivec2(1, 7),
                                    ivec2(11, 15), ivec2(15, 1));
    return places[i];
  }
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
// Keeps the pixels whose samples a record covers: of each sample the tile's upper and lower half.
void vitrailKeepSamples(uint record, uvec2 m[VITRAIL_RASTER_MOST_SAMPLES]) {
  uint at = record * (VITRAIL_RASTER_SAMPLES / 2u);
  if (VITRAIL_RASTER_SAMPLES == 2u) vitrailSampleMasks[at] = uvec4(m[0].x, m[1].x, m[0].y, m[1].y);
  if (VITRAIL_RASTER_SAMPLES == 4u) {
    vitrailSampleMasks[at] = uvec4(m[0].x, m[1].x, m[2].x, m[3].x);
    vitrailSampleMasks[at + 1u] = uvec4(m[0].y, m[1].y, m[2].y, m[3].y);
  }
  if (VITRAIL_RASTER_SAMPLES == 8u) {
    vitrailSampleMasks[at] = uvec4(m[0].x, m[1].x, m[2].x, m[3].x);
    vitrailSampleMasks[at + 1u] = uvec4(m[4].x, m[5].x, m[6].x, m[7].x);
    vitrailSampleMasks[at + 2u] = uvec4(m[0].y, m[1].y, m[2].y, m[3].y);
    vitrailSampleMasks[at + 3u] = uvec4(m[4].y, m[5].y, m[6].y, m[7].y);
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
