// The picture where there is nothing transparent: the mean of each pixel's samples, in tiles without records. A work
// group is a tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define VITRAIL_SET 0
#include "vitrail/raster/samples.glsl"
#include "vitrail/raster/frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(VITRAIL_RASTER_BOUND(9), VITRAIL_COLOR_FORMAT) uniform writeonly image2D pictureImage;
layout(VITRAIL_RASTER_BOUND(18)) uniform texture2DMS opaqueImage;

void main() {
  uint tile = gl_WorkGroupID.y * vitrailRaster.tilesX + gl_WorkGroupID.x;
  if (vitrailTiles[tile * VITRAIL_RASTER_TILE_WORDS] != 0u) return; // blended
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, vitrailRaster.top);
  if (pixel.x >= int(vitrailRaster.width) || pixel.y >= int(vitrailRaster.bottom)) return;
  vec4 sum = vec4(0.0);
  for (uint i = 0u; i < VITRAIL_RASTER_SAMPLES; ++i) sum += texelFetch(opaqueImage, pixel, int(i));
  imageStore(pictureImage, pixel, sum / float(VITRAIL_RASTER_SAMPLES));
}
