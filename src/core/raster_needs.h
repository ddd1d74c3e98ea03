// What frames of a raster need of the memory that follows them, and how that grows, or is made to do by drawing frames
// in bands of rows. No graphics API.
#pragma once

#include <cstdint>

namespace vitrail {

// What a band needs of what grows with what is drawn.
struct RasterNeeds {
  std::uint64_t records = 0; // places on the pages of tiles, for triangles there
  std::uint64_t large = 0;   // triangles that are set up in a pass of their own
  std::uint64_t deep = 0;    // tiles whose fragments are collected
  std::uint64_t blocks = 0;  // of their records
  std::uint64_t fragments = 0;
  std::uint64_t chunks = 0; // of their fragments

  [[nodiscard]] bool fitInto(const RasterNeeds& room) const {
    return records <= room.records && large <= room.large && deep <= room.deep && blocks <= room.blocks &&
           fragments <= room.fragments && chunks <= room.chunks;
  }
  [[nodiscard]] RasterNeeds most(const RasterNeeds& other) const;
  // What a band of so many times fewer rows needs if it is like the others, and at least. Large triangles may reach
  // into all of them.
  [[nodiscard]] RasterNeeds part(std::uint32_t parts) const;
  // What a band of twice as many rows needs at most, where this is the most that any band needs: twice as much, and
  // what is not alike in both. A triangle may be large in the band, which no half of it is in the others; and one of
  // which little lies in each may there be tried in more tiles than it covers.
  [[nodiscard]] RasterNeeds joined() const;
};

// What bounds it.
struct RasterBounds {
  std::uint64_t reach = 0;  // bytes of a buffer
  std::uint64_t budget = 0; // bytes of all together
  std::uint32_t tiles = 0;  // of a band
  std::uint32_t samples = 1;
  bool counted = false; // records are, before there are places for them
};

// Bytes of what a frame's passes keep.
constexpr std::uint64_t kRasterTileBytes = 128;    // of each of two arrays, the other with kRasterTileListBytes
constexpr std::uint64_t kRasterTileListBytes = 48; // a place in each class, two words
constexpr std::uint64_t kRasterRecordBytes = 32;
constexpr std::uint64_t rasterAstrayBytes(bool counted) { // for a record: one in four at most is listed, in three words
  return counted ? 0 : 3;
}
// Of medium triangles, which are in two words: for a record one in four, or where there are as many places as records,
// as many.
constexpr std::uint64_t rasterMediumBytes(bool counted) { return counted ? 8 : 2; }
constexpr std::uint64_t kRasterFragmentBytes = 8; // in each of two arrays
constexpr std::uint64_t kRasterDeepTileBytes = 16;
constexpr std::uint64_t kRasterDeepPixelsBytes = 64 * 16; // of a deep tile
constexpr std::uint64_t kRasterListedBytes = 8;           // a block, a chunk, a large triangle
constexpr std::uint64_t kRasterItemBytes = 16;            // of an instance; no part of the budget
constexpr std::uint64_t kRasterPositionBytes = 16;        // of a vertex of an instance; no part of the budget
constexpr std::uint64_t rasterMaskBytes(std::uint32_t samples) { return samples > 1 ? samples * 8 : 0; } // of a record
constexpr std::uint64_t rasterRecordBytes(std::uint32_t samples, bool counted) { // of a record in all arrays
  return kRasterRecordBytes + rasterAstrayBytes(counted) + rasterMediumBytes(counted) + rasterMaskBytes(samples);
}
constexpr std::uint64_t rasterStateBytes(std::uint32_t samples) { return samples * 64 * 32; } // of a deep tile

// How many times too much that is: for what a shader reaches, for numbers of 32 bits, for the budget. At most 1: it
// fits.
double rasterExcess(const RasterNeeds& needs, const RasterBounds& bounds);

// The room for what is needed, beside what there has been room for: with some to spare; without; and without what only
// earlier frames needed. Returns how many times too much the least of these is, and where that is more than 1 `next`
// says nothing.
double planRasterRoom(const RasterNeeds& needs, const RasterNeeds& had, const RasterBounds& bounds, RasterNeeds& next);

// With an eighth to spare.
constexpr std::uint64_t withRasterSpare(std::uint64_t wanted) { return wanted + wanted / 8; }

// The rows of tiles of a band after one of `rows` was so many times too much: fewer, at least 1.
std::uint32_t fewerRasterRows(std::uint32_t rows, double excess);

// Whether frames need less than a quarter of the memory.
bool isLowRasterNeed(const RasterNeeds& needs, const RasterNeeds& room);

// The room for bands of twice as many rows, of so many tiles, after bands that needed so much. False: twice what they
// may need is more than the bounds have, so that more than that would soon be too much again. All that bounds a band
// counts.
bool planJoinedBands(const RasterNeeds& most, const RasterNeeds& had, const RasterBounds& bounds, RasterNeeds& next);

// Whether memory or bands should follow frames down: where that was so for 120 frames in a row.
class RasterLow {
 public:
  // Whether they should after a frame with these needs. `most`: the most that those frames needed.
  bool note(const RasterNeeds& needs, bool isLow, RasterNeeds& most);
  void forget() { *this = {}; }

 private:
  std::uint32_t frames_ = 0;
  RasterNeeds most_;
};

} // namespace vitrail
