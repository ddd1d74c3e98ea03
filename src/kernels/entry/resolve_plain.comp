// The compute resolve of a frame without a fragment where there are several samples a pixel: their average. Dispatched
// indirectly, by no work groups where the frame has fragments.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "sink/picture.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  uvec2 local = gl_GlobalInvocationID.xy;
  if (isInArea(local)) {
    writePixel(uvec2(vitrailParameters.x, vitrailParameters.y) + local, vitrailBegin());
  }
}
