// A block's rows to pixels: shaded, sorted, blended over what is behind them, and written; or handed to the host.
#if defined(VITRAIL_FINISH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_FINISH_INL_H
#undef VITRAIL_FINISH_INL_H
#else
#define VITRAIL_FINISH_INL_H
#endif

#include <hwy/cache_control.h>
#include <algorithm>
#include <bit>
#include <cstring>

#include "raster/cpu/worker-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

// So many in each of sixteen pixels add up to what 32 bits hold.
constexpr std::int32_t kMostSummed = INT32_MAX / static_cast<std::int32_t>(kLanes);

inline void TileWorker::count(const std::int32_t* layers, TileCounts& counts) {
  const I here = load(layers);
  const I most = set(kMostSummed);
  counts.pixels += static_cast<std::uint64_t>(std::popcount(bitsOf(here > set(0))));
  if (HWY_LIKELY(none(here > most))) {
    counts.fragments += static_cast<std::uint32_t>(sumOf(here));
  } else {
    for (std::size_t lane = 0; lane < kLanes; ++lane) counts.fragments += static_cast<std::uint32_t>(layers[lane]);
  }
  counts.layersMax = std::max(counts.layersMax, static_cast<std::uint32_t>(mostOf(here)));
}

// Whether nothing shows behind what was blended of a block.
inline bool TileWorker::isHidden(const Frame& frame, const State& state) {
  const F least = set(frame.leastTransmittance);
  for (std::uint32_t s = 0; s < (state.isUniform ? 1 : frame.info.samples); ++s) {
    const Blended& b = state.samples[s];
    if (!none(frame.needs.filters ? isAlive<true>(b, least) : isAlive<false>(b, least))) return false;
  }
  return true;
}

// Shades rows_ from `first` on. What is not there after all is not counted any more.
inline void TileWorker::shadeRowsFrom(const Frame& frame, std::uint32_t block, std::size_t first) {
  const std::uint32_t x = frame.info.originX + blockX(block);
  const std::uint32_t y = frame.info.originY + blockY(block);
  for (std::size_t r = first; r < rows_.size(); ++r) {
    const std::uint32_t gone = shadeRow(frame, rows_[r], x, y, fragments_);
    store(layers_, load(layers_) - keep(maskOf(gone), set(1)));
  }
  store_.setShaded(block);
}

// Collects a block's rows, and shades those that are not.
inline void TileWorker::shadeBlock(const Frame& frame, std::uint32_t block) {
  store_.collect(block, rows_);
  if (frame.needs.shaded) shadeRowsFrom(frame, block, store_.shadedRows(block));
}

// Whether a block's rows wait until one of their fragments is about to be blended: where there are many, the last ones
// may be hidden. Rows that are shaded in the order of depth take about a tenth longer than in the order in which they
// came, so it is tried with one of 32 such blocks, and those after it follow while it spares a sixth of the rows.
inline bool TileWorker::shadesOnDemand(const Frame& frame, std::uint32_t block) {
  constexpr std::uint32_t kMany = 12;
  const bool mayPay = frame.needs.shaded && frame.leastTransmittance > 0.0F && frame.info.list == nullptr &&
                      (edges_ >> block & 1U) == 0 && store_.rows(block) >= store_.shadedRows(block) + kMany;
  return mayPay && (demand_.asked++ % 32 == 0 || demand_.pays);
}

