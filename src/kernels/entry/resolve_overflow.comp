// The compute resolve of a frame that overflowed, in place of the others: one thread a pixel, all fragments by their
// sums. Dispatched indirectly, by no work groups where the frame fits. For drivers that execute both sides of every
// branch; elsewhere resolve.comp does the same.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "group_counts.glsl"
#include "sink/picture.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  beginCounts();
  uvec2 local = gl_GlobalInvocationID.xy;
  if (isInArea(local)) {
    uint layers = writeSums(local);
    if (layers > 0u) countPixel(layers);
  }
  endCounts();
}
