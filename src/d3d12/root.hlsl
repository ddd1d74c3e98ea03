// The root signatures of the library's pipelines. b0 of kernels is VitrailParameters, b1 KernelConstants
// (direct3d/bytecode.h). Compute kernels ask buffers for their sizes, which root descriptors do not have: tables.
#define VITRAIL_ROOT_WORDS "RootConstants(num32BitConstants = 24, b0), UAV(u0)"

#define VITRAIL_ROOT_COMPUTE \
  "CBV(b0), RootConstants(num32BitConstants = 4, b1), DescriptorTable(UAV(u1, numDescriptors = 7)), " \
  "DescriptorTable(UAV(u0), SRV(t1, numDescriptors = 2))"

// Counters; heads, nodes and sums; the opaque colour and depth.
#define VITRAIL_ROOT_DRAW \
  "CBV(b0, visibility = SHADER_VISIBILITY_PIXEL), " \
  "RootConstants(num32BitConstants = 4, b1, visibility = SHADER_VISIBILITY_PIXEL), " \
  "UAV(u7, visibility = SHADER_VISIBILITY_PIXEL), SRV(t10, visibility = SHADER_VISIBILITY_PIXEL), " \
  "SRV(t11, visibility = SHADER_VISIBILITY_PIXEL), SRV(t12, visibility = SHADER_VISIBILITY_PIXEL), " \
  "DescriptorTable(SRV(t1, numDescriptors = 2), visibility = SHADER_VISIBILITY_PIXEL)"
