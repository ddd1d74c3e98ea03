#include "bytecode.h"

#include <array>

#include "kernels/bytecode_includes.inc"

namespace vitrail {

namespace {

// The values of each axis, as the build has them; `any`: the variant serves all.
enum class Samples { any, one, several };
enum class Format { any = -1, standard = 0, compact = 1, hdr = 2 };
constexpr Format any = Format::any;

struct Variant {
  BytecodeStage stage;
  std::uint32_t kernel; // of the stage's enum
  Samples samples;
  Format format;
  Bytecode code;
};

#define VITRAIL_ENUMERATOR_comp(name) static_cast<std::uint32_t>(Kernel::name)
#define VITRAIL_ENUMERATOR_frag(name) static_cast<std::uint32_t>(FragmentResolve::name)
#define VITRAIL_ENUMERATOR_vert(name) 0
#define VITRAIL_BYTECODE(stage, name, samples, format, symbol)                                                   \
  Variant{BytecodeStage::stage, VITRAIL_ENUMERATOR_##stage(name), Samples::samples, static_cast<Format>(format), \
          bytecode::symbol},
constexpr std::array kVariants = {
#include "kernels/bytecode.inc"
};
#undef VITRAIL_BYTECODE

#define VITRAIL_BYTECODE(stage, name, samples, format, symbol) \
  BytecodeVariant{BytecodeStage::stage, #symbol, bytecode::symbol},
constexpr std::array kPublicVariants = {
#include "kernels/bytecode.inc"
};
#undef VITRAIL_BYTECODE

template <class Axis>
bool suits(Axis variant, Axis asked) {
  return variant == asked || variant == Axis::any || asked == Axis::any;
}

Bytecode find(BytecodeStage stage, std::uint32_t kernel, Samples samples, Format format) {
  for (const Variant& variant : kVariants) {
    if (variant.stage == stage && variant.kernel == kernel && suits(variant.samples, samples) &&
        suits(variant.format, format)) {
      return variant.code;
    }
  }
  return {};
}

} // namespace

Bytecode kernelBytecode(Kernel kernel, bool several, VitrailNodeFormat format) {
  return find(BytecodeStage::comp, static_cast<std::uint32_t>(kernel), several ? Samples::several : Samples::one,
              static_cast<Format>(format));
}

Bytecode pixelBytecode(FragmentResolve resolve, VitrailNodeFormat format) {
  return find(BytecodeStage::frag, static_cast<std::uint32_t>(resolve), Samples::any, static_cast<Format>(format));
}

Bytecode vertexBytecode() { return find(BytecodeStage::vert, 0, Samples::any, Format::any); }

std::span<const BytecodeVariant> bytecodeVariants() { return kPublicVariants; }

} // namespace vitrail