inline SortedRows TileWorker::sortBlock(const Frame& frame, std::uint32_t block) {
  SortedRows sorted;
  sorted.isShaded = !shadesOnDemand(frame, block);
  if (sorted.isShaded) {
    shadeBlock(frame, block);
  } else {
    store_.collect(block, rows_);
  }
  sorted.rows = sortedRows(rows_.size());
  if (keyMemory_.size() < sorted.rows * kLanes + kLanes) keyMemory_.resize(2 * sorted.rows * kLanes + kLanes);
  sorted.keys = aligned(keyMemory_.data());
  const I places = load(kPairPlaces.place);
  I listed = set(0); // not in `sorted` itself: that would be memory, written for each row
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const Row row = rows_[r];
    I place;
    if (frame.needs.shaded) {
      const std::ptrdiff_t first = reinterpret_cast<const float*>(row + kLanes * RowShape::kPairs) - store_.base();
      place = places + set(static_cast<std::int32_t>(first / 4));
    } else {
      place = load(row + kLanes * RowShape::kNumber);
    }
    const I depths = load(row);
    listed = listed + keep(set(kFarKey) > depths, set(1));
    Key keys[kKeyVectors];
    keysOf(depths, place, keys);
    for (std::size_t v = 0; v < kKeyVectors; ++v) hn::Store(keys[v], kD, sorted.keys + r * kLanes + v * kKeyLanes);
  }
  sorted.listed = listed;
  store(layers_, (saturated_ >> block & 1U) != 0 ? listed + load(hidden_[block]) : listed);
  // What fills the list up is farther than what is not there: it comes last, and nothing looks at it.
  for (std::size_t r = rows_.size(); r < sorted.rows; ++r) {
    Key keys[kKeyVectors];
    keysOf(set(kFarKey + 1), set(0), keys);
    for (std::size_t v = 0; v < kKeyVectors; ++v) hn::Store(keys[v], kD, sorted.keys + r * kLanes + v * kKeyLanes);
  }
  if (frame.needs.shaded) {
    sorted.pairs = store_.base();
    sorted.filters = store_.base() + kLanes * (RowShape::kFilters - RowShape::kPairs);
  } else {
    sorted.pairs = colors_.pairs();
    sorted.filters = colors_.filters();
  }
  sortKeys(sorted.keys, sorted.rows);
  sorted.rows = rows_.size(); // those that were added are last
  if (HWY_UNLIKELY(hasTies(sorted.keys, sorted.rows))) {
    // What comes first is told by what the fragments do.
    if (!sorted.isShaded) shadeRowsFrom(frame, block, store_.shadedRows(block));
    sorted.isShaded = true;
    if (frame.info.list == nullptr) {
      orderTies(sorted, frame.needs.filters, [](std::uint64_t, std::size_t) { return 0; });
    } else { // the hook sees more of them than what they do
      orderTies(sorted, frame.needs.filters,
                [&](std::uint64_t key, std::size_t lane) { return hookOrderOf(frame, key, lane); });
    }
  }
  return sorted;
}

// Nobody looks at a row's depths once they are sorted: a number below all of them says that it was shaded.
constexpr std::int32_t kShadedMark = -1;

// Shades the rows in which some lanes' fragments of a sorted row are, where they are not, and returns how many it were.
HWY_INLINE std::uint32_t TileWorker::demand(const Frame& frame, std::uint32_t block, const SortedRows& sorted,
                                            std::size_t r, std::uint32_t lanes) {
  Row last = nullptr;
  std::uint32_t shaded = 0;
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const Row row = rowOf(sorted, r, static_cast<std::size_t>(std::countr_zero(left)));
    if (row == last) continue;
    last = row;
    if (*row == kShadedMark) continue;
    const std::uint32_t gone =
        shadeRow(frame, row, frame.info.originX + blockX(block), frame.info.originY + blockY(block), fragments_);
    store(layers_, load(layers_) - keep(maskOf(gone), set(1)));
    *row = kShadedMark;
    ++shaded;
  }
  return shaded;
}

// Blends sorted rows, and shades what it needs.
template <bool kFilters>
inline void TileWorker::blendOnDemand(const Frame& frame, std::uint32_t block, const SortedRows& sorted,
                                      Blended& blended) {
  for (std::uint32_t r = 0; r < store_.shadedRows(block); ++r) *rows_[r] = kShadedMark;
  const F least = set(frame.leastTransmittance);
  std::uint32_t shaded = 0;
  for (std::size_t r = 0; r < sorted.rows; ++r) {
    const M needed = isAlive<kFilters>(blended, least) & (sorted.listed > set(static_cast<std::int32_t>(r)));
    if (none(needed)) break;
    shaded += demand(frame, block, sorted, r, bitsOf(needed));
    F color[3];
    F alpha;
    F filter[3];
    loadRow<kFilters>(sorted, r, color, alpha, filter);
    for (F& c : color) c = keep(needed, c); // where nothing is needed may be anything
    put<kFilters>(blended, needed, color, keep(needed, alpha), filter);
  }
  const std::size_t rows = rows_.size() - store_.shadedRows(block);
  demand_.pays = 6 * (rows - shaded) >= rows;
}

