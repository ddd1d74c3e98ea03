// Words for error messages about files: text that came out of a file is made safe to print on one line.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace vitrail::tool {

// The text as a terminal may have it: UTF-8 on one line, with control characters turned into spaces and bytes that are
// no UTF-8 into question marks.
std::string printable(std::string_view text);

// The same, cut after 160 bytes.
std::string oneLine(std::string_view text);

// How a message names one object of a file: `mesh 3`, or `mesh 3 "body"` where it has a name.
std::string objectName(std::string_view kind, std::size_t index, std::string_view name = {});

} // namespace vitrail::tool
