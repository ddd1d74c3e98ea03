// Loads OBJ: polygons, lines and points with texture coordinates, normals, vertex colours (v x y z r g b, with a
// seventh number as alpha, or ZBrush's polypaint) and the materials of its libraries. Each material becomes one mesh of
// each kind.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../load.h"
#include "../mesh_build.h"
#include "../message.h"
#include "../read_file.h"
#include "find_file.h"
#include "model.h"
#include "mtl.h"
#include "obj_material.h"
#include "obj_text.h"
#include "origin.h"
#include "polygon.h"
#include "text_encoding.h"

namespace vitrail::tool {
namespace {

// ---- Libraries

// The libraries of a file. A name is looked up in those that have been named so far, from the last mtllib statement
// back, and then in those that follow: files are joined out of others whose materials have the same names.
class Libraries {
 public:
  struct Found {
    const MtlMaterial* material = nullptr;
    const LoadedLibrary* library = nullptr;
  };

  Libraries(Scene& scene, const std::filesystem::path& base) : scene_(scene), base_(base) {}

  // What stands behind mtllib: a name that may hold spaces, or several.
  void add(std::string_view names) {
    auto& group = groups_.emplace_back();
    if (const LoadedLibrary* whole = find(names)) {
      group.push_back(whole);
      return;
    }
    names = beforeComment(names);
    while (!names.empty()) {
      std::size_t length = names.size();
      const LoadedLibrary* library = find(names);
      while (library == nullptr && length > 0) {
        length = names.find_last_of(" \t", length - 1);
        if (length == std::string_view::npos) break;
        library = find(names.substr(0, length));
      }
      if (library != nullptr)
        group.push_back(library);
      else
        length = reportMissing(names);
      names.remove_prefix(std::min(names.find_first_not_of(" \t", length), names.size()));
    }
  }

  std::size_t groupCount() const { return groups_.size(); }
  bool anyMissing() const { return anyMissing_; }

  // `groupsSoFar`: the mtllib statements before the usemtl.
  Found find(std::string_view name, std::size_t groupsSoFar) const {
    for (std::size_t i = groupsSoFar; i-- > 0;)
      if (const Found found = findIn(groups_[i], name); found.material != nullptr) return found;
    for (std::size_t i = groupsSoFar; i < groups_.size(); ++i)
      if (const Found found = findIn(groups_[i], name); found.material != nullptr) return found;
    return {};
  }

 private:
  using Group = std::vector<const LoadedLibrary*>;

  static Found findIn(const Group& group, std::string_view name) {
    for (const LoadedLibrary* library : group)
      if (const MtlMaterial* material = library->library.find(name)) return {material, library};
    return {};
  }

  // Null where there is no such file.
  const LoadedLibrary* find(std::string_view name) {
    if (base_.empty()) return nullptr;
    const std::optional<std::filesystem::path> path = findFile(name, std::span(&base_, 1));
    if (!path) return nullptr;
    std::unique_ptr<LoadedLibrary>& library = libraries_[path->lexically_normal()];
    if (library) return library.get();
    library = std::make_unique<LoadedLibrary>();
    library->folder = path->parent_path();
    try {
      const std::vector<std::byte> file = readFile(*path);
      library->library = readMtl(PlainText(file).view());
    } catch (const LoadError& error) {
      missing(name, error.what());
    }
    for (std::string& line : library->library.warnings) warn(scene_, std::move(line));
    return library.get();
  }

  // Of several names, one that ends in ".mtl" ends there. Its length.
  std::size_t reportMissing(std::string_view names) {
    std::size_t length = names.size();
    for (std::size_t i = 0; i + 5 <= names.size(); ++i) {
      const bool ends = names[i] == '.' && (names[i + 1] | 32) == 'm' && (names[i + 2] | 32) == 't' &&
                        (names[i + 3] | 32) == 'l' && (names[i + 4] == ' ' || names[i + 4] == '\t');
      if (!ends) continue;
      length = i + 4;
      break;
    }
    missing(names.substr(0, length), base_.empty() ? "external files are not read here" : "no such file");
    return length;
  }

