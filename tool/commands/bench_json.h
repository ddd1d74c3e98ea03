// A benchmark as JSON for programs.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "../bench/measurement.h"

namespace vitrail::tool {

// The JSON document of --json, which is an interface: names and units stay. docs/performance.md lists them. What does
// not apply, or could not be measured, is null.
std::string toJson(const BenchReport& report);

// median, lower_quartile, upper_quartile, min, max, in the unit of the measurements.
nlohmann::ordered_json toJson(const Spread& spread);

} // namespace vitrail::tool
