#ifndef VITRAIL_RASTER_ORDER_GLSL
#define VITRAIL_RASTER_ORDER_GLSL

#include "frame.glsl"

// The order at one depth of more surfaces than their colours can decide: by the orders that the host gives, or else by
// where their instances are among all.
uint vitrailOrderOf(uint draw, uint item) {
  return vitrailRaster.hasOrders != 0u ? vitrailOrders[vitrailInstance(draw, item)] : item;
}

bool vitrailSourceBefore(uint a, uint b) {
  uvec2 s = vitrailRecords[a].zw;
  uvec2 t = vitrailRecords[b].zw;
  uint draw = vitrailItems[s.y].z;
  uint orderS = vitrailOrderOf(draw, s.y);
  uint orderT = vitrailOrderOf(vitrailItems[t.y].z, t.y);
  if (orderS != orderT) return orderS < orderT;
  uint corners = vitrailCornersOf(vitrailFlagsOf(draw)); // of one order is one draw
  uint firstS = vitrailFirstIndex(draw, corners, s.x & 0x7fffffffu);
  uint firstT = vitrailFirstIndex(draw, corners, t.x & 0x7fffffffu);
  for (uint i = 0u; i < corners; ++i) {
    uint u = vitrailIndex(draw, firstS + i);
    uint v = vitrailIndex(draw, firstT + i);
    if (u != v) return u < v;
  }
  // Instances of one order, and triangles of the same corners, which shading may tell apart.
  uint instanceS = vitrailInstance(draw, s.y);
  uint instanceT = vitrailInstance(draw, t.y);
  if (instanceS != instanceT) return instanceS < instanceT;
  return (s.x & 0x7fffffffu) < (t.x & 0x7fffffffu);
}

// The order of fragments away from the viewer.
bool vitrailFragmentBefore(uvec2 a, uvec2 b) {
  if (a.x != b.x) return a.x < b.x;
  return a.x != VITRAIL_NO_FRAGMENT && vitrailSourceBefore(a.y, b.y);
}

#endif
