// The exclusive prefix sums of the numbers of each work group, in place, and their total: the work-efficient scan of
// Blelloch, "Prefix sums and their applications" (1990). Sums stop at the largest number.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "a_buffer_shared.h"

layout(local_size_x = A_BUFFER_SCAN_GROUP) in;

layout(set = 0, binding = 0, std430) buffer OffsetsBlock { uint numbers[]; };

layout(push_constant) uniform ScanBlock { ABufferScan scan; };

shared uint sums[2u * A_BUFFER_SCAN_GROUP];

uint load(uint i) { return i < scan.count ? numbers[scan.from + i] : 0u; }

uint add(uint a, uint b) { return a + min(b, 0xffffffffu - a); }

void main() {
  uint group = gl_WorkGroupID.y * A_BUFFER_ROW + gl_WorkGroupID.x;
  uint thread = gl_LocalInvocationIndex;
  uint first = group * 2u * A_BUFFER_SCAN_GROUP;
  sums[thread] = load(first + thread);
  sums[thread + A_BUFFER_SCAN_GROUP] = load(first + thread + A_BUFFER_SCAN_GROUP);
  uint pitch = 1u;
  for (uint threads = A_BUFFER_SCAN_GROUP; threads > 0u; threads /= 2u) { // sums of ever more numbers
    barrier();
    uint right = pitch * (2u * thread + 2u) - 1u;
    if (thread < threads) sums[right] = add(sums[right], sums[right - pitch]);
    pitch *= 2u;
  }
  barrier();
  if (thread == 0u) {
    if (first < scan.count) numbers[scan.totals + group] = sums[2u * A_BUFFER_SCAN_GROUP - 1u];
    sums[2u * A_BUFFER_SCAN_GROUP - 1u] = 0u;
  }
  for (uint threads = 1u; threads <= A_BUFFER_SCAN_GROUP; threads *= 2u) { // and down again
    pitch /= 2u;
    barrier();
    uint right = pitch * (2u * thread + 2u) - 1u;
    if (thread < threads) {
      uint left = sums[right - pitch];
      sums[right - pitch] = sums[right];
      sums[right] = add(sums[right], left);
    }
  }
  barrier();
  if (first + thread < scan.count) numbers[scan.from + first + thread] = sums[thread];
  uint second = first + thread + A_BUFFER_SCAN_GROUP;
  if (second < scan.count) numbers[scan.from + second] = sums[thread + A_BUFFER_SCAN_GROUP];
}
