// Transparent fragments of a tile: stored block by block, and where they do not fit, in parts and in windows of depth.
#if defined(VITRAIL_COLLECT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_COLLECT_INL_H
#undef VITRAIL_COLLECT_INL_H
#else
#define VITRAIL_COLLECT_INL_H
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>
#include <vector>

#include "raster/cpu/finish-inl.h"
#include "raster/cpu/hidden-inl.h"
#include "raster/cpu/rasterise-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

// Stores the fragments of a triangle in a block.
template <TileWorker::Kept kKept>
HWY_INLINE TileWorker::Emitted TileWorker::emitTransparent(const Frame& frame, std::uint32_t item, Window* window) {
  constexpr bool kShaded = isShaded(kKept);
  const Work work = work_[item];
  const std::uint32_t t = work.triangle();
  const std::uint32_t block = work.block();
  std::uint32_t mask = work.pixels();
  const F depth = depthOfWork(work);
  I keys[kMaxSamples];
  if (hasDepth_) mask = testDepth(frame, work, item, depth, keys);
  const I key = keyOfInner(depth, frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE);
  if (window != nullptr) {
    const std::uint32_t later = mask & ~bitsOf(load(window->until) > key);
    window->isCut = window->isCut || later != 0;
    mask &= ~later & bitsOf(key > load(window->after));
    if (window->isCounted) {
      store(layers_, load(layers_) + keep(maskOf(mask), set(1)));
      return Emitted::IsStored;
    }
  }
  std::uint32_t hidden = 0;
  if (HWY_UNLIKELY((saturated_ >> block & 1U) != 0)) {
    hidden = mask & ~bitsOf(load(until_[block]) > key);
    mask &= ~hidden;
    if (mask == 0) {
      countHidden(block, hidden);
      return Emitted::IsStored;
    }
  }
  if (mask == 0) return Emitted::IsStored;
  const std::int32_t* kept = nullptr;
  const Row row = store_.rowFor(block, mask, kept);
  if (HWY_UNLIKELY(row == nullptr)) { // it comes again
    return store_.isCrowded(block) ? Emitted::IsCrowded : Emitted::IsFull;
  }
  if (HWY_UNLIKELY(hidden != 0)) countHidden(block, hidden);
  const M here = maskOf(mask);
  const auto put = [&](std::uint32_t vector, const I& value)
                       HWY_ATTR { store(row + kLanes * vector, select(here, value, load(kept + kLanes * vector))); };
  put(RowShape::kKey, key);
  if constexpr (isTracked(kKept)) trackHidden(frame, block, here, key, hidingOf<kKept>(frame, batch_.draw[t]));
  if constexpr (!kShaded) {
    put(RowShape::kNumber, set(batch_.draw[t]));
  } else {
    F weights[6];
    perspective(work, frame.needs.derivatives, weights);
    put(RowShape::kNumber, set(batch_.number[t]));
    const std::uint32_t count = frame.needs.derivatives ? 6 : 2;
    for (std::uint32_t i = 0; i < count; ++i) put(RowShape::kSecond + i, bitsOf(weights[i]));
  }
  if (kShaded && shape_.coverage != 0) {
    I covered = set(0);
    std::uint32_t isEdge = 0;
    for (std::uint32_t s = 0; s < frame.info.samples; ++s) {
      covered = covered | keep(maskOf(sampleMasks_[s][item]), set(static_cast<std::int32_t>(1U << s)));
      isEdge |= mask & ~static_cast<std::uint32_t>(sampleMasks_[s][item]);
    }
    edges_ |= static_cast<std::uint64_t>(isEdge != 0) << block;
    put(shape_.coverage, covered);
  }
  return Emitted::IsStored;
}

// The same, and makes room where hidden fragments take it. False: the store is full.
template <TileWorker::Kept kKept>
HWY_INLINE bool TileWorker::emit(const Frame& frame, std::uint32_t item, Window* window) {
  Emitted emitted = emitTransparent<kKept>(frame, item, window);
  if (HWY_UNLIKELY(emitted == Emitted::IsCrowded)) {
    thin(frame, work_[item].block());
    emitted = emitTransparent<kKept>(frame, item, window);
  }
  return emitted == Emitted::IsStored;
}

