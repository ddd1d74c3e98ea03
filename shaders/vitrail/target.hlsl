// target.glsl for HLSL: the parts of a target that shaders share, and its pool. A collecting shader writes them
// (RWByteAddressBuffer), one that only walks lists reads them (VITRAIL_READ_ONLY, which list.hlsl defines where it
// stands alone: ByteAddressBuffer). Before the include, define where they are bound, if not there:
//
//   VITRAIL_REGISTER_PARAMETERS   b13
//   VITRAIL_REGISTER_CONTROL      u1; VITRAIL_READ_ONLY: t120
//   VITRAIL_REGISTER_HEADS        u2; VITRAIL_READ_ONLY: t121
//   VITRAIL_REGISTER_NODES        u3; VITRAIL_READ_ONLY: t122
//   VITRAIL_REGISTER_SUMS         u4
//   VITRAIL_SPACE                 from shader model 5.1 on: their register space (space0)
//
// or, from shader model 6.6 on, VITRAIL_BINDLESS: they are taken from ResourceDescriptorHeap, at the indices that five
// root constants at VITRAIL_REGISTER_INDICES (b13) hold in the order above.
#ifndef VITRAIL_TARGET_HLSL
#define VITRAIL_TARGET_HLSL

#ifndef VITRAIL_HLSL
#define VITRAIL_HLSL
#endif
#include "layout.h"

#ifdef VITRAIL_SPACE
#define VITRAIL_AT(place) register(place, VITRAIL_SPACE)
#else
#define VITRAIL_AT(place) register(place)
#endif

#ifdef VITRAIL_READ_ONLY
#define VITRAIL_BUFFER ByteAddressBuffer
#else
#define VITRAIL_BUFFER RWByteAddressBuffer
#endif

#ifdef VITRAIL_BINDLESS
#ifndef VITRAIL_REGISTER_INDICES
#define VITRAIL_REGISTER_INDICES b13
#endif
struct VitrailIndices {
  uint parameters;
  uint control;
  uint heads;
  uint nodes;
  uint sums;
};
ConstantBuffer<VitrailIndices> vitrailIndices : VITRAIL_AT(VITRAIL_REGISTER_INDICES);
static const ConstantBuffer<VitrailParameters> vitrailParameters = ResourceDescriptorHeap[vitrailIndices.parameters];
static VITRAIL_BUFFER vitrailControl = ResourceDescriptorHeap[vitrailIndices.control];
static VITRAIL_BUFFER vitrailHeads = ResourceDescriptorHeap[vitrailIndices.heads];
static VITRAIL_BUFFER vitrailPool = ResourceDescriptorHeap[vitrailIndices.nodes];
#else
#ifndef VITRAIL_REGISTER_PARAMETERS
#define VITRAIL_REGISTER_PARAMETERS b13
#endif
#ifdef VITRAIL_READ_ONLY
#ifndef VITRAIL_REGISTER_CONTROL
#define VITRAIL_REGISTER_CONTROL t120
#endif
#ifndef VITRAIL_REGISTER_HEADS
#define VITRAIL_REGISTER_HEADS t121
#endif
#ifndef VITRAIL_REGISTER_NODES
#define VITRAIL_REGISTER_NODES t122
#endif
#else
#ifndef VITRAIL_REGISTER_CONTROL
#define VITRAIL_REGISTER_CONTROL u1
#endif
#ifndef VITRAIL_REGISTER_HEADS
#define VITRAIL_REGISTER_HEADS u2
#endif
#ifndef VITRAIL_REGISTER_NODES
#define VITRAIL_REGISTER_NODES u3
#endif
#ifndef VITRAIL_REGISTER_SUMS
#define VITRAIL_REGISTER_SUMS u4
#endif
#endif
cbuffer VitrailParametersBlock : VITRAIL_AT(VITRAIL_REGISTER_PARAMETERS) { VitrailParameters vitrailParameters; };
VITRAIL_BUFFER vitrailControl : VITRAIL_AT(VITRAIL_REGISTER_CONTROL);
VITRAIL_BUFFER vitrailHeads : VITRAIL_AT(VITRAIL_REGISTER_HEADS); // a node index a pixel of the area
VITRAIL_BUFFER vitrailPool : VITRAIL_AT(VITRAIL_REGISTER_NODES);
#endif

uint vitrailPoolCapacity() { return vitrailParameters.capacity; }
#include "pool.hlsl"

// Whether shaders that reach the pool by its view reach all of it.
bool vitrailReachesPool() { return vitrailParameters.wholeByBinding != 0u; }

#endif
