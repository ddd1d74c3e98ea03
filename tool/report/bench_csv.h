// A benchmark as a table for spreadsheets and plotting programs.
#pragma once

#include <string>

#include "../bench/measurement.h"

namespace vitrail::tool {

// One row a measurement under a row of column names, which are an interface: docs/performance.md lists them. What does
// not apply, or could not be measured, is empty. RFC 4180, with a line feed at the end of each line.
std::string toCsv(const BenchReport& report);

} // namespace vitrail::tool
