// Empties the lists of a frame's area, for backends whose buffers are filled slowly otherwise.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "target.glsl"

layout(local_size_x = 64) in;

void main() {
  uint pixels = vitrailParameters.width * vitrailParameters.height;
  uint step = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  for (uint i = gl_GlobalInvocationID.x; i < pixels; i += step) vitrailHeads[i] = VITRAIL_END;
}
