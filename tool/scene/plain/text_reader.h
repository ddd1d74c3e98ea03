// Reads text formats line by line and word by word.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace vitrail::tool {

// Walks over the lines of a text that hold anything, and over the words of each. The text outlives it. Words are parted
// by spaces, tabs and carriage returns.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : text_(text) {}

  // Goes to the next line that is not blank. False at the end of the text.
  bool next();

  // The next word of the line; empty at its end.
  std::string_view word();

  // The next word as a number. Fails where there is none, or none that a 32-bit float holds.
  float number();

  // Whether the line has another word.
  bool more() const;

  // What is left of the line, without spaces around it.
  std::string_view rest() const;

  // Where the line after this one begins in the text.
  std::size_t nextLineOffset() const { return next_; }

  // Throws LoadError: "line 7: problem".
  [[noreturn]] void fail(std::string_view problem) const;

 private:
  std::string_view text_;
  std::string_view line_; // what is left of it
  std::size_t next_ = 0;
  std::size_t number_ = 0;
};

// The whole word as a number, if it is one that a 32-bit float holds.
bool parseFloat(std::string_view word, float& value);

} // namespace vitrail::tool
