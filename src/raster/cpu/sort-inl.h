// Sorts the fragments of sixteen pixels at once, one pixel a lane, by comparisons that do not depend on what is
// compared: Batcher's merge exchange (Knuth, The Art of Computer Programming, 5.2.2, algorithm M). Short lists in
// registers, the others in memory.
#if defined(VITRAIL_SORT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_SORT_INL_H
#undef VITRAIL_SORT_INL_H
#else
#define VITRAIL_SORT_INL_H
#endif

#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "raster/cpu/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

// Calls exchange(i, i + distance) for every comparison of n values, in an order in which they may be made.
template <class Exchange>
constexpr void mergeExchange(std::size_t n, Exchange exchange) {
  std::size_t top = 1;
  while (top * 2 < n) top *= 2;
  for (std::size_t p = n > 1 ? top : 0; p > 0; p /= 2) {
    std::size_t q = top;
    std::size_t r = 0;
    for (std::size_t d = p;; d = q - p, q /= 2, r = p) {
      for (std::size_t i = 0; i + d < n; ++i) {
        if ((i & p) == r) exchange(i, i + d);
      }
      if (q == p) break;
    }
  }
}

constexpr std::size_t comparisonsOf(std::size_t n) {
  std::size_t count = 0;
  mergeExchange(n, [&count](std::size_t, std::size_t) { ++count; });
  return count;
}

template <std::size_t kRows>
struct Network {
  std::array<std::uint8_t, comparisonsOf(kRows) + 1> low{};
  std::array<std::uint8_t, comparisonsOf(kRows) + 1> high{};
  constexpr Network() {
    std::size_t count = 0;
    mergeExchange(kRows, [&](std::size_t i, std::size_t j) {
      low[count] = static_cast<std::uint8_t>(i);
      high[count++] = static_cast<std::uint8_t>(j);
    });
  }
};
template <std::size_t kRows>
inline constexpr Network<kRows> kNetwork{};

// Sorts a column of kRows keys, a vector wide, `kKeyVectors` vectors apart.
template <std::size_t kRows, std::size_t... kSteps>
HWY_INLINE void sortColumn(double* keys, std::index_sequence<kSteps...> /*steps*/) {
  Key rows[kRows];
  for (std::size_t r = 0; r < kRows; ++r) rows[r] = hn::Load(kD, keys + r * kLanes);
  (order(rows[kNetwork<kRows>.low[kSteps]], rows[kNetwork<kRows>.high[kSteps]]), ...);
  for (std::size_t r = 0; r < kRows; ++r) hn::Store(rows[r], kD, keys + r * kLanes);
}

// Whether no key of a row is behind that of its pixel in another row.
HWY_INLINE bool areInOrder(const double* column, const double* behind) {
  return hn::AllTrue(kD, hn::Le(hn::Load(kD, column), hn::Load(kD, behind)));
}

// The same of all rows of a column, each with the next. Where they come in any order the first pairs tell.
HWY_INLINE bool areInOrder(const double* column, std::size_t rows) {
  for (std::size_t r = 1; r < rows; ++r) {
    if (!areInOrder(column + (r - 1) * kLanes, column + r * kLanes)) return false;
  }
  return true;
}

template <std::size_t kRows>
HWY_NOINLINE void sortRows(double* keys) {
  for (std::size_t v = 0; v < kKeyVectors; ++v) {
    if (kRows > 8 && areInOrder(keys + v * kKeyLanes, kRows)) continue;
    sortColumn<kRows>(keys + v * kKeyLanes, std::make_index_sequence<comparisonsOf(kRows)>());
  }
}

// ---- Longer lists: runs that were sorted in registers are merged two by two (Batcher's bitonic merge). A run that is
// shorter than its partner is merged as if it went on with keys beyond all others, which never move.

constexpr std::size_t kRun = 32;

// Compares the keys of two rows.
HWY_INLINE void orderRows(double* column, std::size_t i, std::size_t j) {
  Key low = hn::Load(kD, column + i * kLanes);
  Key high = hn::Load(kD, column + j * kLanes);
  order(low, high);
  hn::Store(low, kD, column + i * kLanes);
  hn::Store(high, kD, column + j * kLanes);
}

// The comparisons that sort kRun values which first grow and then shrink, or the other way round.
struct CleanSteps {
  static constexpr std::size_t kCount = 80; // kRun / 2 for each power of two below it
  std::array<std::uint8_t, kCount> low{};
  std::array<std::uint8_t, kCount> high{};
  constexpr CleanSteps() {
    std::size_t count = 0;
    for (std::size_t s = kRun / 2; s > 0; s /= 2) {
      for (std::size_t r = 0; r < kRun; ++r) {
        if ((r & s) != 0) continue;
        low[count] = static_cast<std::uint8_t>(r);
        high[count++] = static_cast<std::uint8_t>(r + s);
      }
    }
  }
};
inline constexpr CleanSteps kCleanSteps{};

// One by one: in a loop the values would not stay in registers.
template <std::size_t... kSteps>
HWY_INLINE void cleanKeys(Key* keys, std::index_sequence<kSteps...> /*steps*/) {
  (order(keys[kCleanSteps.low[kSteps]], keys[kCleanSteps.high[kSteps]]), ...);
}

