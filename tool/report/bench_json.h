// A benchmark as JSON for programs.
#pragma once

#include <string>

#include "../bench/measurement.h"

namespace vitrail::tool {

// The JSON document of `vitrail bench --json`. docs/performance.md lists what is in it.
std::string toJson(const BenchReport& report);

} // namespace vitrail::tool
