// Compiles the kernels' GLSL, specialized for a kind of target by #define.
#pragma once

#include <compare>
#include <cstdint>

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

// The program of a key, which the context keeps. Logs its errors.
VitrailResult findProgram(VitrailGlContext_T& context, const ProgramKey& key, GLuint* program);

} // namespace vitrail
