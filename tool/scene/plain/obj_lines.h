// Walks over the lines of OBJ files and the words in them.
#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

#include "letters.h"

namespace vitrail::tool::obj {

// Zeros are what some files are padded with.
inline bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r') || c == '\0'; }

// Walks over the lines of a text. One that ends in a backslash goes on in the next.
class Lines {
 public:
  explicit Lines(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

  bool next() {
    number_ += counted_;
    counted_ = 1;
    if (at_ == end_) return false;
    begin_ = at_;
    lineEnd_ = endFrom(at_);
    at_ = lineEnd_ == end_ ? end_ : lineEnd_ + 1;
    if (goesOn(lineEnd_) && *begin_ != '#') join();
    return true;
  }

  std::string_view line() const { return {begin_, static_cast<std::size_t>(lineEnd_ - begin_)}; }
  bool isJoined() const { return begin_ == joined_.data(); }
  std::size_t number() const { return number_; } // of the line, from 1

 private:
  const char* endFrom(const char* from) const {
    const auto* found = static_cast<const char*>(std::memchr(from, '\n', static_cast<std::size_t>(end_ - from)));
    return found == nullptr ? end_ : found;
  }

  bool goesOn(const char* end) const {
    if (end == end_) return false;
    if (end > begin_ && end[-1] == '\r') --end;
    return end > begin_ && end[-1] == '\\';
  }

  // Blanks in the place of the line ends keep the rest as it is.
  void join() {
    const char* const start = begin_;
    while (goesOn(lineEnd_) && at_ != end_) {
      begin_ = at_;
      lineEnd_ = endFrom(at_);
      at_ = lineEnd_ == end_ ? end_ : lineEnd_ + 1;
      ++counted_;
    }
    joined_.assign(start, lineEnd_);
    for (std::size_t i = joined_.find('\n'); i != std::string::npos; i = joined_.find('\n', i)) {
      joined_[i] = ' ';
      std::size_t before = i - 1;
      if (joined_[before] == '\r') joined_[before--] = ' ';
      joined_[before] = ' ';
    }
    begin_ = joined_.data();
    lineEnd_ = begin_ + joined_.size();
  }

  const char* at_;
  const char* end_;
  const char* begin_ = nullptr;
  const char* lineEnd_ = nullptr;
  std::string joined_;
  std::size_t number_ = 0;
  std::size_t counted_ = 1;
};

inline void skipBlanks(std::string_view& line) {
  std::size_t i = 0;
  while (i < line.size() && isBlank(line[i])) ++i;
  line.remove_prefix(i);
}

// The next word of a line, without the blanks around it; empty at its end and before a comment.
inline std::string_view takeWord(std::string_view& line) {
  skipBlanks(line);
  std::size_t i = 0;
  if (!line.starts_with('#'))
    while (i < line.size() && !isBlank(line[i])) ++i;
  const std::string_view word = line.substr(0, i);
  line.remove_prefix(i);
  return word;
}

// The word that says what a line is, in lower case.
inline std::string_view takeStatement(std::string_view& line, std::string& lower) {
  const std::string_view word = takeWord(line);
  if (word.empty() || word[0] < 'A' || word[0] > 'Z') return word;
  lower = lowerCase(word);
  return lower;
}

inline std::string_view trimmed(std::string_view text) {
  skipBlanks(text);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

} // namespace vitrail::tool::obj
