// Puts together what the parts of an OBJ file's text state.
#include "obj_text.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "../load.h"
#include "../srgb.h"
#include "obj_lines.h"
#include "obj_part.h"

namespace vitrail::tool {
namespace obj {
namespace {

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
      if (count >= mostVertices) throw LoadError(fmt::format("{} vertices are too many", count));
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
    for (std::size_t kind = 0; kind < objKindCount; ++kind)
      checkCorners(reader.part.elements[kind].corners, static_cast<ObjKind>(kind), before_[i], bad_[i]);
  }

  using Bad = std::array<std::optional<BadCorner>, 3>; // the first, by attribute

  // An index from the start of the text, where there is such an element.
  static std::int32_t resolved(std::int32_t index, std::int64_t before, std::int64_t total) {
    std::int64_t absolute = index;
    if (index < -1 && index != noSuch) absolute = std::int64_t{index} - relativeBase + before;
    return absolute >= 0 && absolute < total ? static_cast<std::int32_t>(absolute) : noSuch;
  }

  void checkCorners(std::vector<ObjCorner>& corners, ObjKind kind, const Counts& before, Bad& bad) const {
    const auto note = [&](std::size_t which, std::size_t corner) {
      if (!bad[which]) bad[which] = {kind, corner};
    };
    for (std::size_t i = 0; i < corners.size(); ++i) {
      ObjCorner& corner = corners[i];
      corner.position = resolved(corner.position, before[0], total_[0]);
      if (corner.position == noSuch) note(0, i);
      if (corner.texCoord != -1) {
        corner.texCoord = resolved(corner.texCoord, before[1], total_[1]);
        if (corner.texCoord == noSuch) note(1, i);
        corner.texCoord = std::max(corner.texCoord, -1);
      }
      if (corner.normal != -1) {
        corner.normal = resolved(corner.normal, before[2], total_[2]);
        if (corner.normal == noSuch) note(2, i);
        corner.normal = std::max(corner.normal, -1);
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
      text.notFinite += reader.notFinite;
      if (text.generator.empty()) text.generator = std::move(reader.generator);
      for (const auto& [note, line] : reader.notes)
        if (isNew(note)) warnings_.push_back(fmt::format("line {}: {}", linesBefore(i) + line, note));
      text.parts.push_back(std::move(reader.part));
    }
    if (text.notFinite > 0) reportNotFinite(text);
    text.warnings = std::move(warnings_);
    return text;
  }

  void reportNotFinite(const ObjText& text) {
    constexpr std::array<const char*, objKindCount> names{"faces", "lines", "points"};
    bool any = false;
    std::string list;
    for (std::size_t kind = 0; kind < objKindCount; ++kind) {
      std::size_t all = 0;
      std::size_t left = 0;
      for (const ObjPart& part : text.parts) {
        const ObjCorner* corner = part.elements[kind].corners.data();
        for (const std::uint32_t size : part.elements[kind].sizes) {
          const std::span corners(corner, size);
          all += kind == objPoints ? size : 1;
          if (kind == objPoints)
            left += static_cast<std::size_t>(
                std::ranges::count_if(corners, [&](const ObjCorner& point) { return !text.isFinite(point); }));
          else
            left += text.isFinite(corners) ? 0 : 1;
          corner += size;
        }
      }
      any = any || all > 0;
      if (left > 0) list += fmt::format("{}{} of {} {}", list.empty() ? "" : ", ", left, all, names[kind]);
    }
    if (!any) list = fmt::format("{} of {} points", text.notFinite, text.positions.size());
    if (!list.empty()) warnings_.push_back("left out, since a vertex is not finite: " + list);
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
} // namespace obj

ObjText readObjText(std::string_view text) { return obj::TextReader(text).read(); }

} // namespace vitrail::tool
