// A block's rows become pixels: sorted, one pixel a lane, and blended front to back (Porter and Duff's over, as pairs).
#if defined(VITRAIL_RESOLVE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_RESOLVE_INL_H
#undef VITRAIL_RESOLVE_INL_H
#else
#define VITRAIL_RESOLVE_INL_H
#endif

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#include "raster/cpu/colors-inl.h"
#include "raster/cpu/shade-inl.h"
#include "raster/cpu/sort-inl.h"
#include "raster/cpu/store-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

// Sorted rows: keys, whose lower halves say where a fragment's pair is, in units of 16 bytes from `pairs`.
class SortedRows {
 public:
  std::size_t rows = 0;
  double* keys = nullptr; // 16 a row
  const float* pairs = nullptr;
  const float* filters = nullptr;
  I listed;             // how many fragments there are, pixel by pixel
  bool isShaded = true; // all of them; else each row is shaded when one of its fragments is about to be blended

  HWY_INLINE std::uint64_t keyOf(std::size_t row, std::size_t lane) const {
    std::uint64_t key = 0;
    std::memcpy(&key, keys + row * kLanes + placeOfKey(lane), sizeof(key));
    return key;
  }
  HWY_INLINE void setKey(std::size_t row, std::size_t lane, std::uint64_t key) const {
    std::memcpy(keys + row * kLanes + placeOfKey(lane), &key, sizeof(key));
  }
  HWY_INLINE std::uint32_t placeOf(std::size_t row, std::size_t lane) const {
    std::uint32_t place = 0;
    std::memcpy(&place, keys + row * kLanes + placeOfKey(lane), sizeof(place));
    return place;
  }
  HWY_INLINE std::uint32_t depthKeyOf(std::size_t row, std::size_t lane) const {
    return static_cast<std::uint32_t>(keyOf(row, lane) >> 32U);
  }
  HWY_INLINE const float* pairOf(std::size_t row, std::size_t lane) const {
    return pairs + std::size_t{4} * placeOf(row, lane);
  }
  HWY_INLINE const float* filterOf(std::size_t row, std::size_t lane) const {
    return filters + std::size_t{4} * placeOf(row, lane);
  }
};

// Whether fragments at one depth stand in the same pixel of two neighbouring rows.
HWY_INLINE bool hasTies(const double* keys, std::size_t rows) {
  const hn::Repartition<std::int32_t, TagD> words;
  // Depths are the odd words.
  const auto far = hn::OddEven(hn::Set(words, kFarKey), hn::Set(words, INT32_MIN));
  for (std::size_t v = 0; v < kKeyVectors; ++v) {
    const double* column = keys + v * kKeyLanes;
    auto above = hn::BitCast(words, hn::Load(kD, column));
    auto found = hn::Zero(words);
    for (std::size_t r = 1; r < rows; ++r) {
      const auto here = hn::BitCast(words, hn::Load(kD, column + r * kLanes));
      const auto same = hn::And(hn::Eq(above, here), hn::Gt(far, here));
      found = hn::Or(found, hn::VecFromMask(words, same));
      above = here;
    }
    if (!hn::AllTrue(words, hn::Eq(found, hn::Zero(words)))) return true;
  }
  return false;
}

// Fragments of one depth in a pixel are ordered by what they do, never by when they came; those that do the same by
// what restOf(key, lane) gives.
template <class RestOf>
HWY_NOINLINE void orderTies(const SortedRows& sorted, bool filters, RestOf restOf) {
  std::size_t lane = 0;
  const auto compareBits = [](const void* a, const void* b, std::size_t floats) {
    return std::memcmp(a, b, floats * sizeof(float));
  };
  const auto before = [&](std::uint64_t a, std::uint64_t b) {
    const std::size_t at = std::size_t{4} * static_cast<std::uint32_t>(a);
    const std::size_t bt = std::size_t{4} * static_cast<std::uint32_t>(b);
    // What hides light is in front of what adds to it or filters it, as in the lists of GPUs; then by the bits.
    const int byPair = compareBits(sorted.pairs + at, sorted.pairs + bt, 4);
    if (sorted.pairs[at + 3] != sorted.pairs[bt + 3]) return sorted.pairs[at + 3] > sorted.pairs[bt + 3];
    if (byPair != 0) return byPair < 0;
    const int byFilter = filters ? compareBits(sorted.filters + at, sorted.filters + bt, 3) : 0;
    return byFilter != 0 ? byFilter < 0 : restOf(a, lane) < restOf(b, lane);
  };
  const auto depthOf = [](std::uint64_t key) { return static_cast<std::uint32_t>(key >> 32U); };
  std::vector<std::uint64_t> group;
  for (; lane < kLanes; ++lane) {
    std::uint64_t last = sorted.keyOf(0, lane);
    for (std::size_t r = 1; r < sorted.rows; ++r) {
      const std::uint64_t key = sorted.keyOf(r, lane);
      const bool isTie = depthOf(key) == depthOf(last);
      last = key;
      if (!isTie) continue;
      if (depthOf(key) >= static_cast<std::uint32_t>(kFarKey)) break;
      const std::size_t first = r - 1;
      group.assign(1, sorted.keyOf(first, lane));
      for (; r < sorted.rows && depthOf(sorted.keyOf(r, lane)) == depthOf(key); ++r)
        group.push_back(sorted.keyOf(r, lane));
      std::sort(group.begin(), group.end(), before);
      for (std::size_t i = 0; i < group.size(); ++i) sorted.setKey(first + i, lane, group[i]);
      if (r < sorted.rows) last = sorted.keyOf(r, lane);
    }
  }
}

