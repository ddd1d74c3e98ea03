// Words for error messages about files.
#include "message.h"

#include <fmt/format.h>

namespace vitrail::tool {

std::string oneLine(std::string_view text) {
  constexpr std::size_t longest = 160;
  std::string line;
  for (const char c : text.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    const bool control = byte < 0x20 || byte == 0x7f;
    if (control && (line.empty() || line.back() == ' ')) continue;
    line += control ? ' ' : c;
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  if (text.size() > longest) line += "...";
  return line;
}

std::string objectName(std::string_view kind, std::size_t index, std::string_view name) {
  if (name.empty()) return fmt::format("{} {}", kind, index);
  return fmt::format("{} {} \"{}\"", kind, index, oneLine(name));
}

} // namespace vitrail::tool