inline void TileWorker::blendInto(const Frame& frame, std::uint32_t block, const SortedRows& sorted, State& state) {
  const float least = frame.leastTransmittance;
  if (state.isUniform && (edges_ >> block & 1U) == 0) {
    if (!sorted.isShaded) {
      if (frame.needs.filters) return blendOnDemand<true>(frame, block, sorted, state.samples[0]);
      return blendOnDemand<false>(frame, block, sorted, state.samples[0]);
    }
    if (frame.needs.filters) {
      blendRows<true>(sorted, least, state.samples[0]);
    } else if (!frame.needs.shaded && colors_.areFew()) {
      blendFlat(sorted, colors_, least, state.samples[0]);
    } else {
      blendRows<false>(sorted, least, state.samples[0]);
    }
    return;
  }
  state.separate(frame.info.samples);
  coverageMemory_.resize((sorted.rows + 1) * kLanes + kLanes);
  auto* coverages = aligned(coverageMemory_.data());
  coveragesOf(sorted, coverages);
  if (frame.needs.filters) {
    blendSamples<true>(sorted, coverages, least, frame.info.samples, state.samples);
  } else {
    blendSamples<false>(sorted, coverages, least, frame.info.samples, state.samples);
  }
}

// The coverage of sorted fragments, row by row.
inline void TileWorker::coveragesOf(const SortedRows& sorted, std::uint32_t* coverages) const {
  for (std::size_t r = 0; r < sorted.rows; ++r) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const bool isThere = sorted.depthKeyOf(r, lane) < static_cast<std::uint32_t>(kFarKey);
      const std::int32_t* covered = rowOf(sorted, r, lane) + kLanes * shape_.coverage;
      coverages[r * kLanes + lane] = isThere ? static_cast<std::uint32_t>(covered[lane]) : 0;
    }
  }
}

// What tells fragments apart that do the same, for those that see all of it.
inline std::array<std::uint32_t, 4> TileWorker::hookOrderOf(const Frame& frame, std::uint64_t key,
                                                            std::size_t lane) const {
  const std::int32_t* const values = rowAt(static_cast<std::uint32_t>(key), lane) + lane;
  const VitrailCpuDraw& draw = drawOfNumber(frame, values[kLanes * RowShape::kNumber]);
  const std::int32_t coverage = shape_.coverage == 0 ? 1 : values[kLanes * shape_.coverage];
  return {static_cast<std::uint32_t>(draw.blend), draw.shadeFlags & VITRAIL_CPU_SHADE_FILTER, draw.word,
          static_cast<std::uint32_t>(coverage)};
}

inline const VitrailCpuDraw& TileWorker::drawOfNumber(const Frame& frame, std::int32_t number) {
  const std::uint32_t job = (static_cast<std::uint32_t>(number) & ~kFrontBit) >> kJobBits;
  return frame.draws[frame.jobs[job].draw].draw;
}

// The row of a sorted fragment. Of flat ones, whose place is that of their draw's pair, nobody asks: with several
// samples or a hook everything is shaded (frame_rules.cpp).
inline Row TileWorker::rowOf(const SortedRows& sorted, std::size_t r, std::size_t lane) const {
  return rowAt(sorted.placeOf(r, lane), lane);
}

inline Row TileWorker::rowAt(std::uint32_t place, std::size_t lane) const {
  const std::size_t first = place - placeOfFour(lane); // of the row's pairs, in units of four
  return store_.arena() + first * 4 - kLanes * RowShape::kPairs;
}

inline void TileWorker::resolveBlock(const Frame& frame, std::uint32_t block, TileCounts& counts) {
  const SortedRows sorted = sortBlock(frame, block);
  if (frame.info.list != nullptr) {
    count(layers_, counts);
    return listBlock(frame, block, sorted);
  }
  State state;
  blendInto(frame, block, sorted, state);
  count(layers_, counts); // what is shaded while it is blended may turn out not to be there
  finishBlock(frame, block, &state);
}

// Pixels of a block that lies within a picture of floats: the address of each one's four.
HWY_INLINE float* TileWorker::pixelsOf(const Frame& frame, std::uint32_t block, std::size_t& stride) const {
  const std::uint32_t x = block % kBlocksAcross * kBlockSide;
  const std::uint32_t y = block / kBlocksAcross * kBlockSide;
  const bool isWithin = static_cast<std::int32_t>(x + kBlockSide) <= tile_.lastX + 1 &&
                        static_cast<std::int32_t>(y + kBlockSide) <= tile_.lastY + 1;
  if (!isWithin || frame.info.colorFormat != VITRAIL_CPU_RGBA32F || frame.info.sampleColors != nullptr) return nullptr;
  stride = frame.info.colorStride / sizeof(float);
  return static_cast<float*>(frame.info.color) + (static_cast<std::uint32_t>(tile_.y) + y) * stride +
         (static_cast<std::uint32_t>(tile_.x) + x) * std::size_t{4};
}

