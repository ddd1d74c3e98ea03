// A count in a few characters, for labels and tables.
#pragma once

#include <cstdint>
#include <string>

namespace vitrail::tool {

// "950", "33 k", "2.1 M".
std::string shortCount(std::uint64_t count);

} // namespace vitrail::tool
