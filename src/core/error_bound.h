// How far pictures may be from the real-number answer for the rounding of nodes. docs/resolve.md derives the formulas.
#pragma once

#include <cstdint>

namespace vitrail {

// vitrailNodeErrorBound().
float nodeErrorBound(std::uint32_t format, std::uint32_t samples, std::uint32_t layers);

} // namespace vitrail
