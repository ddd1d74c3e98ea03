#include "tile_plan.h"

#include <algorithm>
#include <cmath>

#include "pool.h"

namespace vitrail {

namespace {

constexpr double kHeadroom = 1.1;    // fragments are not spread evenly over a tile's parts
constexpr std::uint64_t kGrowth = 2; // of one tile over the one before it
constexpr std::uint64_t kParts = 8;  // of layoutStorage(); each wastes less than the alignment

std::uint64_t pixelsOf(const Rectangle& r) { return std::uint64_t{r.width} * r.height; }

// The most pixels whose head pointers and lists fit into `bytes`, whatever the pool: each may be in both lists.
std::uint64_t pixelsFor(std::uint64_t bytes, std::uint64_t alignment) {
  const std::uint64_t padding = kParts * alignment;
  return bytes > padding ? (bytes - padding) / (3 * sizeof(layout::uint)) : 0;
}

// Into how many parts a rectangle goes so that each has about as many fragments as there are nodes.
std::uint64_t partsFor(std::uint64_t fragments, std::uint32_t capacity) {
  const double parts = std::ceil(kHeadroom * static_cast<double>(fragments) / std::max(capacity, 1U));
  return static_cast<std::uint64_t>(std::clamp(parts, 1.0, 0x1p52));
}

} // namespace

TilePlanner::TilePlanner(const TilePlanInfo& info) : info_(info) {
  const std::uint64_t pixels = pixelsOf(info.area);
  const std::uint64_t most = info.areaPixelsLimit != 0 ? info.areaPixelsLimit : 0xffffffffU;
  areaPixels_ = static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(std::min(pixels, pixelsFor(info.memoryBudget / 4, info.alignment)), 1, most));
  StorageNeeds needs;
  needs.areaPixels = areaPixels_;
  needs.format = info.format;
  needs.userWords = info.userWords;
  needs.alignment = info.alignment;
  nodeCapacity_ = nodeCapacityFor(info.memoryBudget, needs, info.samples);
  if (info.nodeCapacityLimit != 0) nodeCapacity_ = std::min(nodeCapacity_, info.nodeCapacityLimit);
  tilePixels_ = areaPixels_;
  if (info.expectedFragments != 0) {
    // Where the count is right, one tile of the whole area needs no more.
    const double enough = std::ceil(kHeadroom * static_cast<double>(info.expectedFragments));
    if (enough < nodeCapacity_) nodeCapacity_ = static_cast<std::uint32_t>(enough);
    tilePixels_ = std::clamp<std::uint64_t>(pixels / partsFor(info.expectedFragments, nodeCapacity_), 1, areaPixels_);
  }
  if (pixels > 0) rest_.push_back(info.area);
}

// Cuts the first piece of at most tilePixels_ off what is left.
bool TilePlanner::next(Rectangle& tile) {
  if (rest_.empty()) return false;
  last_ = rest_.back();
  rest_.pop_back();
  const std::uint64_t rows = std::clamp<std::uint64_t>(tilePixels_ / last_.width, 1, last_.height);
  if (rows < last_.height) {
    const auto cut = static_cast<std::uint32_t>(rows);
    rest_.push_back({last_.x, last_.y + cut, last_.width, last_.height - cut});
    last_.height = cut;
  }
  if (pixelsOf(last_) > tilePixels_) { // a single row
    const auto cut = static_cast<std::uint32_t>(tilePixels_);
    rest_.push_back({last_.x + cut, last_.y, last_.width - cut, 1});
    last_.width = cut;
  }
  tile = last_;
  return true;
}

// Sizes the next tile for as many fragments a pixel as the last one had.
void TilePlanner::aimAt(std::uint64_t fragments, std::uint32_t capacity) {
  const double fits = capacity / (kHeadroom * static_cast<double>(std::max<std::uint64_t>(fragments, 1)));
  const double pixels =
      std::min(static_cast<double>(pixelsOf(last_)) * fits, static_cast<double>(kGrowth * tilePixels_));
  tilePixels_ = std::clamp<std::uint64_t>(static_cast<std::uint64_t>(pixels), 1, areaPixels_);
}

bool TilePlanner::finish(std::uint64_t requested, std::uint64_t missing, std::uint32_t capacity) {
  if (missing == 0) {
    aimAt(requested, capacity);
    return true;
  }
  if (pixelsOf(last_) <= 1) {
    // Head pointers and lists have their quarter.
    bytesNeeded_ = (requested * nodeBytes(info_.format, info_.userWords) + kParts * info_.alignment) / 3 * 4 + 4;
    return false;
  }
  const std::uint64_t parts = std::max<std::uint64_t>(2, partsFor(requested, capacity));
  tilePixels_ = last_.height > 1 ? std::max<std::uint64_t>(1, last_.height / parts) * last_.width
                                 : std::max<std::uint64_t>(1, last_.width / parts);
  rest_.push_back(last_);
  return true;
}

} // namespace vitrail
