// The first dispatch of the compute resolve of a single-sample target: one thread a pixel. Short lists are done here,
// long ones are written down for the second dispatch.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "resolve_bindings.glsl"
#include "vitrail/resolve.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

shared uint groupLayersMax;
shared uint groupCovered;

// Leaves a pixel to the second dispatch, and makes that large enough.
void leaveForLater(uint pixelIndex) {
  uint slot = atomicAdd(control.longLists, 1u);
  if (slot >= uint(longPixels.length())) { // more long lists than the pool's nodes can make: they are corrupt
    atomicAdd(control.cutPixels, 1u);
    return;
  }
  longPixels[slot] = pixelIndex;
  if (slot % LONG_GROUP_SIZE != 0u) return;
  uint group = slot / LONG_GROUP_SIZE;
  atomicMax(control.groupsX, min(group + 1u, GROUPS_IN_ROW));
  atomicMax(control.groupsY, group / GROUPS_IN_ROW + 1u);
  atomicMax(control.groupsZ, 1u);
}

void main() {
  if (gl_LocalInvocationIndex == 0u) {
    groupLayersMax = 0u;
    groupCovered = 0u;
  }
  barrier();

  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (pixel.x < parameters.width && pixel.y < parameters.height) {
    uint pixelIndex = pixel.y * parameters.width + pixel.x;
    uint head = heads[pixelIndex];
    if (head != VITRAIL_END) {
      VitrailResolved r = vitrailResolveShort(head, nodesInUse(), parameters.nearestIsOne != 0u);
      if (r.complete) {
        blendOver(pixel, r.color, r.transmittance);
      } else {
        leaveForLater(pixelIndex);
      }
      atomicMax(groupLayersMax, r.layers);
      atomicAdd(groupCovered, 1u);
    }
  }

  barrier();
  if (gl_LocalInvocationIndex == 0u && groupCovered > 0u) {
    atomicMax(control.layersMax, groupLayersMax);
    atomicAdd(control.coveredPixels, groupCovered);
  }
}
