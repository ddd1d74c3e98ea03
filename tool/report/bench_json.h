// A benchmark as JSON for programs.
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "../bench/measurement.h"

namespace vitrail::tool {

// The JSON document of --json, which is an interface: names and units stay. docs/performance.md lists them. What does
// not apply, or could not be measured, is null.
std::string toJson(const BenchReport& report);

// What --layers or --passes said of a method.
nlohmann::ordered_json limitOrNull(std::uint32_t limit);

// median, lower_quartile, upper_quartile, min, max, in the unit of the measurements.
nlohmann::ordered_json toJson(const Spread& spread);

} // namespace vitrail::tool
