// Words for error messages about files.
#include "message.h"

#include <array>
#include <cstdint>

#include <fmt/format.h>

namespace vitrail::tool {

namespace {

// A character of UTF-8 and the bytes that it takes.
struct Character {
  std::uint32_t code;
  std::size_t bytes;
};

// The character that the text, which is not empty, begins with; a byte that begins none stands for itself.
Character firstOf(std::string_view text) {
  const auto byte = [text](std::size_t i) { return std::uint32_t{static_cast<unsigned char>(text[i])}; };
  const std::uint32_t lead = byte(0);
  const std::size_t bytes = lead < 0xc2 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : lead < 0xf5 ? 4 : 1;
  if (bytes == 1 || bytes > text.size()) return {lead, 1};
  std::uint32_t code = lead & (0x7fU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return {lead, 1};
    code = code << 6U | (byte(i) & 0x3fU);
  }
  constexpr std::array<std::uint32_t, 5> least{0, 0, 0x80, 0x800, 0x10000}; // longer forms of others are none
  if (code < least[bytes] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return {lead, 1};
  return {code, bytes};
}

// Orders to a terminal rather than characters: the C0 and C1 control characters; line and paragraph separators; what
// turns the direction of writing.
bool isControl(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x200e || code == 0x200f ||
         (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

} // namespace

std::string printable(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const Character character = firstOf(text);
    if (character.bytes == 1 && character.code >= 0x80) {
      line += '?'; // no UTF-8
    } else if (isControl(character.code)) {
      if (!line.empty() && line.back() != ' ') line += ' ';
    } else {
      line += text.substr(0, character.bytes);
    }
    text.remove_prefix(character.bytes);
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

std::string oneLine(std::string_view text) {
  constexpr std::size_t longest = 160;
  if (text.size() <= longest) return printable(text);
  std::size_t end = longest;
  while (end > longest - 3 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) --end; // between characters
  return printable(text.substr(0, end)) + "...";
}

std::string objectName(std::string_view kind, std::size_t index, std::string_view name) {
  if (name.empty()) return fmt::format("{} {}", kind, index);
  return fmt::format("{} {} \"{}\"", kind, index, oneLine(name));
}

} // namespace vitrail::tool
