// What every shader of the library binds of a target, and how it is specialized. With VITRAIL_NETWORKS set to 1 it
// sorts as suits a GPU, with 0 as suits a CPU (vitrail/sort.glsl). The set is the one that collecting shaders bind
// (vitrail/collect.glsl), with the lists of deep pixels beside it.
#ifndef VITRAIL_TARGET_GLSL
#define VITRAIL_TARGET_GLSL

#ifdef VITRAIL_BUFFER_REFERENCE
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#endif

#include "vitrail/bindings.h"
#include "vitrail/layout.h"

layout(constant_id = 0) const uint kFormat = VITRAIL_FORMAT_STANDARD;
layout(constant_id = 1) const uint kSamples = 1u;
layout(constant_id = 2) const bool kNearestIsOne = false;
layout(constant_id = 3) const uint kMaxLayers = 0u;
layout(constant_id = 4) const bool kTestDepth = false; // coverage has not passed the depth test
layout(constant_id = 5) const uint kGroup = 4u;        // resolve_group.comp: invocations that share a list, 4 or 8

// Lists need no sorting where only their nearest fragments are kept.
const bool kCapped = kMaxLayers != 0u && kMaxLayers <= VITRAIL_SHORT_LIST;

layout(set = 0, binding = VITRAIL_BINDING_PARAMETERS, std140) uniform ParametersBlock { VitrailParameters parameters; };
layout(set = 0, binding = VITRAIL_BINDING_CONTROL, std430) buffer ControlBlock { VitrailControl control; };
layout(set = 0, binding = VITRAIL_BINDING_HEADS, std430) buffer HeadsBlock { uint heads[]; };
layout(set = 0, binding = VITRAIL_BINDING_SUMS, std430) buffer SumsBlock { uint pixelSums[]; };

uint vitrailPoolCapacity() { return parameters.capacity; }
#ifdef VITRAIL_BUFFER_REFERENCE
uvec2 vitrailPoolAddress() { return uvec2(parameters.nodesLow, parameters.nodesHigh); }
#endif
#define VITRAIL_POOL_SET 0
#include "vitrail/pool.glsl"

VitrailLayout vitrailNodes() { return VitrailLayout(kFormat, kSamples, kNearestIsOne); }
uint vitrailMaxLayers() { return kMaxLayers; }

// The most fragments of a pixel. Atomics on one word wait for each other; most pixels are not deeper and need none. One
// that sees an earlier maximum makes one atomic too many.
void countLayers(uint layers) {
  if (layers > control.layersMax) atomicMax(control.layersMax, layers);
}

uint nodesInUse() { return min(control.requested, parameters.capacity); }
bool overflowed() {
  return control.requested > parameters.capacity || (control.misfits | control.misfitNodes) != 0u;
}

#endif
