// Reads the numbers of formats in which a value that is not there is written as one that is not a number.
#pragma once

namespace vitrail::tool {

inline bool endsLine(char c) { return c == '\n' || c == '\r'; }
// Spaces, and all control characters beside tabs and line ends, which some files are padded with.
inline bool endsWord(char c) { return static_cast<unsigned char>(c) <= ' '; }

// The number that [begin, end) starts with; where it ends, or null where there is none. What a double cannot hold is
// NaN, and so are the ways in which programs write that they had no number: nan, -inf, nan(ind), -1.#IND00.
const char* parseNumberOrNan(const char* begin, const char* end, double& value);

} // namespace vitrail::tool
