// The kernels that there are as SPIR-V for OpenGL, too.
#pragma once

#include "kernels/kernels.h"
#include "programs.h"

namespace vitrail {

// The module of a program's compute kernel, with the specialization constants of src/kernels/target.glsl. Empty where
// there is none: the driver compiles GLSL.
Spirv moduleFor(const ProgramKey& key);

} // namespace vitrail
