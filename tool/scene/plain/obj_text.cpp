// Reads the text of OBJ files.
#include "obj_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "../load.h"
#include "../message.h"
#include "../srgb.h"
#include "letters.h"
#include "number.h"

namespace vitrail::tool {
namespace {

constexpr std::int32_t noSuch = std::numeric_limits<std::int32_t>::min();

bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

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

void skipBlanks(std::string_view& line) {
  std::size_t i = 0;
  while (i < line.size() && isBlank(line[i])) ++i;
  line.remove_prefix(i);
}

// The next word of a line, without the blanks around it; empty at its end and before a comment.
std::string_view takeWord(std::string_view& line) {
  skipBlanks(line);
  std::size_t i = 0;
  if (!line.starts_with('#'))
    while (i < line.size() && !isBlank(line[i])) ++i;
  const std::string_view word = line.substr(0, i);
  line.remove_prefix(i);
  return word;
}

// The word that says what a line is, in lower case.
std::string_view takeStatement(std::string_view& line, std::string& lower) {
  const std::string_view word = takeWord(line);
  if (word.empty() || word[0] < 'A' || word[0] > 'Z') return word;
  lower = lowerCase(word);
  return lower;
}

std::string_view trimmed(std::string_view text) {
  skipBlanks(text);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

// What a line is wrong in. Its place is counted from the start of its part.
struct LineError {
  std::size_t line;
  std::string problem;
};

std::optional<ObjKind> kindOf(std::string_view word) {
  if (word == "f" || word == "fo") return objFaces; // "fo": the faces of the format's first version
  if (word == "l") return objLines;
  if (word == "p") return objPoints;
  return std::nullopt;
}

constexpr std::array<const char*, 3> attributeNames{"vertex", "texture coordinate", "normal"};

// The parts of a corner such as "7", "7/2", "7/2/3" or "7//3".
std::array<std::string_view, 3> splitCorner(std::string_view word) {
  std::array<std::string_view, 3> parts;
  for (std::string_view& part : parts) {
    const std::size_t slash = std::min(word.find('/'), word.size());
    part = word.substr(0, slash);
    word.remove_prefix(std::min(slash + 1, word.size()));
  }
  return parts;
}

bool parseWhole(std::string_view word, std::int64_t& number) {
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

  void read() {
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

  ObjPart part;
  std::vector<glm::dvec3> positions;
  std::vector<glm::vec4> colors; // as they stand in the file; may be fewer than the positions
  std::vector<glm::vec2> texCoords;
  std::vector<glm::vec3> normals;
  std::vector<std::uint32_t> polypaint;                        // ZBrush's colours of the vertices so far
  std::array<std::vector<std::size_t>, objKindCount> relative; // three times a corner, and which of its numbers
  std::string generator;
  std::vector<std::pair<std::string, std::size_t>> notes; // warnings and their lines, in their order

 private:
  [[noreturn]] void fail(std::string problem) const { throw LineError{lineNumber_, std::move(problem)}; }

  void note(std::string text) {
    if (std::ranges::find(notes, text, &std::pair<std::string, std::size_t>::first) == notes.end())
      notes.emplace_back(std::move(text), lineNumber_);
  }

  // "1.#IND", "-1.#QNAN" and "1.#INF" are what old C libraries of Microsoft write.
  static bool isOddValue(const char* from, const char* end) {
    const std::string_view text(from, static_cast<std::size_t>(end - from));
    return text.starts_with("#IN") || text.starts_with("#QN") || text.starts_with("#SN");
  }

  // Some write commas after numbers or in the place of points.
  static bool parseOddly(std::string_view word, double& value) {
    std::string text(word);
    if (text.ends_with(',')) text.pop_back();
    if (std::ranges::count(text, ',') == 1 && text.find('.') == std::string::npos) std::ranges::replace(text, ',', '.');
    return !text.empty() && parseNumber(text.data(), text.data() + text.size(), value) == text.data() + text.size();
  }

  // False at the end of the line.
  bool more(std::string_view& line) const {
    skipBlanks(line);
    return !line.empty() && line[0] != '#';
  }

  // The next word as a number; none where it is another word or not a finite 32-bit float.
  std::optional<double> tryNumber(std::string_view& line) const {
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

  double number(std::string_view& line) const {
    if (!more(line)) fail("a number is missing");
    const std::string_view before = line;
    if (const auto value = tryNumber(line)) return *value;
    std::string_view rest = before;
    fail(fmt::format("{} is not a finite number", oneLine(takeWord(rest))));
  }

  void readPosition(std::string_view line) {
    glm::dvec3 position;
    for (int c = 0; c < 3; ++c) position[c] = number(line);
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

  // Some programs write "nan" for what they cannot compute.
  float numberOrZero(std::string_view& line, const char* what) {
    if (!more(line)) fail("a number is missing");
    if (const auto value = tryNumber(line)) return static_cast<float>(*value);
    note(fmt::format("a {} is not a finite number and is left out", what));
    return 0.0F;
  }

  void readTexCoord(std::string_view line) {
    const float u = numberOrZero(line, "texture coordinate");
    // v grows upwards in OBJ and downwards in glTF.
    texCoords.emplace_back(u, more(line) ? 1.0F - numberOrZero(line, "texture coordinate") : 1.0F);
  }

  void readNormal(std::string_view line) {
    glm::vec3 normal;
    for (int c = 0; c < 3; ++c) normal[c] = numberOrZero(line, "normal");
    normals.push_back(normal);
  }

  // ZBrush: "#MRGB " and up to 64 times the mask, red, green and blue of a vertex, in hexadecimal digits.
  void readComment(std::string_view line) {
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

  void readElement(std::string_view line, ObjKind kind) {
    ObjElements& elements = part.elements[kind];
    std::uint32_t count = 0;
    for (; more(line); ++count) readCorner(line, kind, elements.corners);
    elements.sizes.push_back(count);
  }

  void readCorner(std::string_view& line, ObjKind kind, std::vector<ObjCorner>& corners) {
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
      if (at == digits && (i == 0 || negative)) return readOddCorner(line, kind, corners);
      numbers[i] = static_cast<std::int32_t>(std::min<std::int64_t>(value, 0x7fffffff) * (negative ? -1 : 1));
      if (at == end || *at != '/') break;
      ++at;
    }
    if (at != end && !isBlank(*at) && *at != '#') return readOddCorner(line, kind, corners);
    line.remove_prefix(static_cast<std::size_t>(at - line.data()));
    addCorner(numbers, kind, corners);
  }

  void readOddCorner(std::string_view& line, ObjKind kind, std::vector<ObjCorner>& corners) {
    const std::array<std::string_view, 3> words = splitCorner(takeWord(line));
    std::array<std::int32_t, 3> numbers{0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
      if (i > 0 && words[i].empty()) continue;
      std::int64_t value = 0;
      if (!parseWhole(words[i], value))
        fail(fmt::format("\"{}\" is not the number of a {}", oneLine(words[i]), attributeNames[i]));
      numbers[i] = static_cast<std::int32_t>(std::clamp<std::int64_t>(value, -0x7fffffff, 0x7fffffff));
    }
    addCorner(numbers, kind, corners);
  }

  void addCorner(const std::array<std::int32_t, 3>& numbers, ObjKind kind, std::vector<ObjCorner>& corners) {
    const std::array<std::size_t, 3> soFar{positions.size(), texCoords.size(), normals.size()};
    std::array<std::int32_t, 3> indices{};
    for (std::size_t i = 0; i < 3; ++i) {
      indices[i] = numbers[i] - 1;
      if (numbers[i] >= 0) continue;
      relative[kind].push_back(3 * corners.size() + i);
      indices[i] = static_cast<std::int32_t>(static_cast<std::int64_t>(soFar[i]) + numbers[i]);
    }
    if (numbers[0] == 0) indices[0] = noSuch;
    corners.push_back({indices[0], indices[1], indices[2]});
  }

  void readOther(std::string_view word, std::string_view rest, bool joined) {
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

  void state(ObjStatement::Kind kind, std::string_view text, bool joined) {
    if (joined) text = part.joined.emplace_back(text);
    ObjStatement statement{kind, trimmed(text), {}};
    for (std::size_t i = 0; i < objKindCount; ++i) statement.before[i] = part.elements[i].sizes.size();
    part.statements.push_back(statement);
  }

  std::string_view text_;
  std::string_view line_;
  std::size_t lineNumber_ = 0;
  bool hasUnknown_ = false;
};

// Parts of about the same size that end where lines do.
std::vector<std::string_view> splitText(std::string_view text, std::size_t count) {
  std::vector<std::string_view> parts;
  for (std::size_t left = count; left > 1 && !text.empty(); --left) {
    std::size_t end = text.find('\n', text.size() / left);
    // A line that goes on stays whole.
    const auto goesOn = [&text](std::size_t at) {
      if (at > 0 && text[at - 1] == '\r') --at;
      return at > 0 && text[at - 1] == '\\';
    };
    while (end != std::string_view::npos && goesOn(end)) end = text.find('\n', end + 1);
    if (end == std::string_view::npos) break;
    parts.push_back(text.substr(0, end + 1));
    text.remove_prefix(end + 1);
  }
  parts.push_back(text);
  return parts;
}

// Calls `work` once for each number below `count`, each in a thread of its own.
template <typename Work>
void inThreads(std::size_t count, const Work& work) {
  std::vector<std::exception_ptr> failures(count);
  const auto guarded = [&](std::size_t i) {
    try {
      work(i);
    } catch (...) {
      failures[i] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < count; ++i) threads.emplace_back(guarded, i);
    guarded(0);
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

// A corner that names what is not there.
struct BadCorner {
  ObjKind kind;
  std::size_t corner;
};

// The parts of a text, put together.
class TextReader {
 public:
  explicit TextReader(std::string_view text) : texts_(splitText(text, partCount(text.size()))) {
    for (const std::string_view part : texts_) readers_.emplace_back(part);
    before_.resize(texts_.size());
    bad_.resize(texts_.size());
  }

  ObjText read() {
    std::vector<std::optional<LineError>> errors(texts_.size());
    inThreads(texts_.size(), [&](std::size_t i) {
      try {
        readers_[i].read();
      } catch (const LineError& error) {
        errors[i] = error;
      }
    });
    for (std::size_t i = 0; i < errors.size(); ++i)
      if (errors[i]) fail(linesBefore(i) + errors[i]->line, errors[i]->problem);
    count();
    gatherColors();
    inThreads(texts_.size(), [this](std::size_t i) { finishPart(i); });
    reportMissing();
    return gather();
  }

 private:
  static std::size_t partCount(std::size_t bytes) {
    constexpr std::size_t worthAThread = 1U << 20U;
    constexpr std::size_t most = 16;
    return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1,
                                   std::clamp<std::size_t>(bytes / worthAThread, 1, most));
  }

  [[noreturn]] static void fail(std::size_t line, const std::string& problem) {
    throw LoadError(fmt::format("line {}: {}", line, problem));
  }

  std::size_t linesBefore(std::size_t part) const {
    std::size_t lines = 0;
    for (std::size_t i = 0; i < part; ++i) lines += static_cast<std::size_t>(std::ranges::count(texts_[i], '\n'));
    return lines;
  }

  void count() {
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      before_[i] = total_;
      const PartReader& reader = readers_[i];
      total_[0] += static_cast<std::int64_t>(reader.positions.size());
      total_[1] += static_cast<std::int64_t>(reader.texCoords.size());
      total_[2] += static_cast<std::int64_t>(reader.normals.size());
    }
    for (const std::int64_t count : total_)
      if (count >= std::numeric_limits<std::int32_t>::max())
        throw LoadError(fmt::format("{} vertices are too many", count));
  }

  // Whether vertices have colours, and whether those reach to 255 rather than to 1.
  void gatherColors() {
    float brightest = 0.0F;
    float mostAlpha = 0.0F;
    std::size_t painted = 0;
    for (const PartReader& reader : readers_) {
      colored_ = colored_ || !reader.colors.empty();
      painted += reader.polypaint.size();
      for (const glm::vec4& color : reader.colors) {
        brightest = std::max({brightest, color.r, color.g, color.b});
        mostAlpha = std::max(mostAlpha, color.a);
      }
    }
    if (brightest > 2.0F) colorScale_ = 1.0F / 255.0F;
    if (brightest > 2.0F && mostAlpha > 1.0F) alphaScale_ = 1.0F / 255.0F;
    painted_ = !colored_ && painted > 0;
  }

  void finishPart(std::size_t i) {
    PartReader& reader = readers_[i];
    if (colored_) {
      for (glm::vec4& color : reader.colors)
        color =
            glm::vec4(linearFromSrgb(glm::vec3(color) * colorScale_), glm::clamp(color.a * alphaScale_, 0.0F, 1.0F));
      reader.colors.resize(reader.positions.size(), glm::vec4(1.0F));
    }
    for (std::size_t kind = 0; kind < objKindCount; ++kind) {
      std::vector<ObjCorner>& corners = reader.part.elements[kind].corners;
      for (const std::size_t place : reader.relative[kind]) {
        ObjCorner& corner = corners[place / 3];
        const std::size_t which = place % 3;
        std::int32_t& index = which == 0 ? corner.position : which == 1 ? corner.texCoord : corner.normal;
        const std::int64_t absolute = index + before_[i][which];
        index = absolute < 0 ? noSuch : static_cast<std::int32_t>(absolute);
      }
      reader.relative[kind] = {};
      checkCorners(corners, static_cast<ObjKind>(kind), bad_[i]);
    }
  }

  using Bad = std::array<std::optional<BadCorner>, 3>; // the first, by attribute

  void checkCorners(std::vector<ObjCorner>& corners, ObjKind kind, Bad& bad) const {
    const auto positions = static_cast<std::uint32_t>(total_[0]);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      ObjCorner& corner = corners[i];
      if (static_cast<std::uint32_t>(corner.position) >= positions && !bad[0]) bad[0] = {kind, i};
      if (corner.texCoord != -1 && (corner.texCoord < 0 || corner.texCoord >= total_[1])) {
        if (!bad[1]) bad[1] = {kind, i};
        corner.texCoord = -1;
      }
      if (corner.normal != -1 && (corner.normal < 0 || corner.normal >= total_[2])) {
        if (!bad[2]) bad[2] = {kind, i};
        corner.normal = -1;
      }
    }
  }

  // Says what a corner names, by reading its part once more.
  std::pair<std::size_t, std::string> describe(std::size_t part, const BadCorner& bad, std::size_t which) const {
    constexpr std::array<const char*, objKindCount> kindNames{"face", "line", "point"};
    Counts soFar = before_[part];
    std::size_t corner = 0;
    Lines lines(texts_[part]);
    std::string lower;
    while (lines.next()) {
      std::string_view rest = lines.line();
      const std::string_view statement = takeStatement(rest, lower);
      if (statement == "v") ++soFar[0];
      if (statement == "vt") ++soFar[1];
      if (statement == "vn") ++soFar[2];
      if (kindOf(statement) != bad.kind) continue;
      for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest), ++corner) {
        if (corner != bad.corner) continue;
        std::int64_t number = 0;
        parseWhole(splitCorner(word)[which], number);
        return {linesBefore(part) + lines.number(),
                fmt::format("a {} names {} {}, but there are {}", kindNames[bad.kind], attributeNames[which], number,
                            number < 0 ? soFar[which] : total_[which])};
      }
    }
    return {0, {}}; // the part was read before
  }

  void reportMissing() {
    for (std::size_t which = 0; which < 3; ++which)
      for (std::size_t i = 0; i < bad_.size(); ++i) {
        if (!bad_[i][which]) continue;
        const auto [line, problem] = describe(i, *bad_[i][which], which);
        if (which == 0) fail(line, problem);
        warnings_.push_back(fmt::format("line {}: {}; it is drawn without, and so are others like it", line, problem));
        break;
      }
  }

  template <typename T>
  std::vector<T> joined(std::vector<T> PartReader::*member) {
    if (readers_.size() == 1) return std::move(readers_[0].*member);
    std::size_t count = 0;
    for (PartReader& reader : readers_) count += (reader.*member).size();
    std::vector<T> all;
    all.reserve(count);
    for (PartReader& reader : readers_) {
      all.insert(all.end(), (reader.*member).begin(), (reader.*member).end());
      reader.*member = {};
    }
    return all;
  }

  ObjText gather() {
    ObjText text;
    text.positions = joined(&PartReader::positions);
    text.texCoords = joined(&PartReader::texCoords);
    text.normals = joined(&PartReader::normals);
    if (colored_) text.colors = joined(&PartReader::colors);
    if (painted_) text.colors = painted(text.positions.size());
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      PartReader& reader = readers_[i];
      if (text.generator.empty()) text.generator = std::move(reader.generator);
      for (const auto& [note, line] : reader.notes)
        if (isNew(note)) warnings_.push_back(fmt::format("line {}: {}", linesBefore(i) + line, note));
      text.parts.push_back(std::move(reader.part));
    }
    text.warnings = std::move(warnings_);
    return text;
  }

  std::vector<glm::vec4> painted(std::size_t count) {
    std::vector<std::uint32_t> paint = joined(&PartReader::polypaint);
    paint.resize(count, 0xffffff);
    std::vector<glm::vec4> colors;
    colors.reserve(count);
    for (const std::uint32_t value : paint) {
      const glm::vec3 srgb(value >> 16U & 0xffU, value >> 8U & 0xffU, value & 0xffU);
      colors.emplace_back(linearFromSrgb(srgb / 255.0F), 1.0F);
    }
    return colors;
  }

  bool isNew(const std::string& note) {
    if (std::ranges::find(notes_, note) != notes_.end()) return false;
    notes_.push_back(note);
    return true;
  }

  std::vector<std::string_view> texts_;
  std::vector<PartReader> readers_;
  std::vector<Counts> before_; // what the parts before each hold
  std::vector<Bad> bad_;
  Counts total_{};
  bool colored_ = false;
  bool painted_ = false;
  float colorScale_ = 1.0F;
  float alphaScale_ = 1.0F;
  std::vector<std::string> notes_;
  std::vector<std::string> warnings_;
};

} // namespace

ObjText readObjText(std::string_view text) { return TextReader(text).read(); }

} // namespace vitrail::tool
