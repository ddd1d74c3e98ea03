// The SPIR-V of the library's kernels, by name and permutation. src/CMakeLists.txt has the one table that compiles
// them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace vitrail {

enum class Kernel : std::uint32_t {
  Resolve,
  ResolveMedium, // by networks, as the next one
  ResolveGroup,
  ResolveLong, // by insertion
  ResolveOverflow,
  Link,
  SortFind,
  SortLong,
  ClearSums
};

// The colour images that a compute resolve writes.
enum class ColorImage : std::uint32_t { Rgba16f, Rgba32f };

// How the fragment resolve writes: Dual with dual-source blending, Depth with a depth test of each sample.
enum class FragmentResolve : std::uint32_t {
  Single,
  SingleDual,
  PerSample,
  PerSampleDual,
  PerSampleDepth,
  PerSampleDualDepth,
  PerPixel
};

using Spirv = std::span<const std::uint32_t>;

// `color` and `multisampled` (one invocation resolves all samples of a pixel) matter for the kernels that write
// pictures. `byAddress`: the node pool is reached by its address, else through its binding. `networks`: it sorts by
// networks, else by insertion (shaders/vitrail/sort.glsl says which suits what).
Spirv kernelCode(Kernel kernel, ColorImage color, bool multisampled, bool byAddress, bool networks);

Spirv fragmentCode(FragmentResolve resolve, bool byAddress, bool networks);
Spirv vertexCode();

} // namespace vitrail
