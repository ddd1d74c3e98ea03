// A tile's triangles to the blocks in which they cover something, and what they are like there.
#if defined(VITRAIL_RASTERISE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_RASTERISE_INL_H
#undef VITRAIL_RASTERISE_INL_H
#else
#define VITRAIL_RASTERISE_INL_H
#endif

#include <hwy/cache_control.h>
#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>
#include <utility>

#include "raster/cpu/worker-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

// The numbers of all threads, those of each in the order of the draws.
inline void TileWorker::takeNumbers(const Frame& frame, std::uint32_t tile, bool opaque) {
  numbers_.clear();
  lists_.clear();
  for (const ThreadBins& thread : frame.bins) {
    const Bins& bins = opaque ? thread.opaque : thread.transparent;
    const std::uint32_t count = bins.countOf(tile);
    if (count == 0) continue;
    lists_.push_back(numbers_.size());
    numbers_.resize(numbers_.size() + count);
    bins.copy(tile, numbers_.data() + lists_.back());
  }
}

// Puts them into one order, that of the draws. Jobs ascend in each list: threads take them in ascending order.
inline void TileWorker::merge() {
  for (std::size_t i = 1; i < lists_.size(); ++i) {
    const std::size_t end = i + 1 < lists_.size() ? lists_[i + 1] : numbers_.size();
    const auto first = numbers_.begin();
    std::inplace_merge(first, first + static_cast<std::ptrdiff_t>(lists_[i]), first + static_cast<std::ptrdiff_t>(end),
                       [](std::uint32_t a, std::uint32_t b) { return a >> kJobBits < b >> kJobBits; });
  }
}

// Puts the tile's triangles about from near to far, where they hide so much that blocks may become opaque before most
// have come: by counting, in steps of the nearest depths that they reach. In which order they are before does not
// matter. False: they were left as they are.
inline bool TileWorker::orderByDepth(const Frame& frame) {
  if (frame.nearest.empty()) return false;
  // Of one layer of each job: a guess.
  float depth = 0.0F;
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    const std::uint32_t job = numbers_[i] >> kJobBits;
    if (i == 0 || job != numbers_[i - 1] >> kJobBits) depth += frame.opticalDepths[frame.jobs[job].draw];
  }
  tracksHidden_ = depth > frame.opaqueDepth() && (frame.isFlat() || order_.isWorth(depth));
  if (!tracksHidden_) return false;
  const std::size_t total = numbers_.size();
  nearest_.resize(total / kLanes + 1);
  float* const depths = nearest_.front().depth;
  for (std::size_t i = 0; i < total; ++i) depths[i] = frame.nearestOf(numbers_[i]);
  std::fill_n(depths + total, kLanes - total % kLanes, depths[0]);
  F least = load(depths);
  F most = least;
  for (const Nearest& each : nearest_) {
    least = min(least, load(each.depth));
    most = max(most, load(each.depth));
  }
  steps_ = DepthSteps(leastOf(least), mostOf(most), frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE);
  for (Nearest& each : nearest_) store(each.step, steps_.of(load(each.depth)));
  std::array<std::uint32_t, DepthSteps::kCount> place{};
  const std::int32_t* const steps = nearest_.front().step;
  for (std::size_t i = 0; i < total; ++i) ++place[static_cast<std::uint32_t>(steps[i])];
  std::exclusive_scan(place.begin(), place.end(), place.begin(), 0U);
  inOrder_.resize(total);
  for (std::size_t i = 0; i < total; ++i) inOrder_[place[static_cast<std::uint32_t>(steps[i])]++] = numbers_[i];
  numbers_.swap(inOrder_);
  return true;
}

