// After a fragment resolve that overflowed: cleans up the sums. Dispatched indirectly, by no work groups otherwise.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "missing.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  uvec2 local = gl_GlobalInvocationID.xy;
  if (isInArea(local)) clearMissing(pixelIndexOf(local));
}
