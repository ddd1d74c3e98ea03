#include "raster_needs.h"

#include <algorithm>
#include <cmath>

namespace vitrail {

namespace {

template <class Combine>
RasterNeeds combined(const RasterNeeds& a, const RasterNeeds& b, Combine combine) {
  return {.records = combine(a.records, b.records),
          .large = combine(a.large, b.large),
          .deep = combine(a.deep, b.deep),
          .blocks = combine(a.blocks, b.blocks),
          .fragments = combine(a.fragments, b.fragments),
          .chunks = combine(a.chunks, b.chunks)};
}

} // namespace

RasterNeeds RasterNeeds::most(const RasterNeeds& other) const {
  return combined(*this, other, [](std::uint64_t a, std::uint64_t b) { return std::max(a, b); });
}

RasterNeeds RasterNeeds::part(std::uint32_t parts) const {
  RasterNeeds part = combined(*this, {}, [parts](std::uint64_t a, std::uint64_t) { return (a + parts - 1) / parts; });
  part.large = large;
  return part;
}

RasterNeeds RasterNeeds::joined() const {
  RasterNeeds joined = combined(*this, {}, [](std::uint64_t a, std::uint64_t) { return 2 * a + a / 4; });
  joined.large += records / 32; // one that is large in the whole and in no half has records in more than 64 tiles
  return joined;
}

double rasterExcess(const RasterNeeds& needs, const RasterBounds& bounds) {
  const auto reach = static_cast<double>(bounds.reach);
  double most = 0.0;
  double all = static_cast<double>(bounds.tiles) * static_cast<double>(kRasterTileBytes + kRasterTileListBytes);
  const auto add = [&](std::uint64_t count, std::uint64_t largest, std::uint64_t together) {
    const auto number = static_cast<double>(count);
    // Numbers have 32 bits, and what is done in strides must not pass their end.
    most = std::max({most, number * static_cast<double>(largest) / reach, number / 2e9});
    all += number * static_cast<double>(together);
  };
  const std::uint64_t masks = rasterMaskBytes(bounds.samples);
  const std::uint64_t states = rasterStateBytes(bounds.samples);
  add(needs.records, std::max(kRasterRecordBytes, masks), rasterRecordBytes(bounds.samples, bounds.counted));
  add(needs.large, kRasterListedBytes, kRasterListedBytes);
  add(needs.deep, states, kRasterDeepTileBytes + kRasterDeepPixelsBytes + states);
  add(needs.blocks, kRasterListedBytes, kRasterListedBytes);
  add(needs.fragments, kRasterFragmentBytes, 2 * kRasterFragmentBytes);
  add(needs.chunks, kRasterListedBytes, kRasterListedBytes);
  return std::max(most, all / static_cast<double>(std::max<std::uint64_t>(bounds.budget, 1)));
}

double planRasterRoom(const RasterNeeds& needs, const RasterNeeds& had, const RasterBounds& bounds, RasterNeeds& next) {
  enum class Room { Spare, Enough, Least };
  double over = 0.0;
  for (const Room room : {Room::Spare, Room::Enough, Room::Least}) {
    next = combined(needs, had, [room](std::uint64_t wanted, std::uint64_t before) {
      wanted = std::max<std::uint64_t>(wanted, 1);
      if (room == Room::Least) return wanted;
      return wanted > before ? room == Room::Spare ? withRasterSpare(wanted) : wanted : before;
    });
    over = rasterExcess(next, bounds);
    if (over <= 1.0) break;
  }
  return over;
}

std::uint32_t fewerRasterRows(std::uint32_t rows, double excess) {
  const double parts = std::max(2.0, std::ceil(excess * 1.1));
  return std::max(1U, static_cast<std::uint32_t>(rows / parts));
}

bool isLowRasterNeed(const RasterNeeds& needs, const RasterNeeds& room) {
  // Records and fragments are what is large.
  return needs.records < room.records / 4 && (room.fragments <= 1 || needs.fragments < room.fragments / 4);
}

bool planJoinedBands(const RasterNeeds& most, const RasterNeeds& had, const RasterBounds& bounds, RasterNeeds& next) {
  const RasterNeeds joined = most.joined();
  const RasterNeeds twice = combined(joined, joined, [](std::uint64_t a, std::uint64_t b) { return a + b; });
  return rasterExcess(twice, bounds) <= 1.0 && planRasterRoom(joined, had, bounds, next) <= 1.0;
}

bool RasterLow::note(const RasterNeeds& needs, bool isLow, RasterNeeds& most) {
  constexpr std::uint32_t kFrames = 120;
  if (!isLow) {
    forget();
    return false;
  }
  most_ = most_.most(needs);
  if (++frames_ < kFrames) return false;
  most = most_;
  forget();
  return true;
}

} // namespace vitrail
