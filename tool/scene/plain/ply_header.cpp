// Reads the header of a PLY file.
#include "ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "../load.h"
#include "../message.h"
#include "letters.h"
#include "text_reader.h"

namespace vitrail::tool {
namespace {

PlyType parsePlyType(std::string_view word, const TextLines& lines) {
  using enum PlyType;
  constexpr std::array<std::pair<std::string_view, PlyType>, 18> types{{{"char", Int8},
                                                                        {"int8", Int8},
                                                                        {"uchar", Uint8},
                                                                        {"uint8", Uint8},
                                                                        {"short", Int16},
                                                                        {"int16", Int16},
                                                                        {"ushort", Uint16},
                                                                        {"uint16", Uint16},
                                                                        {"int", Int32},
                                                                        {"int32", Int32},
                                                                        {"uint", Uint32},
                                                                        {"uint32", Uint32},
                                                                        {"int64", Int64},
                                                                        {"uint64", Uint64},
                                                                        {"float", Float32},
                                                                        {"float32", Float32},
                                                                        {"double", Float64},
                                                                        {"float64", Float64}}};
  const std::string name = lowerCase(word);
  for (const auto& [known, type] : types)
    if (name == known) return type;
  lines.fail(fmt::format("\"{}\" is not a PLY type", oneLine(word)));
}

PlyProperty parsePlyProperty(TextLines& lines) {
  PlyProperty property;
  std::string_view type = lines.word();
  if (type == "list") {
    property.isList = true;
    property.countType = parsePlyType(lines.word(), lines);
    if (!isInteger(property.countType)) lines.fail("a list's length is not an integer");
    type = lines.word();
  }
  property.type = parsePlyType(type, lines);
  property.name = lowerCase(lines.word());
  if (property.name.empty()) lines.fail("a property has no name");
  return property;
}

PlyElement parsePlyElement(TextLines& lines) {
  PlyElement element;
  element.name = lowerCase(lines.word());
  const std::string_view count = lines.word();
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (count.empty() || error != std::errc{} || end != count.data() + count.size())
    lines.fail(fmt::format("\"{}\" is not a count of elements", oneLine(count)));
  return element;
}

PlyEncoding parsePlyEncoding(TextLines& lines) {
  const std::string name = lowerCase(lines.word());
  if (name == "ascii") return PlyEncoding::Text;
  if (name == "binary_little_endian") return PlyEncoding::LittleEndian;
  if (name == "binary_big_endian") return PlyEncoding::BigEndian;
  lines.fail(fmt::format("\"{}\" is not a PLY format", oneLine(name)));
}

void parseHeaderComment(TextLines& lines, PlyHeader& header) {
  const std::string_view whole = lines.rest();
  if (lowerCase(lines.word()) != "texturefile") {
    if (header.generator.empty()) header.generator = whole;
    return;
  }
  std::string_view name = lines.rest();
  if (name.size() > 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  if (!name.empty()) header.textures.emplace_back(name);
}

// One line of the header after the first. False: the last one.
bool parseHeaderLine(TextLines& lines, PlyHeader& header, bool& hasFormat) {
  const std::string_view word = lines.word();
  if (word == "end_header") return false;
  if (word == "format") {
    header.encoding = parsePlyEncoding(lines);
    hasFormat = true;
  } else if (word == "element") {
    header.elements.push_back(parsePlyElement(lines));
  } else if (word == "property") {
    if (header.elements.empty()) lines.fail("a property comes before any element");
    header.elements.back().properties.push_back(parsePlyProperty(lines));
  } else if (word == "comment") {
    parseHeaderComment(lines, header);
  }
  // Other lines are obj_info, or what careless writers left there.
  return true;
}

// Where the lines of a file end in carriage returns alone, its header with line feeds in their place.
std::string withLineFeeds(std::string_view file) {
  const std::size_t end = file.find("end_header");
  if (end == std::string_view::npos) throw LoadError("the PLY header does not end");
  std::string header(file.substr(0, std::min(file.find('\r', end), file.size() - 1) + 1));
  std::ranges::replace(header, '\r', '\n');
  return header;
}

} // namespace

std::size_t sizeOf(PlyType type) {
  constexpr std::array<std::size_t, 10> sizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

PlyHeader parsePlyHeader(std::string_view file) {
  constexpr std::string_view mark = "\xef\xbb\xbf"; // of UTF-8
  const std::size_t start = file.starts_with(mark) ? mark.size() : 0;
  file.remove_prefix(start);
  if (!file.starts_with("ply")) throw LoadError("the file does not begin with \"ply\"");
  std::string copy;
  if (file.size() > 4 && file[3] == '\r' && file[4] != '\n') copy = withLineFeeds(file);
  TextLines lines(copy.empty() ? file : copy);
  PlyHeader header;
  bool hasFormat = false;
  if (!lines.next() || lines.word() != "ply") throw LoadError("the file does not begin with \"ply\"");
  do {
    if (!lines.next()) throw LoadError("the PLY header does not end");
  } while (parseHeaderLine(lines, header, hasFormat));
  if (!hasFormat) throw LoadError("the PLY header states no format");
  header.bodyOffset = start + lines.nextLineOffset();
  return header;
}

} // namespace vitrail::tool