// The same where triangles are few and large and pixels deep, as they were in the last tile: by the depths of their
// planes at the tile's middle. Rows then come nearly sorted, which sorting notices (areInOrder()). Elsewhere it would
// take triangles apart that are neighbours.
inline bool TileWorker::orderLarge(const Frame& frame) {
  constexpr std::size_t kDeep = std::size_t{16} * kBlocks;
  constexpr std::size_t kLarge = 16; // blocks of a triangle
  if (rowsBefore_ < std::max(kDeep, kLarge * trianglesBefore_)) return false;
  constexpr double kHalf = 0.5 * kTileSide;
  const double middleX = (tile_.x + kHalf) * kSubpixels;
  const double middleY = (tile_.y + kHalf) * kSubpixels;
  const double away = frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? -1.0 : 1.0;
  farther_.clear();
  for (const std::uint32_t number : numbers_) {
    const Job& job = frame.jobs[number >> kJobBits];
    const DrawInfo& info = frame.draws[job.draw];
    double depth = 0.0; // of what is clipped, and no triangle: first
    if (info.draw.topology == VITRAIL_CPU_TRIANGLES) {
      const std::uint64_t at = (std::uint64_t{job.first} + (number & (kJobTriangles - 1))) * 3;
      const Corner* const corners = frame.corners.data() + info.firstVertex;
      const Corner& a = corners[vertexOf(info.draw, at)];
      const Corner& b = corners[vertexOf(info.draw, at + 1)];
      const Corner& c = corners[vertexOf(info.draw, at + 2)];
      if (a.x != kNeedsClipping && b.x != kNeedsClipping && c.x != kNeedsClipping) {
        const double bx = b.x - a.x;
        const double by = b.y - a.y;
        const double cx = c.x - a.x;
        const double cy = c.y - a.y;
        const double area = bx * cy - by * cx;
        const double toB = (middleX - a.x) * cy - (middleY - a.y) * cx;
        const double toC = (middleY - a.y) * bx - (middleX - a.x) * by;
        const double rise = toB * (double{b.depth} - a.depth) + toC * (double{c.depth} - a.depth);
        depth = away * (area == 0.0 ? a.depth : a.depth + rise / area);
      }
    }
    farther_.emplace_back(static_cast<float>(depth), number);
  }
  std::sort(farther_.begin(), farther_.end());
  for (std::size_t i = 0; i < numbers_.size(); ++i) numbers_[i] = farther_[i].second;
  return true;
}

// Whether all of numbers_ from one on are behind what shows of some blocks.
inline bool TileWorker::areBehind(const Frame& frame, std::size_t first, std::uint64_t blocks) const {
  if (!tracksHidden_ || (blocks & ~saturated_) != 0) return false;
  I until = set(0);
  for (std::uint32_t b = 0; b < kBlocks; b += kLanes) {
    until = max(until, keep(maskOf(static_cast<std::uint32_t>(blocks >> b) & 0xffffU), load(allUntil_.data() + b)));
  }
  const F nearest = steps_.nearestFrom(set(frame.nearestOf(numbers_[first])));
  return mostOf(until) <= mostOf(keyOf(nearest, frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE));
}

// Corners of what is no triangle, or not there.
inline constexpr Corner kClippedCorner{kNeedsClipping, 0, 0.0F, 0.0F};
inline constexpr Corner kNoCorner{};

// What is set up with the last triangles of a batch are some that cover nothing.
HWY_INLINE void pad(Staged& staged) {
  for (std::uint32_t i = staged.count; i % kLanes != 0; ++i) {
    for (auto& corners : staged.corners) corners[i] = &kNoCorner;
    staged.number[i] = 0;
    staged.draw[i] = 0;
    staged.cull[i] = 0;
  }
}

// Finds the corners of up to kBatch triangles, so that they are in cache when they are set up.
HWY_INLINE void TileWorker::stage(const Frame& frame, std::size_t first, std::uint32_t count, bool isShaded,
                                  Staged& staged) {
  std::uint32_t jobNumber = ~0U;
  const VitrailCpuDraw* draw = nullptr;
  const Corner* corners = nullptr;
  std::uint32_t drawNumber = 0;
  std::uint32_t firstPrimitive = 0;
  staged.count = count;
  const bool isMixed = tracksHidden_; // jobs change all the time: no branch could foresee it
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t number = numbers_[first + i];
    if (isMixed || number >> kJobBits != jobNumber) {
      jobNumber = number >> kJobBits;
      const Job& job = frame.jobs[jobNumber];
      const DrawInfo& info = frame.draws[job.draw];
      draw = &info.draw;
      drawNumber = isShaded ? job.draw : colors_.numberOf(frame, job.draw);
      corners = frame.corners.data() + info.firstVertex;
      firstPrimitive = job.first;
    }
    staged.number[i] = static_cast<std::int32_t>(number);
    staged.draw[i] = static_cast<std::int32_t>(drawNumber);
    staged.cull[i] = draw->cull;
    if (HWY_UNLIKELY(draw->topology != VITRAIL_CPU_TRIANGLES)) {
      for (auto& each : staged.corners) each[i] = &kClippedCorner;
      continue;
    }
    const std::uint64_t at = std::uint64_t{firstPrimitive + (number & (kJobTriangles - 1))} * 3;
    for (std::uint64_t c = 0; c < 3; ++c) {
      const Corner* const corner = corners + vertexOf(*draw, at + c);
      staged.corners[c][i] = corner;
      hwy::Prefetch(corner);
    }
  }
  pad(staged);
}

