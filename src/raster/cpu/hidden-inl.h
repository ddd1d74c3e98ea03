// Deep blocks: fragments that nothing shows of are let go of while others still come.
#if defined(VITRAIL_HIDDEN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_HIDDEN_INL_H
#undef VITRAIL_HIDDEN_INL_H
#else
#define VITRAIL_HIDDEN_INL_H
#endif

#include <algorithm>
#include <cstring>

#include "raster/cpu/worker-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

// What comes through fragments that are taken one after the other. With several samples only what covers all of a pixel
// counts.
class Through {
 public:
  explicit Through(const Frame& frame) : filters_(frame.needs.filters), least_(set(0.5F * frame.leastTransmittance)) {
    for (F& t : through_) t = set(1.0F);
  }

  HWY_INLINE void take(const M& counts, const F& alpha, const F* filter) {
    through_[3] = fnma(through_[3], keep(counts, alpha), through_[3]);
    for (std::size_t c = 0; filters_ && c < 3; ++c) through_[c] = select(counts, through_[c] * filter[c], through_[c]);
  }
  // Where it is too little to show anything: half of the least, for what rounds otherwise in blending.
  HWY_INLINE M isTooLittle() const {
    const F most = filters_ ? max(max(through_[0], through_[1]), max(through_[2], through_[3])) : through_[3];
    return least_ > most;
  }

 private:
  bool filters_;
  F least_;
  F through_[4]; // red, green, blue where there are filters, alpha
};

// Whether in some pixel of rows_ there is enough to hide anything, in whatever order.
inline bool TileWorker::mayHide(const Frame& frame) const {
  Through through(frame);
  const I everything = set(static_cast<std::int32_t>((1U << frame.info.samples) - 1));
  for (const Row row : rows_) {
    M counts = set(kFarKey) > load(row);
    if (shape_.coverage != 0) counts = counts & (load(row + kLanes * shape_.coverage) == everything);
    const std::int32_t* places = row + kLanes * RowShape::kNumber;
    const auto pairs = [&](const float* of, std::uint32_t vector, F* values) HWY_ATTR {
      loadFours(
          [&](std::size_t lane) HWY_ATTR {
            return shape_.isFlat ? of + std::size_t{4} * static_cast<std::uint32_t>(places[lane])
                                 : floatsOf(row, vector) + 4 * placeOfFour(lane);
          },
          values[0], values[1], values[2], values[3]);
    };
    F pair[4];
    F filter[4];
    pairs(frame.flatPairs.front().data(), RowShape::kPairs, pair);
    if (frame.needs.filters) pairs(frame.flatFilters.front().data(), RowShape::kFilters, filter);
    through.take(counts, pair[3], filter);
  }
  return !none(through.isTooLittle());
}

// The depth, as a key, from which on each pixel's fragments are hidden by those in front of them: 1 beyond that of the
// one behind which too little light is left.
inline I TileWorker::saturationOf(const Frame& frame, const SortedRows& sorted) const {
  Through through(frame);
  I until = set(kFarKey);
  alignas(64) std::int32_t keys[kLanes];
  alignas(64) std::int32_t whole[kLanes];
  const std::uint32_t everything = (1U << frame.info.samples) - 1;
  for (std::size_t r = 0; r < sorted.rows; ++r) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      keys[lane] = static_cast<std::int32_t>(sorted.depthKeyOf(r, lane));
      whole[lane] = keys[lane] < kFarKey ? 1 : 0;
      if (shape_.coverage == 0 || whole[lane] == 0) continue;
      const std::int32_t covered = rowOf(sorted, r, lane)[kLanes * shape_.coverage + lane];
      whole[lane] = static_cast<std::uint32_t>(covered) == everything ? 1 : 0;
    }
    F pair[4];
    F filter[4];
    loadFours([&](std::size_t lane) HWY_ATTR { return sorted.pairOf(r, lane); }, pair[0], pair[1], pair[2], pair[3]);
    if (frame.needs.filters) {
      loadFours([&](std::size_t lane) HWY_ATTR { return sorted.filterOf(r, lane); }, filter[0], filter[1], filter[2],
                filter[3]);
    }
    const M before = through.isTooLittle();
    through.take(load(whole) > set(0), pair[3], filter);
    const M after = through.isTooLittle();
    until = select(andNot(before, after), load(keys) + set(1), until);
    if (all(after)) break;
  }
  return until;
}

// Lets go of a block's fragments that are hidden. Whatever comes later can only move that depth nearer.
inline void TileWorker::thin(const Frame& frame, std::uint32_t block) {
  const auto limitOf = [](std::size_t rows) {
    const auto twice = static_cast<std::uint32_t>((2 * rows + kChunkRows - 1) / kChunkRows * kChunkRows);
    return std::max(Store::kFirstLimit, twice);
  };
  shadeBlock(frame, block);
  if (!mayHide(frame)) {
    const auto rows = static_cast<std::uint32_t>(rows_.size());
    return store_.keepFirst(block, rows, limitOf(rows));
  }
  const SortedRows sorted = sortBlock(frame, block);
  const I until = saturationOf(frame, sorted);
  if ((saturated_ >> block & 1U) == 0) store(hidden_[block], set(0));
  saturated_ |= std::uint64_t{1} << block;
  store(until_[block], until);
  std::uint32_t kept = 0;
  I hiddenCount = load(hidden_[block]);
  for (const Row row : rows_) {
    const I key = load(row);
    const M present = set(kFarKey) > key;
    const M shown = until > key;
    hiddenCount = hiddenCount + keep(andNot(shown, present), set(1));
    if (none(shown & present)) continue;
    const Row to = rows_[kept++];
    if (to != row) std::memcpy(to, row, shape_.bytes());
    store(to, select(shown, key, set(kFarKey)));
  }
  store(hidden_[block], hiddenCount);
  store_.keepFirst(block, kept, limitOf(kept));
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
