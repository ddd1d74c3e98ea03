// Where resources are bound, for C++ and GLSL.
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

#endif
