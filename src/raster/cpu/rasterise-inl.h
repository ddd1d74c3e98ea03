// A tile's triangles to the blocks in which they cover something, and what they are like there.
#if defined(VITRAIL_RASTERISE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_RASTERISE_INL_H
#undef VITRAIL_RASTERISE_INL_H
#else
#define VITRAIL_RASTERISE_INL_H
#endif

#include <hwy/cache_control.h>
#include <algorithm>
#include <cstring>

#include "raster/cpu/worker-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

// The numbers of all threads in one order, that of the draws.
inline void TileWorker::merge(const Frame& frame, std::uint32_t tile, bool opaque) {
  numbers_.clear();
  std::size_t lists = 0;
  for (const ThreadBins& thread : frame.bins) {
    const Bins& bins = opaque ? thread.opaque : thread.transparent;
    const std::uint32_t count = bins.countOf(tile);
    if (count == 0) continue;
    const std::size_t before = numbers_.size();
    numbers_.resize(before + count);
    bins.copy(tile, numbers_.data() + before);
    // Each list ascends: threads take jobs in ascending order.
    if (lists++ > 0) {
      std::inplace_merge(numbers_.begin(), numbers_.begin() + static_cast<std::ptrdiff_t>(before), numbers_.end());
    }
  }
}

// Puts the tile's flat triangles about from near to far, where there is so much of them that blocks may become opaque
// before most have come.
inline void TileWorker::orderByDepth(const Frame& frame) {
  tracksHidden_ = false;
  if (frame.ranks.empty()) return;
  runs_.clear();
  for (std::uint32_t i = 0; i < numbers_.size(); ++i) {
    const std::uint32_t job = numbers_[i] >> kJobBits;
    if (i == 0 || job != numbers_[i - 1] >> kJobBits) runs_.push_back({frame.ranks[job], i, 0});
    ++runs_.back().count;
  }
  // What comes through one layer of each job: a guess.
  float through = 1.0F;
  for (const Run& run : runs_) through *= 1.0F - frame.flatPairs[frame.jobs[numbers_[run.first] >> kJobBits].draw][3];
  tracksHidden_ = through < 0.5F * frame.leastTransmittance;
  if (!tracksHidden_) return;
  std::sort(runs_.begin(), runs_.end(), [](const Run& a, const Run& b) { return a.rank < b.rank; });
  ordered_.resize(numbers_.size());
  std::uint32_t* to = ordered_.data();
  for (const Run& run : runs_) to = std::copy_n(numbers_.data() + run.first, run.count, to);
  numbers_.swap(ordered_);
}

// Finds the corners of up to kBatch triangles, so that they are in cache when they are staged.
HWY_INLINE void TileWorker::fetch(const Frame& frame, std::size_t first, std::uint32_t count, Fetched* fetched) const {
  std::uint32_t jobNumber = ~0U;
  const VitrailCpuDraw* draw = nullptr;
  const Corner* corners = nullptr;
  std::uint32_t firstPrimitive = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t number = numbers_[first + i];
    if (number >> kJobBits != jobNumber) {
      jobNumber = number >> kJobBits;
      const Job& job = frame.jobs[jobNumber];
      const DrawInfo& info = frame.draws[job.draw];
      draw = &info.draw;
      corners = frame.corners.data() + info.firstVertex;
      firstPrimitive = job.first;
    }
    Fetched& f = fetched[i];
    f.draw = draw;
    if (HWY_UNLIKELY(draw->topology != VITRAIL_CPU_TRIANGLES)) {
      f.corners[0] = nullptr;
      continue;
    }
    const std::uint64_t at = std::uint64_t{firstPrimitive + (number & (kJobTriangles - 1))} * 3;
    for (std::uint64_t c = 0; c < 3; ++c) {
      f.corners[c] = corners + vertexOf(*draw, at + c);
      hwy::Prefetch(f.corners[c]);
    }
  }
}

