// Where resources are bound, for C++ and GLSL. (HLSL has registers: target.hlsl.)
#ifndef VITRAIL_BINDINGS_H
#define VITRAIL_BINDINGS_H

// The target's descriptor set: what collecting shaders, the library's kernels and shaders that walk lists bind. A
// uniform buffer, then storage buffers.
#define VITRAIL_BINDING_PARAMETERS 0   // VitrailParameters
#define VITRAIL_BINDING_CONTROL 1      // VitrailControl
#define VITRAIL_BINDING_HEADS 2        // a node index a pixel of the area
#define VITRAIL_BINDING_NODES 3        // the node pool, as far as a binding reaches
#define VITRAIL_BINDING_SUMS 4         // VITRAIL_SUM_WORDS a pixel of the area
#define VITRAIL_BINDING_MEDIUM_LISTS 5 // from here on for compute shaders only: pixels whose lists one invocation takes
#define VITRAIL_BINDING_LONG_LISTS 6   // lists that groups of invocations take, or pixels
#define VITRAIL_BINDING_COPY 7         // sorted fragments that are copied out
#define VITRAIL_BINDINGS 8

// The set of a view's images, the kernels' second set.
#define VITRAIL_VIEW_BINDING_COLOR 0  // storage image: the picture of a compute resolve
#define VITRAIL_VIEW_BINDING_OPAQUE 1 // sampled image: the opaque colour with several samples
#define VITRAIL_VIEW_BINDING_DEPTH 2  // sampled image: the opaque depth with several samples
#define VITRAIL_VIEW_BINDINGS 3

#ifndef __cplusplus
// What the languages of Vulkan and of OpenGL (VITRAIL_OPENGL) say in different ways. OpenGL has one number for each
// binding point of a kind, which may be moved on by VITRAIL_BINDING_BASE, and specialization constants in SPIR-V only.
#ifndef VITRAIL_OPENGL
#define VITRAIL_BOUND(set_number, number) set = set_number, binding = number
#define VITRAIL_SPECIALIZED(id) layout(constant_id = id)
#define VITRAIL_TEXTURE_MS texture2DMS
#else
#ifdef VITRAIL_BINDING_BASE
#define VITRAIL_BOUND(set_number, number) binding = VITRAIL_BINDING_BASE + number
#else
#define VITRAIL_BOUND(set_number, number) binding = number
#endif
#ifdef GL_SPIRV
#define VITRAIL_SPECIALIZED(id) layout(constant_id = id)
#else
#define VITRAIL_SPECIALIZED(id)
#endif
#define VITRAIL_TEXTURE_MS sampler2DMS
#endif
#endif

#endif
