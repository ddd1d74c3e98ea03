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

// With how many rows a block is crowded again that has kept so many.
constexpr std::uint32_t limitOf(std::uint32_t rows) {
  return std::max(Store::kFirstLimit, (2 * rows + kChunkRows - 1) / kChunkRows * kChunkRows);
}

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
    pairs(colors_.pairs(), RowShape::kPairs, pair);
    if (frame.needs.filters) pairs(colors_.filters(), RowShape::kFilters, filter);
    through.take(counts, pair[3], filter);
  }
  return !none(through.isTooLittle());
}

// The same of flat fragments, of which the block's rows that were looked at before are left out: through_ is what came
// through them.
inline bool TileWorker::mayHideFlat(const Frame& frame, std::uint32_t block) {
  const std::size_t first = store_.shadedRows(block);
  F through = first == 0 ? set(1.0F) : load(through_[block]);
  for (std::size_t r = first; r < rows_.size(); ++r) {
    const std::int32_t* draws = rows_[r] + kLanes * RowShape::kNumber; // of what is not there: one that does nothing
    const bool isOne = all(load(draws) == set(draws[0]));
    F alpha = set(colors_.alphaOf(draws[0]));
    if (!isOne) alpha = gather(colors_.pairs() + 3, shiftLeft<2>(load(draws)));
    through = fnma(through, alpha, through);
  }
  store(through_[block], through);
  return !none(set(frame.trackedTransmittance) > through);
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

// From these depths on a block's pixels show nothing. Whatever comes later can only move them nearer.
inline void TileWorker::hideFrom(std::uint32_t block, const I& until) {
  I nearer = until;
  if ((saturated_ >> block & 1U) != 0) {
    nearer = min(nearer, load(until_[block]));
  } else {
    store(hidden_[block], set(0));
  }
  saturated_ |= std::uint64_t{1} << block;
  store(until_[block], nearer);
  allUntil_[block] = mostOf(nearer);
}

// Lets go of what rows_ hold from until_ on, and returns how many rows are kept, the first ones.
inline std::uint32_t TileWorker::letGo(std::uint32_t block) {
  const I until = load(until_[block]);
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
  return kept;
}

// Lets go of a block's fragments that are hidden, all of which are shaded or flat.
inline void TileWorker::dropHidden(const Frame& frame, std::uint32_t block) {
  const SortedRows sorted = sortBlock(frame, block);
  hideFrom(block, saturationOf(frame, sorted));
  const std::uint32_t kept = letGo(block);
  store_.keepFirst(block, kept, kept, limitOf(kept));
}

// The same where what is hidden was found as it came; none of it is shaded.
inline void TileWorker::dropTracked(std::uint32_t block) {
  store_.collect(block, rows_);
  const std::uint32_t kept = letGo(block);
  store_.keepFirst(block, kept, 0, limitOf(kept));
}

// Of a fragment in some pixels of a block that hides so much at least: where those that have come, in whatever order,
// let too little light through, what is behind all of them is hidden. They come about from near to far
// (orderByDepth()), so that this is not far from the truth.
HWY_INLINE void TileWorker::trackHidden(const Frame& frame, std::uint32_t block, const M& here, const I& key,
                                        float alpha) {
  const F before = load(through_[block]);
  const F through = fnma(before, keep(here, set(alpha)), before);
  const I farthest = max(load(farthest_[block]), keep(here, key));
  store(through_[block], through);
  store(farthest_[block], farthest);
  const std::uint32_t opaque = bitsOf(set(frame.trackedTransmittance) > through);
  if (HWY_LIKELY(opaque == opaquePixels_[block])) return;
  hideFrom(block, select(maskOf(opaque & ~std::uint32_t{opaquePixels_[block]}), farthest + set(1), set(kFarKey)));
  opaquePixels_[block] = static_cast<std::uint16_t>(opaque);
}

// A block has become crowded: looks what of it is hidden, and lets go of that where it is worth it.
inline void TileWorker::thin(const Frame& frame, std::uint32_t block) {
  if (tracksHidden_) { // what hides was found as it came
    if ((saturated_ >> block & 1U) != 0) return frame.needs.shaded ? dropTracked(block) : dropHidden(frame, block);
    return store_.setLimit(block, limitOf(store_.rows(block)));
  }
  shadeBlock(frame, block);
  if (frame.isFlat() ? mayHideFlat(frame, block) : mayHide(frame)) return dropHidden(frame, block);
  const auto rows = static_cast<std::uint32_t>(rows_.size());
  store_.keepFirst(block, rows, rows, limitOf(rows));
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
