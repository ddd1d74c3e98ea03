// What of the transparent surfaces can reach a part of a picture: tiles need not draw the rest. No graphics API.
#pragma once

#include <cstdint>
#include <vector>

#include <vitrail/tiles.h>

#include "surface_list.h"

namespace vitrail::tool {

// The boxes of the transparent surfaces as the library takes them, seen with the surfaces' view.
std::vector<VitrailBounds> clipBoxesOf(const SurfaceList& surfaces);

// Whether the draw is of points, which reach beyond their box: it is around their middles.
bool drawsPoints(const GpuDraw& draw);

class TileRuns {
 public:
  // Of surfaces as they are seen now in a picture of that size.
  TileRuns(const SurfaceList& surfaces, std::uint32_t width, std::uint32_t height);

  // Parts of the transparent draws, in the order of submission, without the instances whose boxes do not touch the
  // area. It is conservative, as vitrailProjectBounds() is: whatever changes a pixel of the area is there.
  std::vector<SurfaceRun> touching(const VitrailRect& area) const;

 private:
  std::vector<SurfaceRun> runs_;   // with one box each, the instances of a draw one by one where they have boxes
  std::vector<VitrailRect> areas_; // that each can reach
};

} // namespace vitrail::tool
