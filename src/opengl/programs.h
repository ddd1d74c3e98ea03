// Compiles the kernels' GLSL, specialized for a kind of target by #define.
#pragma once

#include <compare>
#include <cstdint>
#include <span>

#include "functions.h"
#include "kernels/kernels.h"

struct VitrailGlContext_T;

namespace vitrail {

// One of the table's rows, and what it is compiled for.
struct ProgramKey {
  bool draws = false;       // the fragment resolve, else a compute kernel
  std::uint32_t kernel = 0; // Kernel, or FragmentResolve
  ColorImage color = ColorImage::Rgba16f;
  bool multisampled = false;
  bool networks = false;
  std::uint32_t format = 0; // VITRAIL_FORMAT_*
  std::uint32_t samples = 1;
  bool nearestIsOne = false;
  std::uint32_t maxLayers = 0;
  bool testDepth = false;
  std::uint32_t group = 4;

  auto operator<=>(const ProgramKey&) const = default;
};

// The programs of these keys, which the context keeps. Drivers that compile on several threads do so with all that are
// not there yet. Logs its errors.
VitrailResult findPrograms(VitrailGlContext_T& context, std::span<const ProgramKey> keys, std::span<GLuint> programs);

} // namespace vitrail
