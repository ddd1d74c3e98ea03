// Loads OBJ: polygons, lines and points with texture coordinates, normals, vertex colours (v x y z r g b, with a
// seventh number as alpha, or ZBrush's polypaint) and the materials of its libraries. Each material becomes one mesh of
// each kind.
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../load.h"
#include "../mesh_build.h"
#include "../message.h"
#include "model.h"
#include "obj_libraries.h"
#include "obj_material.h"
#include "obj_mesh.h"
#include "obj_surfaces.h"
#include "obj_text.h"
#include "text_encoding.h"

namespace vitrail::tool {
namespace {

// Programs that write a picture and colours of vertices mean the same by both. The vertices' alpha is kept.
void whitenColors(Mesh& mesh) {
  bool translucent = false;
  for (std::uint64_t& packed : mesh.colors) {
    const float alpha = unpackColor(packed).a;
    translucent = translucent || alpha < 1.0F;
    packed = packColor({1.0F, 1.0F, 1.0F, alpha});
  }
  if (!translucent) mesh.colors.clear();
}

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::filesystem::path& base)
      : text_(readObjText(text)), base_(base), libraries_(scene_, base), materials_(scene_, base) {}

  Scene read() {
    scene_.file.format = "OBJ";
    scene_.file.generator = text_.generator;
    for (std::string& line : text_.warnings) warn(scene_, std::move(line));
    const std::vector<ObjSurface> surfaces = surfacesOf(text_, libraries_);
    if (!text_.positions.empty()) scene_.origin = originOfObj(text_);
    ObjMeshMaker maker(text_, scene_.origin);
    for (const ObjSurface& surface : surfaces) addSurface(surface, maker);
    // A cloud of points: nothing but vertices.
    if (surfaces.empty() && !text_.positions.empty())
      addUnlitMesh(scene_, maker.cloud(), plainMaterial(!text_.colors.empty()));
    if (maker.hasSlivers()) warn(scene_, "faces of fewer than three corners are left out");
    reportUndefined();
    if (scene_.draws.empty() && text_.notFinite > 0)
      throw LoadError("everything in it has a vertex that is not finite");
    requireDrawable(scene_);
    return std::move(scene_);
  }

 private:
  void addSurface(const ObjSurface& surface, ObjMeshMaker& maker) {
    // Made before the meshes, so that materials warn in the file's order.
    const Material material = materialOf(surface);
    addFaces(surface, material, maker);
    if (!surface.lines.empty()) addUnlitMesh(scene_, maker.lines(surface.lines), material);
    if (!surface.points.empty()) addUnlitMesh(scene_, maker.points(surface.points), material);
  }

  void addFaces(const ObjSurface& surface, const Material& material, ObjMeshMaker& maker) {
    if (surface.faces.empty()) return;
    const bool pictured = material.baseColorTexture.image >= 0 && !surface.found.material->diffuseMap.name.empty();
    const std::size_t before = scene_.meshes.size();
    const std::int64_t smoothing = surface.faces.begin()->first;
    ObjMesh raw = maker.faces(surface.faces.begin()->second);
    const bool alone = surface.faces.size() == 1;
    if (alone && raw.normals.empty() && smoothing <= ObjSmoothing::off) {
      const bool flat = smoothing == ObjSmoothing::off && material.normalTexture.image < 0;
      if (pictured) whitenColors(raw.mesh);
      addPlainMesh(scene_, std::move(raw.mesh), flat ? NormalsFrom::None : NormalsFrom::Places, material);
    } else {
      if (raw.normals.empty()) smoothObj(raw, smoothing);
      for (auto group = std::next(surface.faces.begin()); group != surface.faces.end(); ++group) {
        ObjMesh more = maker.faces(group->second);
        if (more.normals.empty()) smoothObj(more, group->first);
        appendObj(raw, more);
      }
      if (pictured) whitenColors(raw.mesh);
      addPlainMesh(scene_, std::move(raw.mesh), NormalsFrom::File, material, std::move(raw.normals));
    }
    if (material.normalTexture.image >= 0 && scene_.meshes.size() > before)
      makeTangents(scene_.meshes.back(), material.normalTexture);
  }

  Material materialOf(const ObjSurface& surface) {
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
  ObjLibraries libraries_;
  ObjMaterials materials_;
  std::vector<std::string> undefined_; // materials
};

} // namespace

Scene loadObj(std::span<const std::byte> file, const std::filesystem::path& base) {
  const PlainText text(file);
  return ObjReader(text.view(), base).read();
}

} // namespace vitrail::tool