// What the fragments of sixteen pixels, or of one sample of each, come to.
struct Blended {
  F color[3];
  F through;
  F filter[3];

  HWY_INLINE void clear() {
    for (F& c : color) c = set(0.0F);
    through = set(1.0F);
    for (F& f : filter) f = set(1.0F);
  }
};

template <bool kFilters>
HWY_INLINE M isAlive(const Blended& b, const F& least) {
  if constexpr (!kFilters) return b.through >= least;
  return max(max(b.filter[0], b.filter[1]), max(b.filter[2], b.through)) >= least;
}

// Puts fragments behind what is there: those that little light comes through to add nothing.
template <bool kFilters>
HWY_INLINE void put(Blended& b, const M& alive, const F* color, const F& alpha, const F* filter) {
  if constexpr (kFilters) {
    // Filters may multiply light beyond what a float holds, and an infinite filter makes a NaN of darkness.
    const F most = set(std::numeric_limits<float>::max());
    for (std::size_t c = 0; c < 3; ++c) {
      b.color[c] = fma(keep(alive, b.filter[c]), color[c], b.color[c]);
      b.filter[c] = select(alive, min(b.filter[c] * filter[c], most), b.filter[c]);
    }
    b.through = select(alive, fnma(b.through, alpha, b.through), b.through);
  } else {
    const F light = keep(alive, b.through);
    for (std::size_t c = 0; c < 3; ++c) b.color[c] = fma(light, color[c], b.color[c]);
    b.through = fnma(b.through, alpha, b.through);
  }
}

// What the fragments of a sorted row do.
template <bool kFilters>
HWY_INLINE void loadRow(const SortedRows& sorted, std::size_t r, F* color, F& alpha, F* filter) {
  loadFours([&](std::size_t lane) HWY_ATTR { return sorted.pairOf(r, lane); }, color[0], color[1], color[2], alpha);
  if constexpr (kFilters) {
    F unused;
    loadFours([&](std::size_t lane) HWY_ATTR { return sorted.filterOf(r, lane); }, filter[0], filter[1], filter[2],
              unused);
  }
}

template <bool kFilters>
HWY_INLINE void blendRows(const SortedRows& sorted, float leastTransmittance, Blended& blended) {
  const F least = set(leastTransmittance);
  for (std::size_t r = 0; r < sorted.rows; ++r) {
    const M alive = isAlive<kFilters>(blended, least);
    if (none(alive)) return;
    F color[3];
    F alpha;
    F filter[3];
    loadRow<kFilters>(sorted, r, color, alpha, filter);
    put<kFilters>(blended, alive, color, alpha, filter);
  }
}

// The same of draws without a shade function, of few colours.
HWY_INLINE void blendFlat(const SortedRows& sorted, const TileColors& colors, float leastTransmittance,
                          Blended& blended) {
  const F least = set(leastTransmittance);
  Blended b = blended; // in registers
  for (std::size_t r = 0; r < sorted.rows; ++r) {
    const M alive = isAlive<false>(b, least);
    if (none(alive)) break;
    const I numbers = restsOf(sorted.keys + r * kLanes);
    const F color[3] = {colors.lookUp(0, numbers), colors.lookUp(1, numbers), colors.lookUp(2, numbers)};
    put<false>(b, alive, color, colors.lookUp(3, numbers), nullptr);
  }
  blended = b;
}

// The same for each sample, by the coverage that stands in the rows.
template <bool kFilters>
HWY_INLINE void blendSamples(const SortedRows& sorted, const std::uint32_t* coverages, float leastTransmittance,
                             std::uint32_t samples, Blended* blended) {
  const F least = set(leastTransmittance);
  const F one = set(1.0F);
  for (std::size_t r = 0; r < sorted.rows; ++r) {
    bool isAnyAlive = false;
    for (std::uint32_t s = 0; s < samples; ++s) isAnyAlive = isAnyAlive || !none(isAlive<kFilters>(blended[s], least));
    if (!isAnyAlive) return;
    F color[3];
    F alpha;
    F filter[3];
    loadRow<kFilters>(sorted, r, color, alpha, filter);
    const I covered = load(reinterpret_cast<const std::int32_t*>(coverages) + r * kLanes);
    for (std::uint32_t s = 0; s < samples; ++s) {
      const I bit = set(static_cast<std::int32_t>(1U << s));
      const M here = (covered & bit) == bit;
      F colorHere[3];
      F filterHere[3];
      for (std::size_t c = 0; c < 3; ++c) colorHere[c] = keep(here, color[c]);
      if constexpr (kFilters) {
        for (std::size_t c = 0; c < 3; ++c) filterHere[c] = select(here, filter[c], one);
      }
      put<kFilters>(blended[s], isAlive<kFilters>(blended[s], least), colorHere, keep(here, alpha), filterHere);
    }
  }
}

// Over what is behind: r, g, b, alpha. Where none of it shows it may be anything, infinite, too.
template <bool kFilters>
HWY_INLINE void over(const Blended& b, float leastTransmittance, F* behind) {
  const M alive = isAlive<kFilters>(b, set(leastTransmittance));
  const F through = keep(alive, b.through);
  for (std::size_t c = 0; c < 3; ++c) {
    const F light = kFilters ? keep(alive, b.filter[c]) : through;
    behind[c] = fma(light, keep(light > set(0.0F), behind[c]), b.color[c]);
  }
  behind[3] = fma(through, keep(through > set(0.0F), behind[3]), set(1.0F) - through);
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
