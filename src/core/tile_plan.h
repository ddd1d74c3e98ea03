// Which rectangles a picture is drawn in where it does not fit into a memory budget as a whole.
#pragma once

#include <cstdint>
#include <vector>

#include "project_bounds.h"

namespace vitrail {

struct TilePlanInfo {
  Rectangle area;           // what has to be drawn; may be empty
  std::uint32_t format = 0; // VITRAIL_FORMAT_*
  bool userWords = false;
  std::uint32_t samples = 1;
  std::uint64_t memoryBudget = 0;      // bytes for layoutStorage() of one tile, already clamped to the device
  std::uint64_t alignment = 256;       // of layoutStorage(); at least 256
  std::uint32_t nodeCapacityLimit = 0; // of the device's pools; 0: the format's only
  std::uint32_t areaPixelsLimit = 0;   // of the device's head pointers; 0: none
  std::uint64_t expectedFragments = 0; // 0: unknown
};

// The area is cut into bands of rows, a row into pieces where it is too long, in the order of reading. How large the
// next tile is follows from the fragments of the last one: a tile that overflowed is cut again, into as many parts as
// its fragments ask for, and where tiles have room to spare the next ones grow. The order is the same whenever the
// fragments are.
class TilePlanner {
 public:
  explicit TilePlanner(const TilePlanInfo& info);

  // What a target for the tiles needs: head pointers for so many pixels, and so many nodes. Head pointers and lists
  // take at most a quarter of the budget. At least 1 pixel; 0 nodes where the budget has no room for one.
  [[nodiscard]] std::uint32_t areaPixels() const { return areaPixels_; }
  [[nodiscard]] std::uint32_t nodeCapacity() const { return nodeCapacity_; }

  // The next tile to draw; false where all are done. A tile that finish() was not told of counts as done.
  bool next(Rectangle& tile);

  // Tells how many fragments the tile that next() gave last had, how many of them found no node, and the nodes that
  // there were. Where some are missing, its parts are what next() gives. False: it was a single pixel and cannot be
  // split; a budget of bytesNeeded() would hold it.
  [[nodiscard]] bool finish(std::uint64_t requested, std::uint64_t missing, std::uint32_t capacity);
  [[nodiscard]] std::uint64_t bytesNeeded() const { return bytesNeeded_; }

 private:
  void aimAt(std::uint64_t fragments, std::uint32_t capacity);

  TilePlanInfo info_;
  std::uint32_t areaPixels_ = 1;
  std::uint32_t nodeCapacity_ = 0;
  std::uint64_t tilePixels_ = 1; // of the next tile, at most
  std::vector<Rectangle> rest_;  // what is not yet drawn, the next part last
  Rectangle last_;               // what next() gave
  std::uint64_t bytesNeeded_ = 0;
};

} // namespace vitrail
