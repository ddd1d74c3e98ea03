// The transparent objects of a scene in the order of their distances. No graphics API.
#pragma once

#include <vector>

#include "../../stage/surface_list.h"

namespace vitrail::tool {

class ObjectOrder {
 public:
  // `scene` is what the surfaces show; it need not outlive the order.
  ObjectOrder(const SceneDraws& draws, const Scene& scene);

  // One run an object, the farthest first; equal distances in the order of submission.
  std::vector<SurfaceRun> farthestFirst(const shaders::FrameData& view) const;

 private:
  std::vector<SurfaceRun> runs_;    // the objects, in the order of submission
  std::vector<glm::dvec3> middles_; // of each, in the GPU's space
};

} // namespace vitrail::tool