// Asks for a block's pixels, so that they are in cache when it is finished: the picture is in memory, and what is
// stored to it stands in the way of all that is stored after it.
HWY_INLINE void TileWorker::prefetchPixels(const Frame& frame, std::uint32_t block) const {
  std::size_t stride = 0;
  const float* const first = pixelsOf(frame, block, stride);
  if (first == nullptr) return;
  for (std::size_t y = 0; y < kBlockSide; ++y) {
    hwy::Prefetch(first + y * stride);
    hwy::Prefetch(first + y * stride + 4 * kBlockSide - 1);
  }
}

// What is behind the transparent fragments of a block, in each sample.
inline void TileWorker::behind(const Frame& frame, std::uint32_t block, std::uint32_t sample, F* color) {
  if (opaque_ != nullptr && (opaque_->drawn >> block & 1U) != 0) {
    for (std::size_t c = 0; c < 4; ++c) color[c] = load(opaque_->color[sample].value[c][block]);
    return;
  }
  behindAll(frame, block, sample, color);
}

// What is behind all that the frame draws.
inline void TileWorker::behindAll(const Frame& frame, std::uint32_t block, std::uint32_t sample, F* color) {
  if (frame.info.clear != nullptr) {
    for (std::size_t c = 0; c < 4; ++c) color[c] = set(frame.info.clear[c]);
    if (frame.info.colorFormat == VITRAIL_CPU_RGBA8_SRGB) color[3] = set(1.0F);
    return;
  }
  std::size_t stride = 0;
  if (const float* first = pixelsOf(frame, block, stride)) {
    return loadPixels(first, stride, color[0], color[1], color[2], color[3]);
  }
  if (sample == 0 || frame.info.sampleColors != nullptr) readPixels(frame, tile_, block, sample, behind_);
  for (std::size_t c = 0; c < 4; ++c) color[c] = load(behind_.color[c]);
}

// Keeps the picture's pixels, r, g, b, alpha, until the tile is done: the picture is in memory, and what waits to be
// stored there holds up all that is stored, and read again, after it.
inline void TileWorker::write(const Frame& frame, std::uint32_t block, const F* color) {
  std::size_t stride = 0;
  if (pixelsOf(frame, block, stride) == nullptr) {
    for (std::size_t c = 0; c < 4; ++c) store(pixels_.color[c], color[c]);
    writePixels(frame, tile_, block, pixels_);
    return;
  }
  storePixels(drawn_[block].data(), color[0], color[1], color[2], color[3]);
  written_ |= std::uint64_t{1} << block;
}

// Writes what write() has kept.
inline void TileWorker::writeTile(const Frame& frame) {
  constexpr std::size_t kRow = 4 * kBlockSide; // floats
  for (std::uint32_t row = 0; row < kBlocksAcross; ++row) {
    for (std::uint32_t y = 0; y < kBlockSide; ++y) {
      for (std::uint64_t left = written_ >> row * kBlocksAcross & 0xffU; left != 0; left &= left - 1) {
        const std::uint32_t block = row * kBlocksAcross + static_cast<std::uint32_t>(std::countr_zero(left));
        std::size_t stride = 0;
        float* const to = pixelsOf(frame, block, stride) + y * stride;
        const float* const from = drawn_[block].data() + y * kRow;
        for (std::size_t i = 0; i < kRow; i += kVectorLanes) hn::StoreU(hn::Load(kF, from + i), kF, to + i);
      }
    }
  }
  written_ = 0;
}

// Adds samples up in pairs, by add(to, from), so that the sum comes to the first: the mean of eight that are alike is
// then what they are, as where nothing is drawn.
template <class Add>
HWY_INLINE void addInPairs(std::uint32_t samples, Add add) {
  for (std::uint32_t step = 1; step < samples; step *= 2) {
    for (std::uint32_t s = 0; s < samples; s += 2 * step) add(s, s + step);
  }
}

