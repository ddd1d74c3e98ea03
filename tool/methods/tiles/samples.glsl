// Several samples a pixel (TILES_MSAA, kSamples): where they are, and which a triangle covers. A surface is shaded and
// sorted once, at the middle of the pixel, for all the samples that it covers.
#ifndef VITRAIL_TOOL_TILES_SAMPLES_GLSL
#define VITRAIL_TOOL_TILES_SAMPLES_GLSL

layout(constant_id = 6) const uint kSamples = 1u;

const uint TILES_MOST_SAMPLES = 8u;

// Of each record and sample the pixels whose sample the triangle covers, where there are several samples.
layout(set = 3, binding = 19, std430) buffer SampleBlock { uvec2 sampleMasks[]; };

// In sixteenths of a pixel from its upper left corner: Vulkan's standard sample locations.
ivec2 samplePlace(uint i) {
  if (kSamples == 2u) return i == 0u ? ivec2(12) : ivec2(4);
  if (kSamples == 4u) return i == 0u ? ivec2(6, 2) : i == 1u ? ivec2(14, 6) : i == 2u ? ivec2(2, 10) : ivec2(10, 14);
  if (kSamples == 8u) {
    const ivec2 places[8] = ivec2[](ivec2(9, 5), ivec2(7, 11), ivec2(13, 9), ivec2(5, 3), ivec2(3, 13), ivec2(1, 7),
                                    ivec2(11, 15), ivec2(15, 1));
    return places[i];
  }
  return ivec2(8);
}

#endif
