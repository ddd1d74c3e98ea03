// Letter case, where formats and file systems do not agree on it.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace vitrail::tool {

// The text with A to Z as a to z.
inline std::string lowerCase(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

} // namespace vitrail::tool
