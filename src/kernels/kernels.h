// The SPIR-V of the library's kernels, by name and variant. kernels.table has the one list of them, from which the
// build makes what is included here.
#pragma once

#include <cstdint>
#include <span>

namespace vitrail {

#define VITRAIL_ENUMERATOR_comp(name) name,
#define VITRAIL_ENUMERATOR_frag(name)
#define VITRAIL_ENUMERATOR_vert(name)
#define VITRAIL_KERNEL(stage, name, words) VITRAIL_ENUMERATOR_##stage(name)
// The compute kernels.
enum class Kernel : std::uint32_t {
#include "kernels/names.inc"
};
#undef VITRAIL_ENUMERATOR_comp
#undef VITRAIL_ENUMERATOR_frag
#define VITRAIL_ENUMERATOR_comp(name)
#define VITRAIL_ENUMERATOR_frag(name) name,
// How the fragment resolve writes: Dual with dual-source blending, Depth with a depth test of each sample. Plain is
// PerPixel for a frame without a fragment.
enum class FragmentResolve : std::uint32_t {
#include "kernels/names.inc"
};
#undef VITRAIL_ENUMERATOR_comp
#undef VITRAIL_ENUMERATOR_frag
#undef VITRAIL_ENUMERATOR_vert
#undef VITRAIL_KERNEL

// The colour images that a compute resolve writes.
enum class ColorImage : std::uint32_t { Rgba16f, Rgba32f };

using Spirv = std::span<const std::uint32_t>;

// The local sizes that hosts of the kernels count with.
constexpr std::uint32_t kGroupSide = 8;   // of kernels with one thread a pixel, in both directions
constexpr std::uint32_t kGroupNodes = 64; // of kernels with one thread a node, or several nodes

// The work groups of such a kernel: more nodes than 2 million are several a thread.
constexpr std::uint32_t nodeGroups(std::uint32_t nodes) {
  constexpr std::uint32_t kMost = 32768;
  return nodes / kGroupNodes < kMost ? nodes / kGroupNodes + 1 : kMost;
}

// `color` and `multisampled` (one invocation resolves all samples of a pixel) matter for the kernels that write
// pictures. `byAddress`: the node pool is reached by its address, else through its binding. `networks`: it sorts by
// networks, else by insertion. Empty where the table has no such variant.
Spirv kernelCode(Kernel kernel, ColorImage color, bool multisampled, bool byAddress, bool networks);

Spirv fragmentCode(FragmentResolve resolve, bool byAddress, bool networks);
Spirv vertexCode();

// For debuggers and messages: "build lists".
const char* kernelName(Kernel kernel);

// A row of the table for one value of each axis, for tests.
struct KernelVariant {
  const char* symbol; // comp_resolve_rgba16f_one_networks_binding
  Spirv code;
  bool byAddress;
};
std::span<const KernelVariant> kernelVariants();

} // namespace vitrail