  void missing(std::string_view name, std::string_view reason) {
    anyMissing_ = true;
    warn(scene_, fmt::format("material library {}: {}; its materials are drawn plain", oneLine(name), reason));
  }

  Scene& scene_;
  std::filesystem::path base_;
  std::map<std::filesystem::path, std::unique_ptr<LoadedLibrary>> libraries_;
  std::vector<Group> groups_;
  bool anyMissing_ = false;
};

// ---- Which elements belong together

// Smoothing groups of files without normals: "s off", "s 1" and so on.
struct Smoothing {
  static constexpr std::int64_t unstated = -1;
  static constexpr std::int64_t off = 0;
};

// Elements of one part of the text that follow each other.
struct Run {
  std::size_t part;
  std::size_t first;
  std::size_t count;
  std::size_t firstCorner;
};

// What has one material.
struct Surface {
  std::string name;
  Libraries::Found found;
  std::map<std::int64_t, std::vector<Run>> faces; // by smoothing group
  std::vector<Run> lines;
  std::vector<Run> points;
};

class Surfaces {
 public:
  Surfaces(const ObjText& text, Libraries& libraries) : text_(text), libraries_(libraries) {
    for (const ObjPart& part : text.parts)
      for (const ObjStatement& statement : part.statements)
        if (statement.kind == ObjStatement::Kind::Library) libraries.add(statement.text);
  }

  std::vector<Surface> read() {
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
        smoothing_ = Smoothing::off; // also "off" and what is no number
        std::from_chars(statement.text.data(), statement.text.data() + statement.text.size(), smoothing_);
        smoothing_ = std::max(smoothing_, Smoothing::off);
        break;
    }
  }

