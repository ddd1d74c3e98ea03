// Colours of draws without a shade function, tile by tile.
#if defined(VITRAIL_COLORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_COLORS_INL_H
#undef VITRAIL_COLORS_INL_H
#else
#define VITRAIL_COLORS_INL_H
#endif

#include <array>
#include <cstdint>
#include <vector>

#include "raster/cpu/frame.h"
#include "raster/cpu/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

// What the flat draws of a tile do to the light behind them. Each has a number in the tile, in the order in which they
// were asked for: most tiles see few draws, whose colours then fit into registers. 0 is that of one that does nothing.
class TileColors {
 public:
  // Lets go of a tile's.
  void begin(const Frame& frame) {
    drawn_.resize(frame.draws.size());
    ++tile_;
    if (tile_ == 0) { // after 2^32 tiles: numbers of other tiles could be taken for this one's
      drawn_.assign(drawn_.size(), {});
      tile_ = 1;
    }
    pairs_.clear();
    filters_.clear();
    add({0.0F, 0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F, 0.0F});
  }

  std::uint32_t numberOf(const Frame& frame, std::uint32_t draw) {
    Drawn& drawn = drawn_[draw];
    if (drawn.tile != tile_) {
      drawn = {tile_, static_cast<std::uint32_t>(pairs_.size())};
      add(frame.flatPairs[draw], frame.flatFilters[draw]);
    }
    return drawn.number;
  }

  // Red, green, blue and alpha of number i are at 4 * i; null where nothing was begun.
  const float* pairs() const { return pairs_.empty() ? nullptr : pairs_.front().data(); }
  const float* filters() const { return filters_.empty() ? nullptr : filters_.front().data(); }
  float alphaOf(std::int32_t number) const { return pairs_[static_cast<std::uint32_t>(number)][3]; }

  // Whether lookUp() finds all of them.
  bool areFew() const { return kLookedUp > 0 && pairs_.size() <= kLookedUp; }
  HWY_INLINE F lookUp(std::size_t channel, const I& numbers) const {
    return lookUpFloats(columns_[channel].data(), numbers, pairs_.size());
  }

 private:
  void add(const std::array<float, 4>& pair, const std::array<float, 4>& filter) {
    if (pairs_.size() < kLookedUp) {
      for (std::size_t c = 0; c < 4; ++c) columns_[c][pairs_.size()] = pair[c];
    }
    pairs_.push_back(pair);
    filters_.push_back(filter);
  }

  struct Drawn {
    std::uint32_t tile = 0; // in which it has the number
    std::uint32_t number = 0;
  };
  std::uint32_t tile_ = 0;
  std::vector<Drawn> drawn_;
  std::vector<std::array<float, 4>> pairs_;
  std::vector<std::array<float, 4>> filters_;
  alignas(64) std::array<std::array<float, 64>, 4> columns_{};
};

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
