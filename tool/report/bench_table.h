// A benchmark as a table for people.
#pragma once

#include <string>

#include "../bench/measurement.h"

namespace vitrail::tool {

// Lines of at most 120 columns (names of devices and models and reasons of the device apart), with a last newline: what
// was measured on, a table for each scene, or for each sweep a grid of methods and steps, what the columns are, and the
// advice that follows (recommendation.h). docs/performance.md explains them.
std::string toTable(const BenchReport& report);

} // namespace vitrail::tool