  void takeUntil(std::size_t part, const std::array<std::size_t, objKindCount>& end) {
    for (std::size_t kind = 0; kind < objKindCount; ++kind) {
      if (end[kind] == done_[kind]) continue;
      Surface& surface = surfaces_[surfaceIndex()];
      std::vector<Run>& runs = kind == objFaces   ? surface.faces[smoothing_]
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
    Libraries::Found found = libraries_.find(material_, groupsSoFar_);
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
  Libraries& libraries_;
  std::vector<Surface> surfaces_; // as they come in the file
  std::map<std::pair<const MtlMaterial*, std::string>, std::size_t> byName_;
  std::string_view material_;
  std::optional<std::size_t> current_;
  std::int64_t smoothing_ = Smoothing::unstated;
  std::size_t groupsSoFar_ = 0;
  std::array<std::size_t, objKindCount> done_{};    // of the part
  std::array<std::size_t, objKindCount> corners_{}; // before those
};

// ---- Meshes

// A mesh before it has normals: those of the file, zero where it states none, or none at all.
struct RawMesh {
  Mesh mesh;
  std::vector<glm::vec3> normals;
};

// Makes the vertices of meshes: corners that name the same things share one.
class MeshMaker {
 public:
  MeshMaker(const ObjText& text, const glm::dvec3& origin)
      : text_(text), origin_(origin), newest_(text.positions.size(), none) {}

  RawMesh faces(const std::vector<Run>& runs) {
    std::size_t triangles = 0;
    forEach(runs, objFaces, [&](const ObjCorner*, std::uint32_t count) { triangles += count < 3 ? 0 : count - 2; });
    begin(triangles);
    forEach(runs, objFaces, [this](const ObjCorner* corner, std::uint32_t count) {
      if (count == 3)
        addIndices({vertexOf(corner[0]), vertexOf(corner[1]), vertexOf(corner[2])});
      else
        addOutline(corner, count);
    });
    return end();
  }

  Mesh lines(const std::vector<Run>& runs) {
    begin(0);
    raw_.mesh.primitive = Primitive::Lines;
    forEach(runs, objLines, [this](const ObjCorner* corner, std::uint32_t count) {
      for (std::uint32_t i = 1; i < count; ++i) addIndices({vertexOf(corner[i - 1]), vertexOf(corner[i])});
    });
    return end().mesh;
  }

  Mesh points(const std::vector<Run>& runs) {
    begin(0);
    raw_.mesh.primitive = Primitive::Points;
    forEach(runs, objPoints, [this](const ObjCorner* corner, std::uint32_t count) {
      for (std::uint32_t i = 0; i < count; ++i) addIndices({vertexOf(corner[i])});
    });
    return end().mesh;
  }

  // All vertices of the file.
  Mesh cloud() {
    begin(0);
    raw_.mesh.primitive = Primitive::Points;
    for (std::size_t i = 0; i < text_.positions.size(); ++i) {
      ObjCorner corner;
      corner.position = static_cast<std::int32_t>(i);
      addIndices({vertexOf(corner)});
    }
    return end().mesh;
  }

  bool hasSlivers() const { return hasSlivers_; } // whether any face had fewer than three corners

 private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  template <typename Visit>
  void forEach(const std::vector<Run>& runs, ObjKind kind, Visit visit) const {
    for (const Run& run : runs) {
      const ObjElements& elements = text_.parts[run.part].elements[kind];
      const ObjCorner* corner = elements.corners.data() + run.firstCorner;
      for (std::size_t i = run.first; i < run.first + run.count; ++i) {
        visit(corner, elements.sizes[i]);
        corner += elements.sizes[i];
      }
    }
  }

  void begin(std::size_t triangles) {
    raw_ = {};
    raw_.mesh.indices.reserve(3 * triangles);
    const std::size_t likely = std::min(3 * triangles, text_.positions.size());
    raw_.mesh.positions.reserve(likely);
    corners_.reserve(likely);
    older_.reserve(likely);
  }

  RawMesh end() {
    for (const ObjCorner& corner : corners_) newest_[static_cast<std::size_t>(corner.position)] = none;
    addAttributes();
    corners_ = {};
    older_ = {};
    return std::move(raw_);
  }

  void addIndices(std::initializer_list<std::uint32_t> indices) {
    raw_.mesh.indices.insert(raw_.mesh.indices.end(), indices);
  }

  void addOutline(const ObjCorner* corner, std::uint32_t count) {
    if (count < 3) {
      hasSlivers_ = true;
      return;
    }
    outline_.clear();
    for (std::uint32_t i = 0; i < count; ++i) outline_.push_back(vertexOf(corner[i]));
    addPolygon(outline_, raw_.mesh.positions, raw_.mesh.indices);
  }

  // The vertices of one position are a list, the newest first: there are few.
  std::uint32_t vertexOf(const ObjCorner& corner) {
    std::uint32_t& newest = newest_[static_cast<std::size_t>(corner.position)];
    for (std::uint32_t i = newest; i != none; i = older_[i])
      if (corners_[i].texCoord == corner.texCoord && corners_[i].normal == corner.normal) return i;
    if (corners_.size() >= none) throw LoadError("more vertices than 32-bit indices can name");
    const auto index = static_cast<std::uint32_t>(corners_.size());
    older_.push_back(newest);
    newest = index;
    corners_.push_back(corner);
    raw_.mesh.positions.emplace_back(text_.positions[static_cast<std::size_t>(corner.position)] - origin_);
    return index;
  }

  void addAttributes() {
    const std::size_t count = corners_.size();
    if (std::ranges::any_of(corners_, [](const ObjCorner& corner) { return corner.texCoord >= 0; })) {
      raw_.mesh.texCoords0.resize(count, glm::vec2(0.0F));
      for (std::size_t i = 0; i < count; ++i)
        if (corners_[i].texCoord >= 0)
          raw_.mesh.texCoords0[i] = text_.texCoords[static_cast<std::size_t>(corners_[i].texCoord)];
    }
    // A corner without a normal gets its face's, if others have one.
    if (std::ranges::any_of(corners_, [](const ObjCorner& corner) { return corner.normal >= 0; })) {
      raw_.normals.resize(count, glm::vec3(0.0F));
      for (std::size_t i = 0; i < count; ++i)
        if (corners_[i].normal >= 0) raw_.normals[i] = text_.normals[static_cast<std::size_t>(corners_[i].normal)];
    }
    if (text_.colors.empty()) return;
    raw_.mesh.colors.reserve(count);
    for (const ObjCorner& corner : corners_)
      raw_.mesh.colors.push_back(packColor(text_.colors[static_cast<std::size_t>(corner.position)]));
  }

  const ObjText& text_;
  glm::dvec3 origin_;
  RawMesh raw_;
  std::vector<std::uint32_t> newest_; // vertex of the mesh, by position
  std::vector<std::uint32_t> older_;  // of the same position, by vertex
  std::vector<ObjCorner> corners_;    // by vertex
  std::vector<std::uint32_t> outline_;
  bool hasSlivers_ = false;
};

// Normals that a smoothing group asks for: its faces are smooth whatever their angle, those of none are flat.
void smooth(RawMesh& raw, std::int64_t smoothing) {
  constexpr float crease = std::numbers::pi_v<float> / 4.0F;
  dropDegenerateTriangles(raw.mesh);
  if (smoothing == Smoothing::off)
    makeFlatNormals(raw.mesh);
  else
    makeCreasedNormals(raw.mesh, smoothing == Smoothing::unstated ? crease : std::numbers::pi_v<float>);
  raw.normals.clear();
  for (const std::uint32_t normal : raw.mesh.normals) raw.normals.push_back(unpackDirection(normal));
  raw.mesh.normals.clear();
}

void append(RawMesh& raw, RawMesh more) {
  const std::size_t first = raw.mesh.vertexCount();
  const std::size_t count = first + more.mesh.vertexCount();
  const auto add = [](auto& values, const auto& others) { values.insert(values.end(), others.begin(), others.end()); };
  for (const std::uint32_t index : more.mesh.indices)
    raw.mesh.indices.push_back(static_cast<std::uint32_t>(first) + index);
  add(raw.mesh.positions, more.mesh.positions);
  add(raw.normals, more.normals);
  add(raw.mesh.colors, more.mesh.colors);
  if (raw.mesh.texCoords0.empty() && more.mesh.texCoords0.empty()) return;
  raw.mesh.texCoords0.resize(first, glm::vec2(0.0F));
  add(raw.mesh.texCoords0, more.mesh.texCoords0);
  raw.mesh.texCoords0.resize(count, glm::vec2(0.0F));
}

// The box around what elements use. Some files hold a stray vertex at the origin.
glm::dvec3 originOfText(const ObjText& text) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  glm::dvec3 min(infinity);
  glm::dvec3 max(-infinity);
  const auto include = [&](const glm::dvec3& position) {
    min = glm::min(min, position);
    max = glm::max(max, position);
  };
  for (const glm::dvec3& position : text.positions) include(position);
  const glm::dvec3 far = glm::max(glm::abs(min), glm::abs(max));
  // Nearer than this floats are fine enough for anything that one would look at.
  if (!(std::max({far.x, far.y, far.z}) > 1000.0)) return originOf(min, max);
  glm::dvec3 usedMin(infinity);
  std::swap(min, usedMin);
  glm::dvec3 usedMax(-infinity);
  std::swap(max, usedMax);
  bool any = false;
  for (const ObjPart& part : text.parts)
    for (const ObjElements& elements : part.elements)
      for (const ObjCorner& corner : elements.corners) {
        include(text.positions[static_cast<std::size_t>(corner.position)]);
        any = true;
      }
  return any ? originOf(min, max) : originOf(usedMin, usedMax);
}

// ---- The scene

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::filesystem::path& base)
      : text_(readObjText(text)), base_(base), libraries_(scene_, base), materials_(scene_, base) {}