HWY_INLINE void TileWorker::add(std::uint32_t number, const VitrailCpuDraw& draw, const Corner& a, const Corner& b,
                                const Corner& c) {
  const std::uint32_t at = batch_.count++;
  batch_.corners[0][at] = a;
  batch_.corners[1][at] = b;
  batch_.corners[2][at] = c;
  batch_.number[at] = static_cast<std::int32_t>(number);
  batch_.cull[at] = draw.cull;
  batch_.isPiece[at] = false;
}

// Adds a triangle to the batch, or what it is rasterised as. False: the store is full.
template <class Emit>
HWY_INLINE bool TileWorker::stage(const Frame& frame, std::uint32_t number, const Fetched& f, std::uint64_t blocks,
                                  Emit emit) {
  if (HWY_LIKELY(f.corners[0] != nullptr)) {
    const Corner& a = *f.corners[0];
    const Corner& b = *f.corners[1];
    const Corner& c = *f.corners[2];
    if (HWY_LIKELY(a.x != kNeedsClipping && b.x != kNeedsClipping && c.x != kNeedsClipping)) {
      add(number, *f.draw, a, b, c);
      return batch_.count < kBatch || flush(frame, blocks, emit);
    }
  }
  return stagePieces(frame, number, blocks, emit);
}

template <class Emit>
HWY_NOINLINE bool TileWorker::stagePieces(const Frame& frame, std::uint32_t number, std::uint64_t blocks, Emit emit) {
  const Job& job = frame.jobs[number >> kJobBits];
  const DrawInfo& info = frame.draws[job.draw];
  const Pieces pieces = piecesOf(frame, info, job.first + (number & (kJobTriangles - 1)));
  for (const Piece& piece : pieces.all()) {
    const std::uint32_t at = batch_.count;
    add(number, info.draw, piece.corners[0], piece.corners[1], piece.corners[2]);
    batch_.isPiece[at] = true;
    for (std::size_t i = 0; i < 3; ++i) {
      batch_.second[i][at] = piece.second[i];
      batch_.third[i][at] = piece.third[i];
    }
    if (batch_.count == kBatch && !flush(frame, blocks, emit)) return false;
  }
  return true;
}

// False: the store is full.
template <class Emit>
inline bool TileWorker::rasterise(const Frame& frame, std::uint64_t blocks, Emit emit) {
  batch_.count = 0;
  const std::size_t total = numbers_.size();
  const auto countAt = [total](std::size_t i) {
    return i < total ? static_cast<std::uint32_t>(std::min<std::size_t>(kBatch, total - i)) : 0U;
  };
  std::size_t turn = 0;
  fetch(frame, 0, countAt(0), fetched_[turn].data());
  for (std::size_t i = 0; i < total; i += kBatch, turn ^= 1U) {
    fetch(frame, i + kBatch, countAt(i + kBatch), fetched_[turn ^ 1U].data());
    const std::uint32_t count = countAt(i);
    for (std::uint32_t k = 0; k < count; ++k) {
      if (!stage(frame, numbers_[i + k], fetched_[turn][k], blocks, emit)) return false;
    }
  }
  return flush(frame, blocks, emit);
}

// Fragments that nothing shows of are counted all the same.
HWY_INLINE void TileWorker::countHidden(std::uint32_t block, std::uint32_t mask) {
  store(hidden_[block], load(hidden_[block]) + keep(maskOf(mask), set(1)));
}

