// Texts as other programs and systems write them, made into UTF-8 with lines that end in a line feed.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace vitrail::tool {

// The text of a file: its bytes as they are where that will do, otherwise a copy that it owns. The file outlives it.
// UTF-16 of both byte orders becomes UTF-8, with or without a byte order mark; the mark of UTF-8 is left out; where
// lines end in a carriage return alone, it becomes a line feed.
class PlainText {
 public:
  explicit PlainText(std::span<const std::byte> file);
  PlainText(const PlainText&) = delete;
  PlainText& operator=(const PlainText&) = delete;

  std::string_view view() const { return view_; }

 private:
  std::string copy_;
  std::string_view view_;
};

} // namespace vitrail::tool
