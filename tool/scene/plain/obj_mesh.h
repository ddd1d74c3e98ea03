// Makes meshes of the elements of an OBJ file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "../scene.h"
#include "obj_surfaces.h"
#include "obj_text.h"

namespace vitrail::tool {

// A mesh before it has normals: those of the file, zero where it states none, or none at all.
struct ObjMesh {
  Mesh mesh;
  std::vector<glm::vec3> normals;
};

// Makes the vertices of meshes: corners that name the same things share one.
class ObjMeshMaker {
 public:
  ObjMeshMaker(const ObjText& text, const glm::dvec3& origin)
      : text_(text), origin_(origin), newest_(text.positions.size(), none) {}

  ObjMesh faces(const std::vector<ObjRun>& runs);

  Mesh lines(const std::vector<ObjRun>& runs);

  Mesh points(const std::vector<ObjRun>& runs);

  // All vertices of the file.
  Mesh cloud();

  bool hasSlivers() const { return hasSlivers_; } // whether any face had fewer than three corners

 private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  template <typename Visit>
  void forEach(const std::vector<ObjRun>& runs, ObjKind kind, Visit visit) const {
    for (const ObjRun& run : runs) {
      const ObjElements& elements = text_.parts[run.part].elements[kind];
      const ObjCorner* corner = elements.corners.data() + run.firstCorner;
      for (std::size_t i = run.first; i < run.first + run.count; ++i) {
        if (kind == objPoints || text_.isFinite(std::span(corner, elements.sizes[i]))) visit(corner, elements.sizes[i]);
        corner += elements.sizes[i];
      }
    }
  }

  void begin(std::size_t triangles);

  ObjMesh end();

  void addIndices(std::initializer_list<std::uint32_t> indices);

  void addOutline(const ObjCorner* corner, std::uint32_t count);

  // The vertices of one position are a list, the newest first: there are few.
  std::uint32_t vertexOf(const ObjCorner& corner);

  void addAttributes();

  const ObjText& text_;
  glm::dvec3 origin_;
  ObjMesh raw_;
  std::vector<std::uint32_t> newest_; // vertex of the mesh, by position
  std::vector<std::uint32_t> older_;  // of the same position, by vertex
  std::vector<ObjCorner> corners_;    // by vertex
  std::vector<std::uint32_t> outline_;
  bool hasSlivers_ = false;
};

// Gives a mesh without normals those that a smoothing group asks for: its faces are smooth whatever their angle, those
// of none are flat.
void smoothObj(ObjMesh& raw, std::int64_t smoothing);

// Adds what another mesh has; both have normals.
void appendObj(ObjMesh& raw, const ObjMesh& more);

// Where a scene's origin lies: see originOf().
glm::dvec3 originOfObj(const ObjText& text);

} // namespace vitrail::tool
