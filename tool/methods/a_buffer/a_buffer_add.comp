// Adds to the prefix sums of each work group's numbers the sum of all numbers before them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "a_buffer_shared.h"

layout(local_size_x = A_BUFFER_SCAN_GROUP) in;

layout(set = 0, binding = 0, std430) buffer OffsetsBlock { uint numbers[]; };

layout(push_constant) uniform ScanBlock { ABufferScan scan; };

void main() {
  uint group = gl_WorkGroupID.y * A_BUFFER_ROW + gl_WorkGroupID.x;
  uint i = group * 2u * A_BUFFER_SCAN_GROUP + gl_LocalInvocationIndex;
  for (uint end = i + 2u * A_BUFFER_SCAN_GROUP; i < min(end, scan.count); i += A_BUFFER_SCAN_GROUP) {
    numbers[scan.from + i] += numbers[scan.totals + group];
  }
}