// Sorts up to kRun rows that first grow and then shrink, or the other way round.
HWY_INLINE void cleanRun(double* column, std::size_t rows) {
  using Steps = std::make_index_sequence<CleanSteps::kCount>;
  Key keys[kRun];
  if (HWY_LIKELY(rows == kRun)) {
    for (std::size_t r = 0; r < kRun; ++r) keys[r] = hn::Load(kD, column + r * kLanes);
    cleanKeys(keys, Steps());
    for (std::size_t r = 0; r < kRun; ++r) hn::Store(keys[r], kD, column + r * kLanes);
    return;
  }
  const Key beyond = hn::Set(kD, std::numeric_limits<double>::max());
  for (std::size_t r = 0; r < kRun; ++r) keys[r] = r < rows ? hn::Load(kD, column + r * kLanes) : beyond;
  cleanKeys(keys, Steps());
  for (std::size_t r = 0; r < rows; ++r) hn::Store(keys[r], kD, column + r * kLanes);
}

// Four rows that two steps of a merge compare: `a` with `c` and `b` with `d`, then `a` with `b` and `c` with `d`, of
// which the lower row gets the smaller key. Both steps at once, since memory is what long lists wait for.
template <bool kFallsBehind> // d is lower than c
HWY_INLINE void orderFour(double* column, std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
  Key keys[4] = {hn::Load(kD, column + a * kLanes), hn::Load(kD, column + b * kLanes),
                 hn::Load(kD, column + c * kLanes), hn::Load(kD, column + d * kLanes)};
  order(keys[0], keys[2]);
  order(keys[1], keys[3]);
  order(keys[0], keys[1]);
  order(keys[kFallsBehind ? 3 : 2], keys[kFallsBehind ? 2 : 3]);
  hn::Store(keys[0], kD, column + a * kLanes);
  hn::Store(keys[1], kD, column + b * kLanes);
  hn::Store(keys[2], kD, column + c * kLanes);
  hn::Store(keys[3], kD, column + d * kLanes);
}

// The same as cleanRun() of any number of rows up to `width`, a power of two.
HWY_INLINE void clean(double* column, std::size_t rows, std::size_t width) {
  std::size_t s = width / 2;
  for (; s >= 2 * kRun && rows == width; s /= 4) {
    const std::size_t half = s / 2;
    for (std::size_t first = 0; first < rows; first += 2 * s) {
      for (std::size_t r = first; r < first + half; ++r) orderFour<false>(column, r, r + half, r + s, r + s + half);
    }
  }
  for (; s >= kRun; s /= 2) {
    for (std::size_t first = 0; first + s < rows; first += 2 * s) {
      const std::size_t last = rows - s < first + s ? rows - s : first + s;
      for (std::size_t r = first; r < last; ++r) orderRows(column, r, r + s);
    }
  }
  for (std::size_t r = 0; r < rows; r += kRun) cleanRun(column + r * kLanes, rows - r < kRun ? rows - r : kRun);
}

// Merges two sorted runs, of `width` rows and of `behind`, at most as many.
HWY_INLINE void mergeTwo(double* low, std::size_t width, std::size_t behind) {
  double* const high = low + width * kLanes;
  if (areInOrder(high - kLanes, high)) return;
  if (behind == width && width >= 2 * kRun) {
    const std::size_t half = width / 2;
    for (std::size_t r = 0; r < half; ++r) {
      orderFour<true>(low, r, r + half, 2 * width - 1 - r, 2 * width - 1 - r - half);
    }
    clean(low, half, half);
    clean(low + half * kLanes, half, half);
    clean(high, half, half);
    clean(high + half * kLanes, half, half);
    return;
  }
  for (std::size_t r = 0; r < behind; ++r) orderRows(low, width - 1 - r, width + r);
  clean(low, width, width);
  clean(high, behind, width);
}

HWY_NOINLINE inline void mergeRuns(double* keys, std::size_t rows) {
  for (std::size_t v = 0; v < kKeyVectors; ++v) {
    double* const column = keys + v * kKeyLanes;
    for (std::size_t width = kRun; width < rows; width *= 2) {
      for (std::size_t first = 0; first + width < rows; first += 2 * width) {
        mergeTwo(column + first * kLanes, width, rows - first - width < width ? rows - first - width : width);
      }
    }
  }
}

// How many rows a list of so many is sorted with: those that are added hold kFarKey.
constexpr std::size_t sortedRows(std::size_t rows) {
  if (rows > kRun) return rows / kRun * kRun + sortedRows(rows % kRun);
  if (rows <= 8) return rows;
  if (rows <= 16) return (rows + 1) / 2 * 2;
  return (rows + 3) / 4 * 4;
}

inline void sortRun(double* keys, std::size_t rows) {
  switch (rows) {
    case 0:
    case 1:
      return;
#define VITRAIL_SORT(n) \
  case n:               \
    return sortRows<n>(keys);
      VITRAIL_SORT(2)
      VITRAIL_SORT(3)
      VITRAIL_SORT(4)
      VITRAIL_SORT(5)
      VITRAIL_SORT(6)
      VITRAIL_SORT(7)
      VITRAIL_SORT(8)
      VITRAIL_SORT(10)
      VITRAIL_SORT(12)
      VITRAIL_SORT(14)
      VITRAIL_SORT(16)
      VITRAIL_SORT(20)
      VITRAIL_SORT(24)
      VITRAIL_SORT(28)
      VITRAIL_SORT(32)
#undef VITRAIL_SORT
    default:
      return;
  }
}

// As many rows as sortedRows() says.
inline void sortKeys(double* keys, std::size_t rows) {
  for (std::size_t r = 0; r < rows; r += kRun) sortRun(keys + r * kLanes, rows - r < kRun ? rows - r : kRun);
  if (rows > kRun) mergeRuns(keys, rows);
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
