// Reads a part of an OBJ file's text.
#include "obj_part.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "../message.h"
#include "number.h"
#include "number_or_nan.h"

namespace vitrail::tool::obj {

void PartReader::read() {
  Lines lines(text_);
  std::string lower;
  while (lines.next()) {
    line_ = lines.line();
    lineNumber_ = lines.number();
    std::string_view rest = line_;
    const std::string_view word = takeStatement(rest, lower);
    if (word.empty()) {
      readComment(trimmed(line_));
    } else if (word == "v") {
      readPosition(rest);
    } else if (word == "vn") {
      readNormal(rest);
    } else if (word == "vt") {
      readTexCoord(rest);
    } else if (word == "f") {
      readElement(rest, objFaces);
    } else {
      readOther(word, rest, lines.isJoined());
    }
  }
}

void PartReader::note(std::string text) {
  if (std::ranges::find(notes, text, &std::pair<std::string, std::size_t>::first) == notes.end())
    notes.emplace_back(std::move(text), lineNumber_);
}

bool PartReader::isOddValue(const char* from, const char* end) {
  const std::string_view text(from, static_cast<std::size_t>(end - from));
  return text.starts_with("#IN") || text.starts_with("#QN") || text.starts_with("#SN");
}

bool PartReader::parseOddly(std::string_view word, double& value) {
  std::string text(word);
  if (text.ends_with(',')) text.pop_back();
  if (std::ranges::count(text, ',') == 1 && text.find('.') == std::string::npos) std::ranges::replace(text, ',', '.');
  return !text.empty() && parseNumber(text.data(), text.data() + text.size(), value) == text.data() + text.size();
}

bool PartReader::more(std::string_view& line) const {
  skipBlanks(line);
  return !line.empty() && line[0] != '#';
}

std::optional<double> PartReader::tryNumber(std::string_view& line) const {
  skipBlanks(line);
  double value = 0.0;
  const char* const end = line.data() + line.size();
  const char* const stop = parseNumber(line.data(), end, value);
  if (stop != nullptr && (stop == end || isBlank(*stop) || (*stop == '#' && !isOddValue(stop, end)))) {
    line.remove_prefix(static_cast<std::size_t>(stop - line.data()));
  } else if (!parseOddly(takeWord(line), value)) {
    return std::nullopt;
  }
  if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()))) return std::nullopt;
  return value;
}

double PartReader::coordinate(std::string_view& line) const {
  if (!more(line)) fail("a number is missing");
  const std::string_view before = line;
  if (const auto value = tryNumber(line)) return *value;
  std::string_view rest = before;
  const std::string_view word = takeWord(rest);
  double value = 0.0;
  if (parseNumberOrNan(word.data(), word.data() + word.size(), value) == word.data() + word.size())
    return std::numeric_limits<double>::quiet_NaN();
  fail(fmt::format("{} is not a finite number", oneLine(word)));
}

void PartReader::readPosition(std::string_view line) {
  glm::dvec3 position;
  for (int c = 0; c < 3; ++c) position[c] = coordinate(line);
  if (std::isnan(position.x) || std::isnan(position.y) || std::isnan(position.z)) {
    position = glm::dvec3(std::numeric_limits<double>::quiet_NaN());
    ++notFinite;
  }
  positions.push_back(position);
  if (!more(line)) return;
  glm::vec4 color(1.0F);
  int count = 0;
  for (; count < 4 && more(line); ++count) {
    const auto value = tryNumber(line);
    if (!value) break;
    color[count] = static_cast<float>(*value);
  }
  // A single number is a weight, which polygons do not have.
  if (count < 3) return;
  colors.resize(positions.size(), glm::vec4(1.0F));
  colors.back() = color;
}

float PartReader::numberOrZero(std::string_view& line, const char* what) {
  if (!more(line)) fail("a number is missing");
  if (const auto value = tryNumber(line)) return static_cast<float>(*value);
  note(fmt::format("a {} is not a finite number and is left out", what));
  return 0.0F;
}

void PartReader::readTexCoord(std::string_view line) {
  const float u = numberOrZero(line, "texture coordinate");
  // v grows upwards in OBJ and downwards in glTF.
  texCoords.emplace_back(u, more(line) ? 1.0F - numberOrZero(line, "texture coordinate") : 1.0F);
}

void PartReader::readNormal(std::string_view line) {
  glm::vec3 normal;
  for (int c = 0; c < 3; ++c) normal[c] = numberOrZero(line, "normal");
  normals.push_back(normal);
}

