// What kernels are called, whatever a backend compiles them from.
#include <array>

#include "kernels.h"

namespace vitrail {

const char* kernelName(Kernel kernel) {
#define VITRAIL_NAME_comp(name, words) words,
#define VITRAIL_NAME_frag(name, words)
#define VITRAIL_NAME_vert(name, words)
#define VITRAIL_KERNEL(stage, name, words) VITRAIL_NAME_##stage(name, words)
  constexpr std::array kNames = {
#include "kernels/names.inc"
  };
  return kNames[static_cast<std::size_t>(kernel)];
}

} // namespace vitrail