  Scene read() {
    scene_.file.format = "OBJ";
    scene_.file.generator = text_.generator;
    for (std::string& line : text_.warnings) warn(scene_, std::move(line));
    const std::vector<Surface> surfaces = Surfaces(text_, libraries_).read();
    if (!text_.positions.empty()) scene_.origin = originOfText(text_);
    MeshMaker maker(text_, scene_.origin);
    for (const Surface& surface : surfaces) addSurface(surface, maker);
    // A cloud of points: nothing but vertices.
    if (surfaces.empty() && !text_.positions.empty())
      addUnlitMesh(scene_, maker.cloud(), plainMaterial(!text_.colors.empty()));
    if (maker.hasSlivers()) warn(scene_, "faces of fewer than three corners are left out");
    reportUndefined();
    requireDrawable(scene_);
    return std::move(scene_);
  }

 private:
  void addSurface(const Surface& surface, MeshMaker& maker) {
    // Made before the meshes, so that materials warn in the file's order.
    const Material material = materialOf(surface);
    addFaces(surface, material, maker);
    if (!surface.lines.empty()) addUnlitMesh(scene_, maker.lines(surface.lines), material);
    if (!surface.points.empty()) addUnlitMesh(scene_, maker.points(surface.points), material);
  }

  void addFaces(const Surface& surface, const Material& material, MeshMaker& maker) {
    if (surface.faces.empty()) return;
    const std::size_t before = scene_.meshes.size();
    const std::int64_t smoothing = surface.faces.begin()->first;
    RawMesh raw = maker.faces(surface.faces.begin()->second);
    const bool alone = surface.faces.size() == 1;
    if (alone && raw.normals.empty() && smoothing <= Smoothing::off) {
      const bool flat = smoothing == Smoothing::off && material.normalTexture.image < 0;
      addPlainMesh(scene_, std::move(raw.mesh), flat ? NormalsFrom::None : NormalsFrom::Places, material);
    } else {
      if (raw.normals.empty()) smooth(raw, smoothing);
      for (auto group = std::next(surface.faces.begin()); group != surface.faces.end(); ++group) {
        RawMesh more = maker.faces(group->second);
        if (more.normals.empty()) smooth(more, group->first);
        append(raw, std::move(more));
      }
      addPlainMesh(scene_, std::move(raw.mesh), NormalsFrom::File, material, std::move(raw.normals));
    }
    if (material.normalTexture.image >= 0 && scene_.meshes.size() > before)
      makeTangents(scene_.meshes.back(), material.normalTexture);
  }

