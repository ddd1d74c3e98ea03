// Reads text formats line by line and word by word.
#include "text_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "../load.h"
#include "../message.h"

namespace vitrail::tool {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";

std::string_view withoutBlanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

} // namespace

bool TextLines::next() {
  while (next_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', next_), text_.size());
    line_ = withoutBlanks(text_.substr(next_, end - next_));
    next_ = std::min(end + 1, text_.size());
    ++number_;
    if (!line_.empty()) return true;
  }
  return false;
}

std::string_view TextLines::word() {
  const std::size_t end = std::min(line_.find_first_of(blanks), line_.size());
  const std::string_view result = line_.substr(0, end);
  line_ = withoutBlanks(line_.substr(end));
  return result;
}

float TextLines::number() {
  const std::string_view text = word();
  if (text.empty()) fail("a number is missing");
  float value = 0.0F;
  if (!parseFloat(text, value)) fail(fmt::format("{} is not a finite number", oneLine(text)));
  return value;
}

bool TextLines::more() const { return !line_.empty(); }

std::string_view TextLines::rest() const { return line_; }

void TextLines::fail(std::string_view problem) const { throw LoadError(fmt::format("line {}: {}", number_, problem)); }

bool parseFloat(std::string_view word, float& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  // Too small for a double rather than too large.
  if (error == std::errc::result_out_of_range && word.find_first_of("eE") != std::string_view::npos &&
      word[word.find_first_of("eE") + 1] == '-') {
    value = 0.0F;
    return true;
  }
  if (error != std::errc{} || end != word.data() + word.size()) return false;
  if (!(std::abs(number) <= static_cast<double>(std::numeric_limits<float>::max()))) return false;
  value = static_cast<float>(number);
  return true;
}

} // namespace vitrail::tool
