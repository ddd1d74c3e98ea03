#ifndef VITRAIL_TOOL_TILES_SOURCE_ORDER_GLSL
#define VITRAIL_TOOL_TILES_SOURCE_ORDER_GLSL

#include "geometry.glsl"
#include "tiles_frame.glsl"

// The order at one depth of more surfaces than their colours can decide: by where they are in the scene, whatever order
// they are drawn in.
bool sourceBefore(uint a, uint b) {
  uvec2 s = records[2u * a].zw;
  uvec2 t = records[2u * b].zw;
  uint sourceS = drawOfInstance[2u * s.y + 1u];
  uint sourceT = drawOfInstance[2u * t.y + 1u];
  if (sourceS != sourceT) return sourceS < sourceT;
  uint draw = drawOfInstance[2u * s.y]; // one source is of one draw
  uint corners = cornersOf(draws[draw].features);
  uint firstS = firstIndexOf(draw, corners, s.x & 0x7fffffffu);
  uint firstT = firstIndexOf(draw, corners, t.x & 0x7fffffffu);
  for (uint i = 0u; i < corners; ++i) {
    uint u = indices[firstS + i];
    uint v = indices[firstT + i];
    if (u != v) return u < v;
  }
  return false;
}

// The order of fragments away from the viewer.
bool fragmentBefore(uvec2 a, uvec2 b) {
  if (a.x != b.x) return a.x < b.x;
  return a.x != NO_FRAGMENT && sourceBefore(a.y, b.y);
}

#endif
