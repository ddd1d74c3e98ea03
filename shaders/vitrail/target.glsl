// The parts of a target that shaders share, where its set binds them, and its pool. Before the include, define
//
//   VITRAIL_SET                the set of the target
//   VITRAIL_BUFFER_REFERENCE   to reach the pool by its address
#ifndef VITRAIL_TARGET_GLSL
#define VITRAIL_TARGET_GLSL

#ifdef VITRAIL_BUFFER_REFERENCE
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#endif

#include "bindings.h"
#include "layout.h"

#if !defined(VITRAIL_SET) && !defined(VITRAIL_OPENGL)
#error define VITRAIL_SET, the descriptor set number of vitrailVkTargetDescriptorSet() in your pipeline layout
#endif

layout(VITRAIL_BOUND(VITRAIL_SET, VITRAIL_BINDING_PARAMETERS), std140) uniform VitrailParametersBlock {
  VitrailParameters vitrailParameters;
};
layout(VITRAIL_BOUND(VITRAIL_SET, VITRAIL_BINDING_CONTROL), std430) buffer VitrailControlBlock {
  VitrailControl vitrailControl;
};
layout(VITRAIL_BOUND(VITRAIL_SET, VITRAIL_BINDING_HEADS), std430) buffer VitrailHeadsBlock { uint vitrailHeads[]; };

uint vitrailPoolCapacity() { return vitrailParameters.capacity; }
#ifdef VITRAIL_BUFFER_REFERENCE
uvec2 vitrailPoolAddress() { return uvec2(vitrailParameters.nodesLow, vitrailParameters.nodesHigh); }
#endif
#include "pool.glsl"

// Whether a shader that reaches the pool as this one does reaches all of it.
bool vitrailReachesPool() {
#ifdef VITRAIL_BUFFER_REFERENCE
  return vitrailParameters.wholeByAddress != 0u;
#else
  return vitrailParameters.wholeByBinding != 0u;
#endif
}

#endif
