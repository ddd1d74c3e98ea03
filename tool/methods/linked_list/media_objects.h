// The objects of a scene that absorb light, as the resolve that follows it takes them (media_shared.h). No graphics
// API.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "../../stage/surface_list.h"
#include "media_shared.h"

namespace vitrail::tool {

class MediaObjects {
 public:
  // `scene` is what the surfaces show; it need not outlive the objects.
  MediaObjects(const SceneDraws& draws, const Scene& scene);

  // One an instance.
  const std::vector<shaders::MediaObject>& table() const { return table_; }
  const shaders::MediaView& view() const { return view_; }

  // How the surfaces are seen now: changes the table and the view.
  void setView(const shaders::FrameData& view);

  // Whether rays may begin inside of an object, seen so. Surfaces of such objects are drawn whatever opaque surfaces
  // are before them.
  bool anyNear() const { return anyNear_; }
  // What of `runs` those surfaces are, or what else there is.
  std::vector<SurfaceRun> part(std::span<const SurfaceRun> runs, bool near) const;

 private:
  // An object's box where the GPU has it, and its row of the table.
  struct Placed {
    std::uint32_t object = 0;
    glm::dmat4 toBox{1.0}; // from the GPU's space; of no use where the object is flat
    bool flat = false;
    Bounds box;
  };

  std::vector<shaders::MediaObject> table_;
  std::vector<Placed> placed_;
  std::vector<bool> near_; // by instance
  bool anyNear_ = false;
  shaders::MediaView view_{};
};

} // namespace vitrail::tool