// Draws what a primitive is rasterised as that is no triangle, or has to be clipped, once a batch of it is full. False:
// the store is full.
template <class Emit>
HWY_NOINLINE bool TileWorker::stagePieces(const Frame& frame, std::uint32_t number, bool isShaded, Emit emit) {
  const Job& job = frame.jobs[number >> kJobBits];
  const DrawInfo& info = frame.draws[job.draw];
  const Pieces pieces = piecesOf(frame, info, job.first + (number & (kJobTriangles - 1)));
  for (const Piece& piece : pieces.all()) {
    const std::uint32_t at = pieces_.count++;
    for (std::size_t i = 0; i < 3; ++i) {
      pieces_.place[i][at] = piece.corners[i];
      pieces_.corners[i][at] = &pieces_.place[i][at];
      pieces_.second[i][at] = piece.second[i];
      pieces_.third[i][at] = piece.third[i];
    }
    pieces_.number[at] = static_cast<std::int32_t>(number);
    pieces_.draw[at] = static_cast<std::int32_t>(isShaded ? job.draw : colors_.numberOf(frame, job.draw));
    pieces_.cull[at] = info.draw.cull;
    if (pieces_.count == kBatch && !drawPieces(frame, isShaded, emit)) return false;
  }
  return true;
}

template <class Emit>
inline bool TileWorker::drawPieces(const Frame& frame, bool isShaded, Emit emit) {
  if (pieces_.count == 0) return true;
  pad(pieces_);
  std::uint64_t clipped = 0;
  const bool isDone = drawBatch(frame, pieces_, &pieces_, isShaded, clipped, emit);
  pieces_.count = 0;
  return isDone;
}

// Calls emit(n) for each batch: it draws the first n entries of work_, or returns false. `isShaded`: asks for weights;
// else for the numbers of draws in colors_. False: the store is full.
template <class Emit>
inline bool TileWorker::rasterise(const Frame& frame, std::uint64_t blocks, bool isShaded, Emit emit) {
  for (std::uint32_t b = 0; b < kBlocks; ++b) {
    wanted_[b] = (blocks >> b & 1U) != 0 ? tile_.pixels[b] : std::uint16_t{0};
  }
  pieces_.count = 0;
  const std::size_t total = numbers_.size();
  const auto countAt = [total](std::size_t i) {
    return i < total ? static_cast<std::uint32_t>(std::min<std::size_t>(kBatch, total - i)) : 0U;
  };
  std::size_t turn = 0;
  stage(frame, 0, countAt(0), isShaded, staged_[turn]);
  shownTriangles_ = total;
  for (std::size_t i = 0; i < total; i += kBatch, turn ^= 1U) {
    if (shownTriangles_ == total && areBehind(frame, i, blocks)) shownTriangles_ = i;
    if (shownTriangles_ < total && !frame.counts) break;
    stage(frame, i + kBatch, countAt(i + kBatch), isShaded, staged_[turn ^ 1U]);
    std::uint64_t clipped = 0;
    if (!drawBatch(frame, staged_[turn], nullptr, isShaded, clipped, emit)) return false;
    for (; HWY_UNLIKELY(clipped != 0); clipped &= clipped - 1) {
      const std::size_t at = i + static_cast<std::size_t>(std::countr_zero(clipped));
      if (!stagePieces(frame, numbers_[at], isShaded, emit)) return false;
    }
  }
  return drawPieces(frame, isShaded, emit);
}

