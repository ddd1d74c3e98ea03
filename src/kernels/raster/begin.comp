// Begins a band: sets what its passes count to zero, and gives them the frame's data.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/frame.glsl"

layout(local_size_x = VITRAIL_RASTER_TABLE) in;

layout(push_constant) uniform BeginBlock {
  uvec4 frameWords[VITRAIL_RASTER_FRAME_WORDS / 4u]; // of VitrailRasterFrame
  uint isFirst;                                      // of the frame's bands
};

layout(VITRAIL_RASTER_BOUND(17), std430) buffer VitrailTileClassBlock { uvec4 classes[VITRAIL_RASTER_CLASSES + 2u]; };
layout(VITRAIL_RASTER_BOUND(2), std430) writeonly buffer TileWordBlock { uvec4 tileWords[]; };
// Totals, and from 256 bytes on the frame's data: vulkan/raster.h.
layout(VITRAIL_RASTER_BOUND(30), std430) buffer TotalBlock { uvec4 totals[]; };

void main() {
  uint thread = gl_GlobalInvocationID.x;
  uint tiles = frameWords[0].z * frameWords[0].w;
  const uint step = gl_NumWorkGroups.x * VITRAIL_RASTER_TABLE;
  for (uint i = thread; i < tiles * (VITRAIL_RASTER_TILE_WORDS / 4u); i += step) tileWords[i] = uvec4(0u);
  if (thread < 16u && isFirst != 0u) totals[thread] = uvec4(0u);
  if (thread < VITRAIL_RASTER_FRAME_WORDS / 4u) totals[16u + thread] = frameWords[thread];
  // Of medium triangles only the number of work groups is not known yet.
  bool isMedium = thread == VITRAIL_RASTER_CLASSES;
  if (thread < VITRAIL_RASTER_CLASSES + 2u) classes[thread] = isMedium ? uvec4(0u, 1u, 1u, 0u) : uvec4(0u);
  if (thread > 0u) return;
  const VitrailRasterDispatch none = VitrailRasterDispatch(0u, 0u, 0u, 0u);
  // The places of all first pages; or where they are counted one that no tile has.
  const uint first = frameWords[1].z == VITRAIL_RASTER_COUNTED ? 1u : tiles << frameWords[1].z;
  vitrailRasterControl = VitrailRasterControl(none, none, none, first, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
}