// Stores fragments from an entry of work_ on, up to one that takes more than that: a chunk, a look at what is hidden
// where that is not tracked, a triangle that is careful or big. Returns which one that is. A part of emitTransparent(),
// with half as many instructions.
template <TileWorker::Kept kKept>
HWY_INLINE std::uint32_t TileWorker::emitPlain(const Frame& frame, std::uint32_t item, std::uint32_t count) {
  constexpr bool kTracked = isTracked(kKept);
  constexpr bool kShaded = isShaded(kKept);
  const std::uint32_t stride = (kShaded ? shape_.vectors : RowShape::kFlatVectors) * kLanes;
  const bool derivatives = frame.needs.derivatives;
  const bool nearestIsOne = frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
  const I flip = set(nearestIsOne ? -1 : 0); // as keyOfInner()
  const I base = set(nearestIsOne ? kOneBits + kNearestKey + 1 : kNearestKey);
  const F zero = set(0.0F);
  const F one = set(1.0F);
  const std::int32_t* const draws = batch_.draw;
  Store::Head* const heads = store_.heads();
  for (; item < count; ++item) {
    const Work work = work_[item];
    const std::uint32_t t = work.triangle();
    const std::uint32_t block = work.block();
    std::uint32_t mask = work.pixels();
    const F depth = planeAt(batch_, t, load(kBlockLanes.place[block][0]), load(kBlockLanes.place[block][1]));
    const I key = (bitsOf(min(max(depth, zero), one)) ^ flip) + base;
    if (HWY_UNLIKELY(batch_.careful[t] != 0)) break;
    if (kShaded && HWY_UNLIKELY(batch_.big[t] != 0)) break;
    std::uint32_t hidden = 0;
    if ((saturated_ >> block & 1U) != 0) {
      if (!kTracked) break;
      hidden = mask & ~bitsOf(load(until_[block]) > key);
      mask &= ~hidden;
    }
    const M here = maskOf(mask);
    Store::Head& head = heads[block];
    const std::uint32_t index = Store::freeRow(head, mask);
    const Row row = Store::rowAfter(head, index, stride);
    if (HWY_UNLIKELY(row > head.last)) break;
    if constexpr (kTracked) {
      if (hidden != 0) {
        if (frame.counts) countHidden(block, hidden);
        if (mask == 0) continue;
      }
      trackHidden(frame, block, here, key, hidingOf<kKept>(frame, draws[t]));
    }
    const std::int32_t* const kept = store_.take(head, mask, index, row);
    const auto put = [&](std::uint32_t vector, const I& value)
                         HWY_ATTR { store(row + kLanes * vector, select(here, value, load(kept + kLanes * vector))); };
    put(RowShape::kKey, key);
    if constexpr (!kShaded) {
      put(RowShape::kNumber, set(draws[t]));
    } else {
      F weights[6];
      perspective<true>(work, derivatives, weights);
      put(RowShape::kNumber, set(batch_.number[t]));
      put(RowShape::kSecond, bitsOf(weights[0]));
      put(RowShape::kThird, bitsOf(weights[1]));
      if (derivatives) {
        for (std::uint32_t i = 0; i < 4; ++i) put(RowShape::kDerivatives + i, bitsOf(weights[2 + i]));
      }
    }
  }
  return item;
}

// Stores the first `count` entries of work_. False: the store is full.
template <TileWorker::Kept kKept>
HWY_INLINE bool TileWorker::emitAll(const Frame& frame, std::uint32_t count) {
  const bool isPlain = !hasDepth_ && shape_.coverage == 0 && batch_.pieces == nullptr;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (isPlain) i = emitPlain<kKept>(frame, i, count);
    if (i < count && !emit<kKept>(frame, i, nullptr)) return false;
  }
  return true;
}

// False: the store is full.
template <TileWorker::Kept kKept>
inline bool TileWorker::collect(const Frame& frame, std::uint64_t blocks) {
  return rasterise(frame, blocks, isShaded(kKept),
                   [&](std::uint32_t count) HWY_ATTR { return emitAll<kKept>(frame, count); });
}

inline void TileWorker::drawParts(const Frame& frame, std::uint64_t blocks, TileCounts& counts) {
  store_.reset(Store::kFirstLimit);
  saturated_ = 0;
  allUntil_.fill(kFarKey);
  if (tracksHidden_) {
    opaquePixels_.fill(0);
    std::fill_n(through_[0], kBlocks * kLanes, 1.0F);
    std::fill_n(farthest_[0], kBlocks * kLanes, 0);
  }
  edges_ = 0;
  const auto collectAs = [&](auto whole, auto tracked) {
    return tracksHidden_ ? (this->*tracked)(frame, blocks) : (this->*whole)(frame, blocks);
  };
  const bool hasFitted = frame.needs.shaded
                             ? collectAs(&TileWorker::collect<Kept::Shaded>, &TileWorker::collect<Kept::ShadedTracked>)
                             : collectAs(&TileWorker::collect<Kept::Flat>, &TileWorker::collect<Kept::FlatTracked>);
  if (hasFitted) {
    for (std::uint64_t left = blocks; left != 0; left &= left - 1) {
      const auto block = static_cast<std::uint32_t>(std::countr_zero(left));
      if (store_.rows(block) == 0) {
        const bool isDrawn = opaque_ != nullptr && (opaque_->drawn >> block & 1U) != 0;
        if (isDrawn || frame.info.sampleColors != nullptr) {
          finishBlock(frame, block, nullptr);
        } else {
          untouched_ |= std::uint64_t{1} << block;
        }
        continue;
      }
      rowsBefore_ += store_.rows(block);
      const std::uint64_t next = left & (left - 1);
      if (next != 0) prefetchPixels(frame, static_cast<std::uint32_t>(std::countr_zero(next)));
      if (tracksHidden_ && frame.needs.shaded && (saturated_ >> block & 1U) != 0) dropTracked(block);
      resolveBlock(frame, block, counts);
    }
    return;
  }
  if ((blocks & (blocks - 1)) == 0)
    return drawInWindows(frame, static_cast<std::uint32_t>(std::countr_zero(blocks)), counts);
  // In two halves of as many blocks.
  std::uint64_t half = 0;
  std::uint64_t left = blocks;
  for (int i = std::popcount(blocks) / 2; i > 0; --i) {
    half |= left & (~left + 1);
    left &= left - 1;
  }
  drawParts(frame, half, counts);
  drawParts(frame, left, counts);
}

