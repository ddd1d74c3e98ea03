// What is between the surfaces of an object: how strongly it absorbs, and whether the object has an inside at all.
// docs/shading.md, "Volume", has the rules.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene.h"

namespace vitrail::tool {

// The absorption of a material's volume, per unit of length in the world: light that goes d through it is multiplied by
// exp(-absorption * d). 0 where it has no volume, or where nothing passes through its surface.
glm::vec3 absorption(const Material& material);

// Which way the triangles of a mesh face.
enum class Facing : std::uint8_t {
  Open,    // they do not enclose anything
  Outward, // they enclose a space, counter-clockwise as seen from outside
  Inward   // the same, seen from inside
};

// A mesh is closed where each edge is as often passed from a to b as from b to a, places being the same where their
// coordinates are, to within a 4096th of the mesh: then every ray enters it as often as it leaves it. Vertices may be
// shared or not.
Facing facingOf(const Mesh& mesh);

// What of a scene encloses a volume that absorbs light.
class Solids {
 public:
  Solids() = default;
  // What planes cut open encloses nothing any more.
  explicit Solids(const Scene& scene) : Solids(scene, !scene.clipPlanes.empty()) {}
  // `cut`: whether something cuts all of it.
  Solids(const Scene& scene, bool cut);

  // A mesh of the scene with a material that some draw shows it with. Open also where the material absorbs nothing, or
  // is masked: its surface may have holes.
  Facing of(std::uint32_t mesh, std::uint32_t material) const {
    return any_ && absorbing_[material] ? meshes_[mesh] : Facing::Open;
  }
  bool any() const { return any_; }
  // The first material whose volume some open mesh shows, if any: no true way through it is known.
  std::optional<std::uint32_t> open() const { return open_; }
  // The box around such a mesh, in its own space: it is known here when the mesh itself is let go of.
  const Bounds& boxOf(std::uint32_t mesh) const { return boxes_[mesh]; }

 private:
  std::vector<bool> absorbing_; // by material
  std::vector<Facing> meshes_;  // those that are not shown with an absorbing material are not looked at
  std::vector<Bounds> boxes_;   // by mesh, of those that are closed
  bool any_ = false;
  std::optional<std::uint32_t> open_;
};

} // namespace vitrail::tool
