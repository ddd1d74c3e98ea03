#include "modules.h"

#ifdef VITRAIL_HAS_GL_MODULES
#include "kernels/opengl_includes.inc"
#endif

namespace vitrail {

#ifdef VITRAIL_HAS_GL_MODULES

namespace {

enum class Color { any, rgba16f, rgba32f };
enum class Samples { any, one, several };
enum class Sorting { any, networks, insertion };

bool suits(Color color, Samples samples, Sorting sorting, const ProgramKey& key) {
  return (color == Color::any || (color == Color::rgba32f) == (key.color == ColorImage::Rgba32f)) &&
         (samples == Samples::any || (samples == Samples::several) == key.multisampled) &&
         (sorting == Sorting::any || (sorting == Sorting::networks) == key.networks);
}

} // namespace

Spirv moduleFor(const ProgramKey& key) {
  if (key.draws) return {};
#define VITRAIL_ENUMERATOR_comp(name) Kernel::name
#define VITRAIL_VARIANT(stage, name, color, samples, sorting, access, symbol)       \
  if (key.kernel == static_cast<std::uint32_t>(VITRAIL_ENUMERATOR_##stage(name)) && \
      suits(Color::color, Samples::samples, Sorting::sorting, key)) {               \
    return shaders::symbol;                                                         \
  }
#include "kernels/opengl_variants.inc"
#undef VITRAIL_VARIANT
#undef VITRAIL_ENUMERATOR_comp
  return {};
}

#else

Spirv moduleFor(const ProgramKey& /*key*/) { return {}; }

#endif

} // namespace vitrail
