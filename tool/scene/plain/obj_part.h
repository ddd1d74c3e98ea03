// Reads a part of an OBJ file's text.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "obj_lines.h"
#include "obj_text.h"

namespace vitrail::tool::obj {

// Indices before the parts of a text are put together: -1: none; what counts backwards is relative to the start of its
// part, plus a base that tells it from the others.
inline constexpr std::int32_t noSuch = std::numeric_limits<std::int32_t>::min();
inline constexpr std::int32_t relativeBase = -(1 << 30);
inline constexpr std::int32_t mostVertices = 1 << 29;

// What a line is wrong in. Its place is counted from the start of its part.
struct LineError {
  std::size_t line;
  std::string problem;
};

inline std::optional<ObjKind> kindOf(std::string_view word) {
  if (word == "f" || word == "fo") return objFaces; // "fo": the faces of the format's first version
  if (word == "l") return objLines;
  if (word == "p") return objPoints;
  return std::nullopt;
}

inline constexpr std::array<const char*, 3> attributeNames{"vertex", "texture coordinate", "normal"};

// The parts of a corner such as "7", "7/2", "7/2/3" or "7//3".
inline std::array<std::string_view, 3> splitCorner(std::string_view word) {
  std::array<std::string_view, 3> parts;
  for (std::string_view& part : parts) {
    const std::size_t slash = std::min(word.find('/'), word.size());
    part = word.substr(0, slash);
    word.remove_prefix(std::min(slash + 1, word.size()));
  }
  return parts;
}

inline bool parseWhole(std::string_view word, std::int64_t& number) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return !word.empty() && error == std::errc{} && end == word.data() + word.size();
}

using Counts = std::array<std::int64_t, 3>; // positions, texture coordinates, normals

// What one thread reads: a part of the text, as if it were the whole. Numbers that count backwards may reach into the
// parts before it, which are not known yet.
class PartReader {
 public:
  explicit PartReader(std::string_view text) : text_(text) {}

  void read();

  ObjPart part;
  std::vector<glm::dvec3> positions; // of NaN where one is not finite
  std::size_t notFinite = 0;         // how many are not
  std::vector<glm::vec4> colors;     // as they stand in the file; may be fewer than the positions
  std::vector<glm::vec2> texCoords;
  std::vector<glm::vec3> normals;
  std::vector<std::uint32_t> polypaint; // ZBrush's colours of the vertices so far
  std::string generator;
  std::vector<std::pair<std::string, std::size_t>> notes; // warnings and their lines, in their order

 private:
  [[noreturn]] void fail(std::string problem) const { throw LineError{lineNumber_, std::move(problem)}; }

  void note(std::string text);

  // "1.#IND", "-1.#QNAN" and "1.#INF" are what old C libraries of Microsoft write.
  static bool isOddValue(const char* from, const char* end);

  // Some write commas after numbers or in the place of points.
  static bool parseOddly(std::string_view word, double& value);

  // False at the end of the line.
  bool more(std::string_view& line) const;

  // The next word as a number; none where it is another word or not a finite 32-bit float.
  std::optional<double> tryNumber(std::string_view& line) const;
  // Not a number where the file has one that is not finite.
  double coordinate(std::string_view& line) const;
  void readPosition(std::string_view line);

  // Some programs write "nan" for what they cannot compute.
  float numberOrZero(std::string_view& line, const char* what);
  void readTexCoord(std::string_view line);
  void readNormal(std::string_view line);

  // ZBrush: "#MRGB " and up to 64 times the mask, red, green and blue of a vertex, in hexadecimal digits.
  void readComment(std::string_view line);
  void readElement(std::string_view line, ObjKind kind);
  void readCorner(std::string_view& line, std::vector<ObjCorner>& corners);
  void readOddCorner(std::string_view& line, std::vector<ObjCorner>& corners);
  void addCorner(const std::array<std::int32_t, 3>& numbers, std::vector<ObjCorner>& corners);
  void readOther(std::string_view word, std::string_view rest, bool joined);
  void state(ObjStatement::Kind kind, std::string_view text, bool joined);

  std::string_view text_;
  std::string_view line_;
  std::size_t lineNumber_ = 0;
  bool hasUnknown_ = false;
};

} // namespace vitrail::tool::obj