// Fragments that nothing shows of are counted all the same.
HWY_INLINE void TileWorker::countHidden(std::uint32_t block, std::uint32_t mask) {
  store(hidden_[block], load(hidden_[block]) + keep(maskOf(mask), set(1)));
}

// Lists in work_ which triangles cover what of which blocks, of the `items` pairs of both in pairs_. `kIsBig`: edges of
// some triangle need more than 16 bits. Triangles that are behind all that shows of a block are only counted there, or,
// where nobody asks for statistics, dropped. They are set aside first: a branch that nobody can foresee would cost as
// much as it spares.
template <bool kIsBig, TileWorker::Hidden kHidden>
HWY_INLINE std::uint32_t TileWorker::cover(std::uint32_t items) {
  std::uint32_t count = 0;
  std::uint32_t hidden = 0;
  for (std::uint32_t i = 0; i < items; ++i) {
    const std::uint32_t pair = pairs_[i];
    const std::uint32_t t = pair & 0xffU;
    const std::uint32_t block = pair >> 8U;
    const I position = load(kBlockLanes.position[block]);
    I outside;
    if constexpr (!kIsBig) {
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
    const std::uint32_t mask = ~signsOf(outside) & wanted_[block];
    const auto isThere = static_cast<std::uint32_t>(mask != 0);
    const Work work{pair | mask << 16U};
    work_[count] = work;
    if constexpr (kHidden != Hidden::None) {
      const auto isHidden = static_cast<std::uint32_t>(batchNearest_[t] >= allUntil_[block]);
      if constexpr (kHidden == Hidden::Counted) {
        hiddenWork_[hidden] = work;
        hidden += isThere & isHidden;
      }
      count += isThere & (isHidden ^ 1U);
    } else {
      count += isThere;
    }
  }
  for (std::uint32_t i = 0; i < hidden; ++i) countHidden(hiddenWork_[i].block(), hiddenWork_[i].pixels());
  return count;
}

HWY_INLINE std::uint32_t TileWorker::coverSamples(std::uint32_t items, std::uint32_t samples) {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < items; ++i) {
    const std::uint32_t pair = pairs_[i];
    const std::uint32_t t = pair & 0xffU;
    const std::uint32_t block = pair >> 8U;
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
      const std::uint32_t mask = ~signsOf(outside) & wanted_[block];
      sampleMasks_[s][count] = static_cast<std::uint16_t>(mask);
      any |= mask;
    }
    work_[count] = Work{pair | any << 16U};
    count += static_cast<std::uint32_t>(any != 0);
  }
  return count;
}

// The same for one batch. `pieces` is `staged` where it holds pieces. `clipped` takes the triangles that have to be
// clipped first, a bit each.
template <class Emit>
inline bool TileWorker::drawBatch(const Frame& frame, const Staged& staged, const StagedPieces* pieces, bool isShaded,
                                  std::uint64_t& clipped, Emit emit) {
  const std::uint32_t triangles = staged.count;
  const std::uint32_t samples = frame.info.samples;
  batch_.draw = staged.draw;
  batch_.pieces = pieces;
  batch_.isBig = false;
  for (std::uint32_t i = 0; i < triangles; i += kLanes) {
    clipped |= std::uint64_t{setUpSixteen(batch_, staged, i, tile_, samples, isShaded)} << i;
  }
  std::uint32_t items = 0;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    items += listBlocks(pairs_.data() + items, batch_.x0[t], batch_.x1[t], batch_.y0[t], batch_.y1[t], t);
  }
  std::uint32_t count = 0;
  if (samples > 1) {
    count = coverSamples(items, samples);
  } else if (saturated_ == 0 || hasDepth_) {
    count = batch_.isBig ? cover<true, Hidden::None>(items) : cover<false, Hidden::None>(items);
  } else {
    const bool nearestIsOne = frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
    for (std::uint32_t i = 0; i < triangles; i += kLanes) {
      store(batchNearest_.data() + i, nearestOf(batch_, i, nearestIsOne));
    }
    if (batch_.isBig) {
      count = cover<true, Hidden::Counted>(items);
    } else {
      count = frame.counts ? cover<false, Hidden::Counted>(items) : cover<false, Hidden::Dropped>(items);
    }
  }
  return emit(count);
}

