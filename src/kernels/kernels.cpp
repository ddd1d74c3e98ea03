#include "kernels.h"

#include <array>

#include "kernels/vulkan_includes.inc"

namespace vitrail {

namespace {

// The values of each axis, as kernels.table has them; `any`: the variant serves all.
enum class Color { any, rgba16f, rgba32f };
enum class Samples { any, one, several };
enum class Sorting { any, networks, insertion };
enum class Access { any, binding, address };
enum class Stage { comp, frag, vert };

#define VITRAIL_ENUMERATOR_comp(name) static_cast<std::uint32_t>(Kernel::name)
#define VITRAIL_ENUMERATOR_frag(name) static_cast<std::uint32_t>(FragmentResolve::name)
#define VITRAIL_ENUMERATOR_vert(name) 0

struct Variant {
  Stage stage;
  std::uint32_t kernel; // of the stage's enum
  Color color;
  Samples samples;
  Sorting sorting;
  Access access;
  Spirv code;
};

#define VITRAIL_VARIANT(stage, name, color, samples, sorting, access, symbol) \
  Variant{Stage::stage,     VITRAIL_ENUMERATOR_##stage(name),                 \
          Color::color,     Samples::samples,                                 \
          Sorting::sorting, Access::access,                                   \
          shaders::symbol},
constexpr std::array kVariants = {
#include "kernels/vulkan_variants.inc"
};
#undef VITRAIL_VARIANT

#define VITRAIL_VARIANT(stage, name, color, samples, sorting, access, symbol) \
  KernelVariant{#symbol, shaders::symbol, Access::access == Access::address},
constexpr std::array kPublicVariants = {
#include "kernels/vulkan_variants.inc"
};
#undef VITRAIL_VARIANT

template <class Axis>
bool suits(Axis variant, Axis asked) {
  return variant == asked || variant == Axis::any || asked == Axis::any;
}

Spirv find(const Variant& asked) {
  for (const Variant& variant : kVariants) {
    if (variant.stage == asked.stage && variant.kernel == asked.kernel && suits(variant.color, asked.color) &&
        suits(variant.samples, asked.samples) && suits(variant.sorting, asked.sorting) &&
        suits(variant.access, asked.access)) {
      return variant.code;
    }
  }
  return {};
}

} // namespace

Spirv kernelCode(Kernel kernel, ColorImage color, bool multisampled, bool byAddress, bool networks) {
  return find({Stage::comp, static_cast<std::uint32_t>(kernel),
               color == ColorImage::Rgba32f ? Color::rgba32f : Color::rgba16f,
               multisampled ? Samples::several : Samples::one, networks ? Sorting::networks : Sorting::insertion,
               byAddress ? Access::address : Access::binding, Spirv{}});
}

Spirv fragmentCode(FragmentResolve resolve, bool byAddress, bool networks) {
  return find({Stage::frag, static_cast<std::uint32_t>(resolve), Color::any, Samples::any,
               networks ? Sorting::networks : Sorting::insertion, byAddress ? Access::address : Access::binding,
               Spirv{}});
}

Spirv vertexCode() { return find({Stage::vert, 0, Color::any, Samples::any, Sorting::any, Access::any, Spirv{}}); }

std::span<const KernelVariant> kernelVariants() { return kPublicVariants; }

} // namespace vitrail
