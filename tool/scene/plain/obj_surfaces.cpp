// Sorts the elements of an OBJ file by their materials.
#include "obj_surfaces.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

namespace vitrail::tool {
namespace {

class Surfaces {
 public:
  Surfaces(const ObjText& text, ObjLibraries& libraries) : text_(text), libraries_(libraries) {
    for (const ObjPart& part : text.parts)
      for (const ObjStatement& statement : part.statements)
        if (statement.kind == ObjStatement::Kind::Library) libraries.add(statement.text);
  }

  std::vector<ObjSurface> read() {
    for (std::size_t i = 0; i < text_.parts.size(); ++i) {
      done_ = {};
      corners_ = {};
      for (const ObjStatement& statement : text_.parts[i].statements) {
        takeUntil(i, statement.before);
        obey(statement);
      }
      std::array<std::size_t, objKindCount> all{};
      for (std::size_t kind = 0; kind < objKindCount; ++kind) all[kind] = text_.parts[i].elements[kind].sizes.size();
      takeUntil(i, all);
    }
    return std::move(surfaces_);
  }

 private:
  void obey(const ObjStatement& statement) {
    switch (statement.kind) {
      case ObjStatement::Kind::Library:
        ++groupsSoFar_;
        break;
      case ObjStatement::Kind::Material:
        material_ = statement.text;
        current_.reset();
        break;
      case ObjStatement::Kind::Smoothing:
        smoothing_ = ObjSmoothing::off; // also "off" and what is no number
        std::from_chars(statement.text.data(), statement.text.data() + statement.text.size(), smoothing_);
        smoothing_ = std::max(smoothing_, ObjSmoothing::off);
        break;
    }
  }

  void takeUntil(std::size_t part, const std::array<std::size_t, objKindCount>& end) {
    for (std::size_t kind = 0; kind < objKindCount; ++kind) {
      if (end[kind] == done_[kind]) continue;
      ObjSurface& surface = surfaces_[surfaceIndex()];
      std::vector<ObjRun>& runs = kind == objFaces   ? surface.faces[smoothing_]
                                  : kind == objLines ? surface.lines
                                                     : surface.points;
      runs.push_back({part, done_[kind], end[kind] - done_[kind], corners_[kind]});
      const std::vector<std::uint32_t>& sizes = text_.parts[part].elements[kind].sizes;
      for (std::size_t i = done_[kind]; i < end[kind]; ++i) corners_[kind] += sizes[i];
      done_[kind] = end[kind];
    }
  }

  std::size_t surfaceIndex() {
    if (current_) return *current_;
    ObjLibraries::Found found = libraries_.find(material_, groupsSoFar_);
    std::string name(material_);
    if (found.material == nullptr && beforeComment(material_).size() != material_.size()) {
      found = libraries_.find(beforeComment(material_), groupsSoFar_);
      name = beforeComment(material_);
    }
    const auto [place, isNew] = byName_.try_emplace({found.material, name}, surfaces_.size());
    if (isNew) surfaces_.push_back({name, found, {}, {}, {}});
    current_ = place->second;
    return *current_;
  }

  const ObjText& text_;
  ObjLibraries& libraries_;
  std::vector<ObjSurface> surfaces_; // as they come in the file
  std::map<std::pair<const MtlMaterial*, std::string>, std::size_t> byName_;
  std::string_view material_;
  std::optional<std::size_t> current_;
  std::int64_t smoothing_ = ObjSmoothing::unstated;
  std::size_t groupsSoFar_ = 0;
  std::array<std::size_t, objKindCount> done_{};    // of the part
  std::array<std::size_t, objKindCount> corners_{}; // before those
};

} // namespace

std::vector<ObjSurface> surfacesOf(const ObjText& text, ObjLibraries& libraries) {
  return Surfaces(text, libraries).read();
}

} // namespace vitrail::tool
