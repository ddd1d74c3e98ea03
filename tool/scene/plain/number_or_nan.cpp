// Reads numbers that may not be numbers.
#include "number_or_nan.h"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>

#include "letters.h"
#include "number.h"

namespace vitrail::tool {
namespace {

// What parseNumber() leaves: the word is looked at as a whole.
const char* parseNoNumber(const char* begin, const char* end, double& value) {
  const char* const wordEnd = std::find_if(begin, end, endsWord);
  std::string word = lowerCase({begin, static_cast<std::size_t>(wordEnd - begin)});
  if (word.starts_with('-') || word.starts_with('+')) word.erase(0, 1);
  const bool tooLarge = !word.empty() && word.find_first_not_of("0123456789.e+") == std::string::npos &&
                        word.find('e') == word.rfind('e') && word.find('.') == word.rfind('.') &&
                        detail::isDigit(word.front()) && detail::isDigit(word.back());
  // Microsoft's library writes 1.#QNAN, -1.#IND00 and 1.#INF.
  if (!tooLarge && !word.starts_with("nan") && !word.starts_with("inf") && !word.starts_with("1.#")) return nullptr;
  value = std::numeric_limits<double>::quiet_NaN();
  return wordEnd;
}

} // namespace

const char* parseNumberOrNan(const char* begin, const char* end, double& value) {
  const char* const after = parseNumber(begin, end, value);
  return after != nullptr && (after == end || *after != '#') ? after : parseNoNumber(begin, end, value);
}

} // namespace vitrail::tool