// `kHides`: triangles that are behind all that shows of a block are only counted there. They are set aside first: a
// branch that nobody can foresee would cost as much as it spares.
template <bool kHides>
HWY_INLINE std::uint32_t TileWorker::cover(std::uint64_t blocks, std::uint32_t items) {
  std::uint32_t count = 0;
  std::uint32_t hidden = 0;
  for (std::uint32_t i = 0; i < items; ++i) {
    const std::uint32_t t = tags_[i];
    const std::uint32_t block = ids_[i];
    const I position = load(kBlockLanes.position[block]);
    I outside;
    if (HWY_LIKELY(!batch_.isBig)) {
      outside = multiplyHalves(set(batch_.c[0][0][t]), set(batch_.ab[0][t]), position) |
                multiplyHalves(set(batch_.c[0][1][t]), set(batch_.ab[1][t]), position) |
                multiplyHalves(set(batch_.c[0][2][t]), set(batch_.ab[2][t]), position);
    } else {
      const I x = position & set(0xffff);
      const I y = shiftRight<16>(position);
      outside = set(0);
      for (std::size_t k = 0; k < 3; ++k) {
        outside = outside | (set(batch_.c[0][k][t]) + set(batch_.a[k][t]) * x + set(batch_.b[k][t]) * y);
      }
    }
    const std::uint32_t mask = ~signsOf(outside) & tile_.pixels[block];
    const Work work{static_cast<std::uint8_t>(t), static_cast<std::uint8_t>(block), static_cast<std::uint16_t>(mask)};
    const std::uint32_t isThere =
        static_cast<std::uint32_t>(mask != 0) & static_cast<std::uint32_t>(blocks >> block & 1U);
    work_[count] = work;
    if constexpr (kHides) {
      const auto isHidden = static_cast<std::uint32_t>(nearest_[t] >= allUntil_[block]);
      hiddenWork_[hidden] = work;
      hidden += isThere & isHidden;
      count += isThere & (isHidden ^ 1U);
    } else {
      count += isThere;
    }
  }
  for (std::uint32_t i = 0; kHides && i < hidden; ++i) countHidden(hiddenWork_[i].block, hiddenWork_[i].pixels);
  return count;
}

HWY_INLINE std::uint32_t TileWorker::coverSamples(std::uint64_t blocks, std::uint32_t items, std::uint32_t samples) {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < items; ++i) {
    const std::uint32_t t = tags_[i];
    const std::uint32_t block = ids_[i];
    const I position = load(kBlockLanes.position[block]);
    const I x = position & set(0xffff);
    const I y = shiftRight<16>(position);
    I slope[3];
    for (std::size_t k = 0; k < 3; ++k) {
      slope[k] = batch_.isBig ? set(batch_.a[k][t]) * x + set(batch_.b[k][t]) * y
                              : multiplyHalves(set(0), set(batch_.ab[k][t]), position);
    }
    std::uint32_t any = 0;
    for (std::uint32_t s = 0; s < samples; ++s) {
      I outside = set(0);
      for (std::size_t k = 0; k < 3; ++k) outside = outside | (slope[k] + set(batch_.c[s][k][t]));
      const std::uint32_t mask = ~signsOf(outside) & tile_.pixels[block];
      sampleMasks_[s][count] = static_cast<std::uint16_t>(mask);
      any |= mask;
    }
    work_[count] = {static_cast<std::uint8_t>(t), static_cast<std::uint8_t>(block), static_cast<std::uint16_t>(any)};
    count += static_cast<std::uint32_t>(any != 0) & static_cast<std::uint32_t>(blocks >> block & 1U);
  }
  return count;
}

template <class Emit>
inline bool TileWorker::flush(const Frame& frame, std::uint64_t blocks, Emit emit) {
  const std::uint32_t triangles = batch_.count;
  batch_.count = 0;
  batch_.isBig = false;
  if (triangles == 0) return true;
  const std::uint32_t samples = frame.info.samples;
  const auto padded = std::min<std::uint32_t>(kBatch, (triangles + kLanes - 1) / kLanes * kLanes);
  for (std::uint32_t i = triangles; i < padded; ++i) { // what is set up with them is one that covers nothing
    for (auto& corners : batch_.corners) corners[i] = {};
    batch_.number[i] = 0;
    batch_.cull[i] = 0;
  }
  for (std::uint32_t i = 0; i < triangles; i += kLanes) setUpSixteen(batch_, i, tile_, samples);
  std::uint32_t items = 0;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    if (batch_.x1[t] < 0) continue;
    items += listBlocks(ids_.data() + items, tags_.data() + items, batch_.x0[t], batch_.x1[t], batch_.y0[t],
                        batch_.y1[t], static_cast<std::uint8_t>(t));
  }
  std::uint32_t count = 0;
  if (samples > 1) {
    count = coverSamples(blocks, items, samples);
  } else if (saturated_ == 0 || hasDepth_) {
    count = cover<false>(blocks, items);
  } else {
    const bool nearestIsOne = frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
    for (std::uint32_t i = 0; i < triangles; i += kLanes) {
      store(nearest_.data() + i, nearestOf(batch_, i, nearestIsOne));
    }
    count = cover<true>(blocks, items);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!emit(i)) return false;
  }
  return true;
}