// The mean of the samples, each over what is behind it.
inline void TileWorker::blendedOver(const Frame& frame, std::uint32_t block, const State* state, F* mean) {
  const std::uint32_t samples = frame.info.samples;
  F colors[kMaxSamples][4];
  for (std::uint32_t s = 0; s < samples; ++s) {
    behind(frame, block, s, colors[s]);
    if (state == nullptr) continue;
    if (frame.needs.filters) {
      over<true>(state->of(s), frame.leastTransmittance, colors[s]);
    } else {
      over<false>(state->of(s), frame.leastTransmittance, colors[s]);
    }
  }
  addInPairs(samples, [&](std::uint32_t to, std::uint32_t from) HWY_ATTR {
    for (std::size_t c = 0; c < 4; ++c) colors[to][c] = colors[to][c] + colors[from][c];
  });
  for (std::size_t c = 0; c < 4; ++c) mean[c] = colors[0][c] * set(1.0F / static_cast<float>(samples));
}

inline void TileWorker::finishBlock(const Frame& frame, std::uint32_t block, const State* state) {
  F color[4];
  blendedOver(frame, block, state, color);
  write(frame, block, color);
}

// Hands each pixel's fragments to the host, and blends those that it does not.
inline void TileWorker::listBlock(const Frame& frame, std::uint32_t block, const SortedRows& sorted) {
  const std::uint32_t samples = frame.info.samples;
  State state;
  blendInto(frame, block, sorted, state);
  alignas(64) float behindColors[kMaxSamples][4][kLanes];
  alignas(64) float result[4][kLanes];
  for (std::uint32_t s = 0; s < samples; ++s) {
    F color[4];
    behind(frame, block, s, color);
    for (std::size_t c = 0; c < 4; ++c) store(behindColors[s][c], color[c]);
  }
  F blended[4];
  blendedOver(frame, block, &state, blended);
  for (std::size_t c = 0; c < 4; ++c) store(result[c], blended[c]);
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t x = blockX(block) + lane % kBlockSide;
    const std::uint32_t y = blockY(block) + lane / kBlockSide;
    if (x >= frame.info.width || y >= frame.info.height) continue;
    layersOf(frame, sorted, lane);
    if (list_.empty()) continue;
    float color[4 * kMaxSamples];
    for (std::uint32_t s = 0; s < samples; ++s) {
      for (std::size_t c = 0; c < 4; ++c) color[4 * s + c] = behindColors[s][c][lane];
    }
    const int isBlended = frame.info.list(frame.info.listUser, frame.info.originX + x, frame.info.originY + y,
                                          list_.data(), static_cast<std::uint32_t>(list_.size()), color);
    if (isBlended == 0) continue;
    addInPairs(samples, [&](std::uint32_t to, std::uint32_t from) HWY_ATTR {
      for (std::size_t c = 0; c < 4; ++c) color[4 * to + c] += color[4 * from + c];
    });
    for (std::size_t c = 0; c < 4; ++c) result[c][lane] = color[c] / static_cast<float>(samples);
  }
  for (std::size_t c = 0; c < 4; ++c) blended[c] = load(result[c]);
  write(frame, block, blended);
}

// A pixel's fragments as the host sees them, in list_.
inline void TileWorker::layersOf(const Frame& frame, const SortedRows& sorted, std::uint32_t lane) {
  list_.clear();
  for (std::size_t r = 0; r < sorted.rows; ++r) {
    const std::uint32_t key = sorted.depthKeyOf(r, lane);
    if (key >= static_cast<std::uint32_t>(kFarKey)) break;
    const Row row = rowOf(sorted, r, lane);
    const VitrailCpuDraw& draw = drawOfNumber(frame, row[kLanes * RowShape::kNumber + lane]);
    const bool isOne = frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
    const std::int32_t bits =
        isOne ? kOneBits + kNearestKey - static_cast<std::int32_t>(key) : static_cast<std::int32_t>(key) - kNearestKey;
    VitrailLayer layer{};
    std::memcpy(&layer.depth, &bits, sizeof(bits));
    layer.blend = static_cast<std::uint32_t>(draw.blend);
    layer.coverage = shape_.coverage == 0 ? 1 : static_cast<std::uint32_t>(row[kLanes * shape_.coverage + lane]);
    layer.word = draw.word;
    appendLayers(draw, sorted.pairOf(r, lane), frame.needs.filters ? sorted.filterOf(r, lane) : nullptr, layer, list_);
  }
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
