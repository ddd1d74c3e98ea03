// The kernels' bytecode, of shader model 5.0, by name and variant (cmake/BytecodeTable.cmake).
#pragma once

#include <cstddef>
#include <span>

#include "kernels/kernels.h"
#include "vitrail/types.h"

namespace vitrail {

using Bytecode = std::span<const unsigned char>;

// Where a kernel's resources are bound. Compute kernels have the numbers of vitrail/bindings.h: buffers u1 to u7, the
// colour image u0, the other images t1 and t2. Pixel shaders have the counters at the last place that feature level
// 11_0 has, and read the other buffers.
constexpr unsigned kParameterSlot = 0; // b0, VitrailParameters
constexpr unsigned kKernelSlot = 1;    // b1, KernelConstants
constexpr unsigned kPixelCounterSlot = 7;
constexpr unsigned kPixelBufferSlot = 8; // t8 and the number of the binding

// What other APIs specialize.
struct KernelConstants {
  std::uint32_t samples;
  std::uint32_t nearestIsOne;
  std::uint32_t maxLayers;
  std::uint32_t testDepth;
};

// `several` (one invocation resolves all samples of a pixel) matters for kernels that write pictures. Empty where there
// is no such variant.
Bytecode kernelBytecode(Kernel kernel, bool several, VitrailNodeFormat format);
Bytecode pixelBytecode(FragmentResolve resolve, VitrailNodeFormat format);
Bytecode vertexBytecode();

// All there is, for tests.
enum class BytecodeStage { comp, frag, vert };
struct BytecodeVariant {
  BytecodeStage stage;
  const char* symbol; // comp_resolve_one_0
  Bytecode code;
};
std::span<const BytecodeVariant> bytecodeVariants();

} // namespace vitrail
