// Empties the lists of a frame's area, for backends whose buffers are filled slowly otherwise.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "target.glsl"

layout(local_size_x = 64) in; // kGroupNodes of kernels.h

void main() {
  uint pixels = vitrailParameters.width * vitrailParameters.height;
  uint groups = min(pixels / gl_WorkGroupSize.x + 1u, 32768u); // as the kernel is dispatched (nodeGroups())
  uint threads = groups * gl_WorkGroupSize.x;
  for (uint i = gl_GlobalInvocationID.x; i < pixels; i += threads) vitrailHeads[i] = VITRAIL_END;
}
