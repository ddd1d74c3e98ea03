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

#endif
