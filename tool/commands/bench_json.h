// A benchmark as JSON for programs.
#pragma once

#include <string>

#include "../bench/measurement.h"

namespace vitrail::tool {

// The JSON document of --json, which is an interface: names and units stay. docs/performance.md lists them. What does
// not apply, or could not be measured, is null.
std::string toJson(const BenchReport& report);

} // namespace vitrail::tool
