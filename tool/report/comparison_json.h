// A comparison of methods as JSON for programs.
#pragma once

#include <string>

#include "../compare/comparison.h"

namespace vitrail::tool {

// The JSON document of --json and report.json, which is an interface: names and units stay. docs/compare.md lists them.
// What does not apply, or could not be measured, is null.
std::string toJson(const Comparison& comparison);

} // namespace vitrail::tool