  Material materialOf(const Surface& surface) {
    const bool colored = !text_.colors.empty();
    Material material = surface.found.material == nullptr
                            ? plainMaterial(colored)
                            : materials_.make(*surface.found.material, *surface.found.library, colored);
    if (surface.found.material == nullptr && !surface.name.empty()) undefined_.push_back(surface.name);
    material.name = surface.name;
    return material;
  }

  // A library that is missing has been reported already.
  void reportUndefined() {
    if (undefined_.empty() || libraries_.anyMissing()) return;
    const std::size_t more = undefined_.size() - 1;
    const std::string others = more == 0 ? "" : fmt::format(", and so {} {} more", more == 1 ? "is" : "are", more);
    const char* const where =
        libraries_.groupCount() == 0 ? "the file names no material library" : "it is in no library";
    warn(scene_, fmt::format("material \"{}\": {}; it is drawn plain{}", oneLine(undefined_[0]), where, others));
  }

  Scene scene_;
  ObjText text_;
  std::filesystem::path base_;
  Libraries libraries_;
  ObjMaterials materials_;
  std::vector<std::string> undefined_; // materials
};

} // namespace

Scene loadObj(std::span<const std::byte> file, const std::filesystem::path& base) {
  const PlainText text(file);
  return ObjReader(text.view(), base).read();
}

} // namespace vitrail::tool