HWY_INLINE TileWorker::Met TileWorker::meet(std::uint32_t item) const {
  Met met;
  met.work = work_[item];
  const std::uint32_t t = met.work.triangle;
  weightsAt(batch_, t, load(kBlockLanes.position[met.work.block]), met.second, met.third);
  met.depth = fma(met.third, set(batch_.z[2][t]), fma(met.second, set(batch_.z[1][t]), set(batch_.z[0][t])));
  return met;
}

// Perspective-correct weights of what the host handed over, and how they change: second, third, and with derivatives
// second to the right and down, third to the right and down.
HWY_INLINE void TileWorker::perspective(std::uint32_t t, const F& flatSecond, const F& flatThird, bool derivatives,
                                        F* weights) const {
  const F slope1 = set(batch_.w[1][t]);
  const F slope2 = set(batch_.w[2][t]);
  const F inverse = set(1.0F) / fma(flatThird, slope2, fma(flatSecond, slope1, set(batch_.w[0][t])));
  const F w1 = set(batch_.w1[t]);
  const F w2 = set(batch_.w2[t]);
  weights[0] = flatSecond * w1 * inverse;
  weights[1] = flatThird * w2 * inverse;
  if (derivatives) {
    const F scale = set(batch_.scale[t]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto& edges = axis == 0 ? batch_.a : batch_.b;
      const F second = toFloat(set(edges[1][t])) * scale;
      const F third = toFloat(set(edges[2][t])) * scale;
      const F change = fma(third, slope2, second * slope1);
      weights[2 + axis] = fnma(weights[0], change, w1 * second) * inverse;
      weights[4 + axis] = fnma(weights[1], change, w2 * third) * inverse;
    }
  }
  if (HWY_LIKELY(!batch_.isPiece[t])) return;
  const auto whole = [&](const float(&at)[3][kBatch], const F& second, const F& third, float base) HWY_ATTR {
    return fma(third, set(at[2][t] - at[0][t]), fma(second, set(at[1][t] - at[0][t]), set(base)));
  };
  const F second = weights[0];
  const F third = weights[1];
  weights[0] = whole(batch_.second, second, third, batch_.second[0][t]);
  weights[1] = whole(batch_.third, second, third, batch_.third[0][t]);
  if (!derivatives) return;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const F secondSlope = weights[2 + axis];
    const F thirdSlope = weights[4 + axis];
    weights[2 + axis] = whole(batch_.second, secondSlope, thirdSlope, 0.0F);
    weights[4 + axis] = whole(batch_.third, secondSlope, thirdSlope, 0.0F);
  }
}

// The pixels in which something of a triangle is not behind an opaque surface. With several samples, sampleMasks_ keeps
// those that are not; `keys` takes the depths of each sample, or of the pixel.
HWY_INLINE std::uint32_t TileWorker::testDepth(const Frame& frame, const Work& work, std::uint32_t item, const F& depth,
                                               I* keys) {
  const bool nearestIsOne = frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
  const std::uint32_t samples = frame.info.samples;
  if (samples == 1) {
    keys[0] = keyOf(depth, nearestIsOne);
    return work.pixels & ~bitsOf(keys[0] > load(opaque_->depth[0].value[work.block]));
  }
  std::uint32_t any = 0;
  for (std::uint32_t s = 0; s < samples; ++s) {
    keys[s] = keyOf(depth + set(batch_.sampleDepth[s][work.triangle]), nearestIsOne);
    std::uint16_t& mask = sampleMasks_[s][item];
    mask = static_cast<std::uint16_t>(mask & ~bitsOf(keys[s] > load(opaque_->depth[s].value[work.block])));
    any |= mask;
  }
  return any;
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
