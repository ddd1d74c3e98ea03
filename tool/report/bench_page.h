// A benchmark as one HTML page that needs nothing beside it and no network.
#pragma once

#include <string>

namespace vitrail::tool {

// The page: which method to use and why, charts of cost and memory over the steps of each sweep or over the scenes, and
// tables. `report` is the benchmark as JSON.
std::string toBenchPage(const std::string& report);

} // namespace vitrail::tool
