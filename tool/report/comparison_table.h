// A comparison of methods as a table for people.
#pragma once

#include <string>

#include "../compare/comparison.h"

namespace vitrail::tool {

// Lines of at most 120 columns (names of devices and models and reasons apart), with a last newline.
std::string toTable(const Comparison& comparison);

} // namespace vitrail::tool