void PartReader::readComment(std::string_view line) {
  if (!line.starts_with('#')) return;
  if (line.starts_with("#MRGB ")) {
    std::string_view digits = trimmed(line.substr(6));
    for (; digits.size() >= 8; digits.remove_prefix(8)) {
      std::uint32_t value = 0;
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + 8, value, 16);
      if (error != std::errc{} || end != digits.data() + 8) return;
      polypaint.push_back(value);
    }
  } else if (generator.empty()) {
    while (line.starts_with('#')) line.remove_prefix(1);
    generator = oneLine(trimmed(line));
  }
}

void PartReader::readElement(std::string_view line, ObjKind kind) {
  ObjElements& elements = part.elements[kind];
  std::uint32_t count = 0;
  for (; more(line); ++count) readCorner(line, elements.corners);
  elements.sizes.push_back(count);
}

void PartReader::readCorner(std::string_view& line, std::vector<ObjCorner>& corners) {
  const char* at = line.data();
  const char* const end = at + line.size();
  std::array<std::int32_t, 3> numbers{0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const bool negative = at != end && *at == '-';
    if (negative) ++at;
    const char* const digits = at;
    std::int64_t value = 0;
    for (; at != end && detail::isDigit(*at); ++at)
      if (value < 0x7fffffff) value = value * 10 + (*at - '0');
    if (at == digits && (i == 0 || negative)) return readOddCorner(line, corners);
    numbers[i] = static_cast<std::int32_t>(std::min<std::int64_t>(value, 0x7fffffff) * (negative ? -1 : 1));
    if (at == end || *at != '/') break;
    ++at;
  }
  if (at != end && !isBlank(*at) && *at != '#') return readOddCorner(line, corners);
  line.remove_prefix(static_cast<std::size_t>(at - line.data()));
  addCorner(numbers, corners);
}

void PartReader::readOddCorner(std::string_view& line, std::vector<ObjCorner>& corners) {
  const std::array<std::string_view, 3> words = splitCorner(takeWord(line));
  std::array<std::int32_t, 3> numbers{0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0 && words[i].empty()) continue;
    std::int64_t value = 0;
    if (!parseWhole(words[i], value))
      fail(fmt::format("\"{}\" is not the number of a {}", oneLine(words[i]), attributeNames[i]));
    numbers[i] = static_cast<std::int32_t>(std::clamp<std::int64_t>(value, -0x7fffffff, 0x7fffffff));
  }
  addCorner(numbers, corners);
}

void PartReader::addCorner(const std::array<std::int32_t, 3>& numbers, std::vector<ObjCorner>& corners) {
  const std::array<std::size_t, 3> soFar{positions.size(), texCoords.size(), normals.size()};
  std::array<std::int32_t, 3> indices{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t relative = static_cast<std::int64_t>(soFar[i]) + numbers[i];
    if (numbers[i] >= 0)
      indices[i] = numbers[i] - 1;
    else
      indices[i] = relative > -mostVertices ? relativeBase + static_cast<std::int32_t>(relative) : noSuch;
  }
  if (numbers[0] == 0) indices[0] = noSuch;
  corners.push_back({indices[0], indices[1], indices[2]});
}

void PartReader::readOther(std::string_view word, std::string_view rest, bool joined) {
  constexpr std::array<std::string_view, 25> harmless{
      "g",         "o",     "mg",    "vp",     "lod", "bevel",  "c_interp", "d_interp", "shadow_obj",
      "trace_obj", "ctech", "stech", "cstype", "deg", "bmat",   "step",     "parm",     "trim",
      "hole",      "scrv",  "sp",    "con",    "end", "usemap", "maplib"};
  constexpr std::array<std::string_view, 7> freeForm{"curv", "curv2", "surf", "bsp", "bzp", "cdc", "cdp"};
  if (const auto kind = kindOf(word)) {
    readElement(rest, *kind);
  } else if (word == "usemtl") {
    state(ObjStatement::Kind::Material, rest, joined);
  } else if (word == "mtllib") {
    state(ObjStatement::Kind::Library, rest, joined);
  } else if (word == "s") {
    state(ObjStatement::Kind::Smoothing, rest, joined);
  } else if (std::ranges::find(freeForm, word) != freeForm.end()) {
    note("curves and free-form surfaces are left out");
  } else if (word == "call" || word == "csh") {
    note(fmt::format("\"{}\" is not followed: what it would add is left out", word));
  } else if (std::ranges::find(harmless, word) == harmless.end()) {
    if (!std::exchange(hasUnknown_, true))
      note(fmt::format("\"{}\" is no statement of OBJ and is passed over", oneLine(word)));
  }
}

void PartReader::state(ObjStatement::Kind kind, std::string_view text, bool joined) {
  if (joined) text = part.joined.emplace_back(text);
  ObjStatement statement{kind, trimmed(text), {}};
  for (std::size_t i = 0; i < objKindCount; ++i) statement.before[i] = part.elements[i].sizes.size();
  part.statements.push_back(statement);
}

} // namespace vitrail::tool::obj
