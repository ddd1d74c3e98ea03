// Texts as other programs and systems write them.
#include "text_encoding.h"

#include <algorithm>
#include <cstdint>

namespace vitrail::tool {
namespace {

void appendUtf8(std::string& text, std::uint32_t character) {
  const auto byte = [&text](std::uint32_t value) { text.push_back(static_cast<char>(value)); };
  if (character < 0x80) {
    byte(character);
  } else if (character < 0x800) {
    byte(0xc0 | character >> 6U);
    byte(0x80 | (character & 0x3f));
  } else if (character < 0x10000) {
    byte(0xe0 | character >> 12U);
    byte(0x80 | (character >> 6U & 0x3f));
    byte(0x80 | (character & 0x3f));
  } else {
    byte(0xf0 | character >> 18U);
    byte(0x80 | (character >> 12U & 0x3f));
    byte(0x80 | (character >> 6U & 0x3f));
    byte(0x80 | (character & 0x3f));
  }
}

std::string utf8FromUtf16(std::string_view bytes, bool bigEndian) {
  constexpr std::uint32_t replacement = 0xfffd;
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(bytes[i]);
    const auto second = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<std::uint32_t>(bigEndian ? first << 8U | second : second << 8U | first);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const std::uint32_t high = unit(i);
    if (high < 0xd800 || high > 0xdfff) {
      appendUtf8(text, high);
      continue;
    }
    const std::uint32_t low = high < 0xdc00 && i + 3 < bytes.size() ? unit(i + 2) : 0;
    const bool pair = low >= 0xdc00 && low < 0xe000;
    appendUtf8(text, pair ? 0x10000 + ((high - 0xd800) << 10U) + (low - 0xdc00) : replacement);
    if (pair) i += 2;
  }
  return text;
}

// Carriage returns that no line feed follows. Who writes them does so from the start.
bool hasBareReturns(std::string_view text) {
  const std::string_view start = text.substr(0, 65536);
  for (std::size_t i = start.find('\r'); i != std::string_view::npos; i = start.find('\r', i + 1))
    if (i + 1 < text.size() && text[i + 1] != '\n' && text[i + 1] != '\r') return true;
  return false;
}

} // namespace

PlainText::PlainText(std::span<const std::byte> file) : view_(reinterpret_cast<const char*>(file.data()), file.size()) {
  const bool marked = view_.starts_with("\xff\xfe") || view_.starts_with("\xfe\xff");
  // Without a mark the text tells by its first character, which is none of the far ones.
  const bool unmarked = view_.size() >= 4 && (view_[0] == '\0') == (view_[2] == '\0') &&
                        (view_[1] == '\0') == (view_[3] == '\0') && (view_[0] == '\0') != (view_[1] == '\0');
  if (marked || unmarked) {
    const bool bigEndian = view_[0] == '\xfe' || view_[0] == '\0';
    copy_ = utf8FromUtf16(view_.substr(marked ? 2 : 0), bigEndian);
    view_ = copy_;
  } else if (view_.starts_with("\xef\xbb\xbf")) {
    view_.remove_prefix(3);
  }
  if (!hasBareReturns(view_)) return;
  if (copy_.empty()) copy_ = view_;
  std::ranges::replace(copy_, '\r', '\n');
  view_ = copy_;
}

} // namespace vitrail::tool
