// What of the transparent surfaces can reach a part of a picture: tiles need not draw the rest.
#pragma once

#include <vector>

#include <volk.h>

#include "surfaces.h"

namespace vitrail::tool {

class TileRuns {
 public:
  // Of surfaces as they are seen now in a picture of that size.
  TileRuns(const Surfaces& surfaces, VkExtent2D extent);

  // Parts of the transparent draws, in the order of submission, without the instances whose boxes do not touch the
  // area. It is conservative: whatever changes a pixel of the area is there.
  std::vector<SurfaceRun> touching(const VkRect2D& area) const;

 private:
  // Pixels, not clipped to the picture.
  struct Extent {
    double left = 0.0;
    double right = 0.0;
    double top = 0.0;
    double bottom = 0.0;
  };

  Extent project(const PlacedBox& box, const glm::dmat4& clipFromWorld, double margin) const;

  VkExtent2D picture_;
  std::vector<SurfaceRun> runs_; // with one box each, the instances of a draw one by one where they have boxes
  std::vector<Extent> extents_;  // of each
};

} // namespace vitrail::tool