// Weights at a pixel's centre that is not covered grow without bound towards the horizon: how they change has to be a
// number all the same.
constexpr float kFarthestWeight = 0x1.0p20F;

// Perspective-correct weights of what the host handed over, and how they change: second, third, and with derivatives
// second to the right and down, third to the right and down. `kPlain`: the triangle is not big, and no piece.
template <bool kPlain>
HWY_INLINE void TileWorker::perspective(const Work& work, bool derivatives, F* weights) const {
  const std::uint32_t t = work.triangle();
  F flatSecond;
  F flatThird;
  weightsAt<kPlain>(batch_, t, load(kBlockLanes.position[work.block()]), flatSecond, flatThird);
  const F slope1 = set(batch_.w[1][t]);
  const F slope2 = set(batch_.w[2][t]);
  const F least = set(batch_.leastW[t]);
  F sum = fma(flatThird, slope2, fma(flatSecond, slope1, set(batch_.w[0][t])));
  if (kPlain || shape_.coverage == 0) {
    sum = max(sum, least); // what is 0 at the farthest corner, but for rounding
  } else {                 // the centre may lie outside, beyond the horizon even
    sum = select(max(sum, set(0.0F) - sum) >= least, sum, least);
  }
  const F inverse = set(1.0F) / sum;
  const F w1 = set(batch_.w1[t]);
  const F w2 = set(batch_.w2[t]);
  weights[0] = flatSecond * w1 * inverse;
  weights[1] = flatThird * w2 * inverse;
  if (derivatives) {
    if (!kPlain && shape_.coverage != 0) {
      for (std::size_t i = 0; i < 2; ++i)
        weights[i] = max(min(weights[i], set(kFarthestWeight)), set(-kFarthestWeight));
    }
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
  if (kPlain || HWY_LIKELY(batch_.pieces == nullptr)) return;
  const StagedPieces& pieces = *batch_.pieces;
  const auto whole = [&](const float(&at)[3][kBatch], const F& second, const F& third, float base) HWY_ATTR {
    return fma(third, set(at[2][t] - at[0][t]), fma(second, set(at[1][t] - at[0][t]), set(base)));
  };
  const F second = weights[0];
  const F third = weights[1];
  weights[0] = whole(pieces.second, second, third, pieces.second[0][t]);
  weights[1] = whole(pieces.third, second, third, pieces.third[0][t]);
  if (!derivatives) return;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const F secondSlope = weights[2 + axis];
    const F thirdSlope = weights[4 + axis];
    weights[2 + axis] = whole(pieces.second, secondSlope, thirdSlope, 0.0F);
    weights[4 + axis] = whole(pieces.third, secondSlope, thirdSlope, 0.0F);
  }
}

// The pixels in which something of a triangle is not behind an opaque surface. With several samples, sampleMasks_ keeps
// those that are not; `keys` takes the depths of each sample, or of the pixel.
HWY_INLINE std::uint32_t TileWorker::testDepth(const Frame& frame, const Work& work, std::uint32_t item, const F& depth,
                                               I* keys) {
  const bool nearestIsOne = frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
  const std::uint32_t samples = frame.info.samples;
  if (samples == 1) {
    keys[0] = keyOfInner(depth, nearestIsOne);
    return work.pixels() & ~bitsOf(keys[0] > load(opaque_->depth[0].value[work.block()]));
  }
  std::uint32_t any = 0;
  const std::uint32_t t = work.triangle();
  const bool isCareful = batch_.careful[t] != 0;
  for (std::uint32_t s = 0; s < samples; ++s) {
    F own = depth + set(batch_.sampleDepth[s][t]);
    if (HWY_UNLIKELY(isCareful)) {
      own = carefulDepthAt(batch_, t, load(kBlockLanes.position[work.block()]), samplePlaces(samples)[s]);
    }
    keys[s] = keyOfInner(own, nearestIsOne);
    std::uint16_t& mask = sampleMasks_[s][item];
    mask = static_cast<std::uint16_t>(mask & ~bitsOf(keys[s] > load(opaque_->depth[s].value[work.block()])));
    any |= mask;
  }
  return any;
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
