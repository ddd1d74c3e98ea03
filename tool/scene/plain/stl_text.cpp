// Reads the facets of text STL files.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "../load.h"
#include "../message.h"
#include "../threads.h"
#include "number_or_nan.h"
#include "stl_facets.h"

namespace vitrail::tool {
namespace {

// Whether a word is this one in any letter case. `lower` consists of letters.
bool isWord(std::string_view word, std::string_view lower) {
  if (word.size() != lower.size()) return false;
  for (std::size_t i = 0; i < lower.size(); ++i)
    if ((word[i] | 0x20) != lower[i]) return false;
  return true;
}

// A part of the text, word by word. Words of no meaning here, as those of normals, are passed over.
class StlTextParser {
 public:
  StlTextParser(std::string_view whole, std::string_view part, const glm::dvec3& origin)
      : whole_(whole), at_(part.data()), end_(part.data() + part.size()), origin_(origin) {}

  StlFacets parse() {
    try {
      parseWords();
    } catch (const CutOff&) {
      inLoop_ = true;
    }
    // Whole facets before the end of the file are drawn.
    const bool last = end_ == whole_.data() + whole_.size();
    facets_.cutOff = last && (inLoop_ || facetOpen_) && !facets_.indices.empty();
    if (inLoop_ && !facets_.cutOff) fail("the file ends inside a loop");
    return std::move(facets_);
  }

 private:
  struct CutOff {};

  void parseWords() {
    for (std::string_view word = next(); !word.empty(); word = next()) {
      switch (word[0] | 0x20) {
        case 'v':
          if (isWord(word, "vertex")) addVertex();
          break;
        case 'o':
          if (isWord(word, "outer") || isWord(word, "outerloop")) beginLoop();
          break;
        case 'f':
          if (isWord(word, "facet")) beginFacet();
          break;
        case 'e':
          end(word);
          break;
        case 's':
          if (isWord(word, "solid")) skipName();
          break;
        default:
          break;
      }
    }
  }

  std::string_view next() {
    while (at_ != end_ && endsWord(*at_)) ++at_;
    const char* const begin = at_;
    while (at_ != end_ && !endsWord(*at_)) ++at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
  }

  void beginFacet() {
    if (inLoop_) fail("a facet begins inside a loop");
    facetOpen_ = true;
  }

  void beginLoop() {
    if (inLoop_) fail("a loop begins inside a loop");
    inLoop_ = true;
    facetOpen_ = false;
    corners_ = 0;
  }

  void addVertex() {
    if (!inLoop_) fail("a vertex stands outside of a loop");
    if (corners_ == 3) fail("a loop has more than 3 vertices");
    for (int c = 0; c < 3; ++c) places_[corners_][c] = number();
    ++corners_;
  }

  double number() {
    while (at_ != end_ && endsWord(*at_) && !endsLine(*at_)) ++at_;
    double value = 0.0;
    const char* const after = parseNumberOrNan(at_, end_, value);
    if (after != nullptr && (after == end_ || endsWord(*after))) {
      at_ = after;
      return value;
    }
    const char* const wordEnd = std::find_if(at_, end_, endsWord);
    if (wordEnd == end_) throw CutOff();
    const std::string_view word(at_, static_cast<std::size_t>(wordEnd - at_));
    if (word.empty()) fail("a number is missing");
    fail(fmt::format("{} is not a number{}", oneLine(word),
                     word.find(',') != std::string_view::npos ? ": decimals follow a point, not a comma" : ""));
  }

  // Some programs write "end loop" in two words.
  void end(std::string_view word) {
    if (isWord(word, "end")) {
      const std::string_view what = next();
      if (isWord(what, "loop")) endLoop();
      if (isWord(what, "solid")) skipName();
    } else if (isWord(word, "endloop")) {
      endLoop();
    } else if (isWord(word, "endsolid")) {
      skipName();
    }
  }

  void endLoop() {
    if (!inLoop_ || corners_ != 3) fail("a loop ends without 3 vertices");
    inLoop_ = false;
    facets_.add(places_, origin_, 0);
  }

  // What follows "solid" on its line is a name, and may hold any word; but not where all is on one line.
  void skipName() {
    while (at_ != end_ && !endsLine(*at_)) {
      const char* const begin = at_;
      if (isWord(next(), "facet")) {
        while (at_ != end_ && endsWord(*at_) && !endsLine(*at_)) ++at_;
        const char* const behind = at_;
        if (behind != end_ && !endsLine(*behind) && isWord(next(), "normal")) {
          at_ = begin;
          return;
        }
        at_ = behind;
      }
      while (at_ != end_ && endsWord(*at_) && !endsLine(*at_)) ++at_;
    }
  }

  [[noreturn]] void fail(std::string_view problem) const {
    std::string_view before(whole_.data(), static_cast<std::size_t>(at_ - whole_.data()));
    // The end of the last line is no line of its own.
    if (at_ == end_ && !before.empty() && endsLine(before.back())) before.remove_suffix(1);
    const auto feeds = std::ranges::count(before, '\n');
    throw LoadError(fmt::format("line {}: {}", 1 + (feeds > 0 ? feeds : std::ranges::count(before, '\r')), problem));
  }

  std::string_view whole_;
  const char* at_;
  const char* end_;
  glm::dvec3 origin_;
  StlFacets facets_;
  std::array<glm::dvec3, 3> places_{};
  std::size_t corners_ = 0; // of the loop that is open
  bool inLoop_ = false;
  bool facetOpen_ = false; // its loop has not begun
};

// Where the first facet begins whose line begins behind `from`.
std::size_t facetBehind(std::string_view text, std::size_t from) {
  while (true) {
    from = text.find('\n', from);
    if (from == std::string_view::npos) return text.size();
    ++from;
    const std::size_t word = std::min(text.find_first_not_of(" \t", from), text.size());
    if (isWord(text.substr(word, 5), "facet") && word + 5 < text.size() && endsWord(text[word + 5])) return from;
  }
}

} // namespace

StlFacets readStlText(std::string_view text, const glm::dvec3& origin) {
  constexpr std::size_t leastBytes = std::size_t{1} << 20U;
  const std::size_t count = partsFor(text.size(), leastBytes);
  std::vector<std::size_t> begins(count + 1, 0);
  for (std::size_t i = 1; i < count; ++i)
    begins[i] = facetBehind(text, std::max(begins[i - 1], i * (text.size() / count)));
  begins[count] = text.size();
  std::vector<StlFacets> parts(count);
  try {
    inParts(count, [&](std::size_t i) {
      parts[i] = StlTextParser(text, text.substr(begins[i], begins[i + 1] - begins[i]), origin).parse();
    });
  } catch (const LoadError&) {
    // What is wrong is said as if the file had been read in one piece.
    return StlTextParser(text, text, origin).parse();
  }
  for (std::size_t i = 1; i < count; ++i) parts[0].append(std::move(parts[i]));
  return std::move(parts[0]);
}

} // namespace vitrail::tool
