// The arguments of the indirect commands that follow the collecting: what a frame does not need is not run.
#ifndef VITRAIL_ARGUMENTS_GLSL
#define VITRAIL_ARGUMENTS_GLSL

#include "target.glsl"

// By one invocation, once all fragments have been collected.
void writeArguments() {
  bool any = (vitrailControl.requested | vitrailControl.wraps | vitrailControl.misfits) != 0u;
  vitrailControl.collected = vitrailControl.requested;
  uvec2 groups = (uvec2(vitrailParameters.width, vitrailParameters.height) + 7u) / 8u; // of 8 by 8 pixels
  if (any) {
    vitrailControl.pixelGroupsX = groups.x;
    vitrailControl.pixelGroupsY = groups.y;
    vitrailControl.pixelGroupsZ = 1u;
    vitrailControl.drawVertices = 3u;
    vitrailControl.drawInstances = 1u;
  } else if (kSamples > 1u) {
    vitrailControl.plainGroupsX = groups.x;
    vitrailControl.plainGroupsY = groups.y;
    vitrailControl.plainGroupsZ = 1u;
    vitrailControl.plainVertices = 3u;
    vitrailControl.plainInstances = 1u;
  }
  if (overflowed() && vitrailParameters.keepSums != 0u) {
    vitrailControl.overflowGroupsX = groups.x;
    vitrailControl.overflowGroupsY = groups.y;
    vitrailControl.overflowGroupsZ = 1u;
  }
}

#endif
