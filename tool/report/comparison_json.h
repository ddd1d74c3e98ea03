// A comparison of methods as JSON for programs.
#pragma once

#include <string>

#include "../compare/comparison.h"

namespace vitrail::tool {

// The JSON document of `vitrail compare --json` and report.json. docs/compare.md lists what is in it.
std::string toJson(const Comparison& comparison);

} // namespace vitrail::tool
