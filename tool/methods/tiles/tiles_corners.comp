// Brings each vertex of each instance into clip space, and its normal into the world, so that this is not done again
// for each triangle and each fragment.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TILES_MAKES_CORNERS
#include "geometry.glsl"
#include "tiles_frame.glsl"

layout(local_size_x = TILES_GROUP) in;

void main() {
  uint group = flatGroup();
  if (group >= drawOfCornerGroup.length()) return;
  uint draw = drawOfCornerGroup[group];
  uint vertices = draws[draw].vertices;
  uint number = (group - draws[draw].firstCornerGroup) * TILES_GROUP + gl_LocalInvocationIndex;
  if (number >= vertices * draws[draw].instances) return;
  uint instance = number < vertices ? 0u : number / vertices;
  uint vertex = number - instance * vertices;
  InstancePlace place = placeOf(draws[draw].firstInstance + instance);
  uint corner = draws[draw].firstCorner + number;
  cornerPlaces[corner] = clipOf(worldOf(place, positionOf(draw, vertex)));
  if ((draws[draw].features & (FEATURE_UNLIT | FEATURE_FLAT)) != 0u) return;
  cornerNormals[corner] = vec4(turnedNormal(turnOf(place), normalOf(draw, vertex)), 0.0);
}
