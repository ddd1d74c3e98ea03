// The arguments of the indirect commands that follow the collecting: what a frame does not need is not run.
#ifndef VITRAIL_ARGUMENTS_GLSL
#define VITRAIL_ARGUMENTS_GLSL

#include "target.glsl"

// By one invocation, once all fragments have been collected.
void writeArguments() {
  bool any = (control.requested | control.wraps | control.misfits) != 0u;
  uvec2 groups = (uvec2(parameters.width, parameters.height) + 7u) / 8u; // of 8 by 8 pixels
  if (any) {
    control.pixelGroupsX = groups.x;
    control.pixelGroupsY = groups.y;
    control.pixelGroupsZ = 1u;
    control.drawVertices = 3u;
    control.drawInstances = 1u;
  } else if (kSamples > 1u) {
    control.plainGroupsX = groups.x;
    control.plainGroupsY = groups.y;
    control.plainGroupsZ = 1u;
    control.plainVertices = 3u;
    control.plainInstances = 1u;
  }
  if (overflowed() && parameters.keepSums != 0u) {
    control.overflowGroupsX = groups.x;
    control.overflowGroupsY = groups.y;
    control.overflowGroupsZ = 1u;
  }
}

#endif