// Makes room: keeps about the nearer half of each pixel's fragments, and leaves the others to a later pass. Fragments
// of one depth stay together, so that no order among them is needed here.
inline void TileWorker::shrink(Window& window, std::uint32_t block) {
  using Entry = std::pair<std::int32_t, std::uint32_t>; // depth, row
  store_.collect(block, rows_);
  const std::size_t kept = rows_.size() / 2;
  std::array<std::vector<Entry>, kLanes> lists;
  std::size_t most = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    std::vector<Entry>& list = lists[lane];
    for (std::uint32_t r = 0; r < rows_.size(); ++r) {
      if (rows_[r][lane] < kFarKey) list.emplace_back(rows_[r][lane], r);
    }
    std::sort(list.begin(), list.end());
    if (list.size() > kept) {
      const auto cutAt = [&](std::int32_t depth) {
        return std::lower_bound(list.begin(), list.end(), Entry(depth, 0));
      };
      auto end = cutAt(list[kept].first);
      if (end == list.begin()) end = cutAt(list[0].first + 1);
      if (end != list.end()) {
        window.until[lane] = end->first;
        window.isCut = true;
        list.erase(end, list.end());
      }
    }
    most = std::max(most, list.size());
  }
  const bool isStuck = most == rows_.size(); // at one depth are more than fit: they are held at once

  const std::size_t stride = shape_.vectors * kLanes;
  std::vector<std::int32_t> copy(most * stride);
  for (std::size_t r = 0; r < most; ++r) { // what is not filled in below is not there, but names what exists
    std::memcpy(copy.data() + r * stride, rows_[r], shape_.bytes());
    std::fill_n(copy.data() + r * stride, kLanes, kFarKey);
    if (shape_.isFlat) std::fill_n(copy.data() + r * stride + kLanes * RowShape::kNumber, kLanes, 0);
  }
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    for (std::size_t r = 0; r < lists[lane].size(); ++r) {
      const Row from = rows_[lists[lane][r].second];
      for (std::size_t v = 0; v < shape_.vectors; ++v) copy[r * stride + v * kLanes + lane] = from[v * kLanes + lane];
    }
  }
  store_.restart(block, static_cast<std::uint32_t>(most));
  store_.collect(block, rows_);
  for (std::size_t r = 0; r < most; ++r) std::memcpy(rows_[r], copy.data() + r * stride, shape_.bytes());
  if (isStuck) store_.grow(); // and of pixels beside them what lies beyond the window is gone all the same
}

// A block whose fragments do not fit: the nearest ones are blended, then those behind them, and so on.
inline void TileWorker::drawInWindows(const Frame& frame, std::uint32_t block, TileCounts& counts) {
  State state;
  Window window;
  std::fill(std::begin(window.after), std::end(window.after), 0);
  alignas(64) std::array<std::int32_t, kLanes> layers{};
  do {
    window.isCut = false;
    std::fill(std::begin(window.until), std::end(window.until), kFarKey);
    store_.reset(Store::kNoLimit);
    saturated_ = 0;
    store(layers_, set(0));
    const auto emitOne = [&](std::uint32_t i) HWY_ATTR {
      return frame.needs.shaded ? emit<Kept::Shaded>(frame, i, &window) : emit<Kept::Flat>(frame, i, &window);
    };
    rasterise(frame, std::uint64_t{1} << block, frame.needs.shaded, [&](std::uint32_t count) HWY_ATTR {
      for (std::uint32_t i = 0; i < count; ++i) {
        while (!emitOne(i)) {
          if (frame.info.list != nullptr) {
            store_.grow(); // the hook takes whole lists
          } else {
            shrink(window, block);
          }
        }
      }
      return true;
    });
    if (store_.rows(block) > 0) {
      const SortedRows sorted = sortBlock(frame, block);
      if (frame.info.list != nullptr) {
        listBlock(frame, block, sorted);
      } else {
        blendInto(frame, block, sorted, state);
        window.isCounted = isHidden(frame, state);
      }
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      layers[lane] += layers_[lane];
      window.after[lane] = window.until[lane] - 1;
    }
  } while (window.isCut);
  count(layers.data(), counts);
  if (frame.info.list == nullptr) finishBlock(frame, block, &state);
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
