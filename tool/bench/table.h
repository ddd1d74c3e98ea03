// A benchmark as a table for people.
#pragma once

#include <string>

#include "measurement.h"

namespace vitrail::tool {

// Lines of at most 120 columns (names of devices and models and reasons of the device apart), with a last newline: what
// was measured on, a table for each scene, and what its columns are. docs/performance.md explains them.
std::string toTable(const BenchReport& report);

} // namespace vitrail::tool
