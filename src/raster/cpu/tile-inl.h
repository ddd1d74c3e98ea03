// A tile: its triangles are rasterised block by block, opaque ones first, transparent fragments stored in rows, and
// each block's rows sorted and blended.
#if defined(VITRAIL_TILE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_TILE_INL_H
#undef VITRAIL_TILE_INL_H
#else
#define VITRAIL_TILE_INL_H
#endif

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include <hwy/cache_control.h>

#include "raster/cpu/batch-inl.h"
#include "raster/cpu/picture.h"
#include "raster/cpu/resolve-inl.h"
#include "raster/cpu/shade-inl.h"
#include "raster/cpu/store-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

constexpr std::uint32_t kBlocksAcross = kTileSide / kBlockSide;

// The pixels of each block, in the tile: x below, y in the upper 16 bits.
struct BlockLanes {
  alignas(64) std::int32_t position[kBlocks][kLanes];
  constexpr BlockLanes() : position() {
    for (std::uint32_t b = 0; b < kBlocks; ++b) {
      for (std::uint32_t l = 0; l < kLanes; ++l) {
        const std::uint32_t x = b % kBlocksAcross * kBlockSide + l % kBlockSide;
        const std::uint32_t y = b / kBlocksAcross * kBlockSide + l / kBlockSide;
        position[b][l] = static_cast<std::int32_t>(x | y << 16U);
      }
    }
  }
};
inline constexpr BlockLanes kBlockLanes;

// Where the pairs of a row's lanes are, in units of 16 bytes from its first.
struct PairPlaces {
  alignas(64) std::int32_t place[kLanes];
  constexpr PairPlaces() : place() {
    for (std::size_t l = 0; l < kLanes; ++l) place[l] = static_cast<std::int32_t>(placeOfFour(l));
  }
};
inline constexpr PairPlaces kPairPlaces;

// A triangle and a block in which it covers something, and what.
struct Work {
  std::uint8_t triangle; // of the batch
  std::uint8_t block;
  std::uint16_t pixels; // in which some sample is covered
};

// Writes the numbers (x + 8 y) of the blocks in a rectangle, and beside each the same tag; up to 7 bytes too many.
HWY_INLINE std::uint32_t listBlocks(std::uint8_t* ids, std::uint8_t* tags, std::int32_t x0, std::int32_t x1,
                                    std::int32_t y0, std::int32_t y1, std::uint8_t tag) {
  constexpr std::uint64_t kOnes = 0x0101010101010101U;
  std::uint64_t row = 0x0706050403020100U + static_cast<std::uint64_t>(x0 + 8 * y0) * kOnes;
  const std::uint64_t same = tag * kOnes;
  const auto width = static_cast<std::uint32_t>(x1 - x0 + 1);
  std::uint32_t count = 0;
  for (std::int32_t y = y0; y <= y1; ++y, row += 8 * kOnes, count += width) {
    std::memcpy(ids + count, &row, sizeof(row));
    std::memcpy(tags + count, &same, sizeof(same));
  }
  return count;
}

// Opaque surfaces of a tile: of each sample of each pixel the nearest.
struct OpaqueTile {
  explicit OpaqueTile(std::uint32_t samples) : depth(samples), shown(samples), color(samples) {}
  struct Plane {
    alignas(64) std::int32_t value[kBlocks][kLanes];
  };
  struct Surface { // whose number is 0 where there is none, else the triangle's plus 1 with kFrontBit
    alignas(64) std::int32_t number[kBlocks][kLanes];
    alignas(64) float weights[6][kBlocks][kLanes];    // second, third, their derivatives
    alignas(64) std::int32_t centre[kBlocks][kLanes]; // depth key at the pixel's centre
  };
  struct Color {
    alignas(64) float value[4][kBlocks][kLanes];
  };
  std::vector<Plane> depth; // keys
  std::vector<Surface> shown;
  std::vector<Color> color;
  std::uint64_t drawn = 0; // blocks in which something is shown
};

class TileWorker final : public TileWorkspace {
 public:
  explicit TileWorker(const Frame& frame)
      : shape_(frame.needs, frame.info.samples > 1, frame.draws.size()), store_(shape_, frame.budget) {
    if (frame.needs.opaque) opaque_ = std::make_unique<OpaqueTile>(frame.info.samples);
  }

  void draw(const Frame& frame, std::uint32_t tile, TileCounts& counts);
  std::uint64_t fragmentBytes() const override { return store_.peakBytes(); }

 private:
  // Which part of a block's fragments a pass takes: those beyond `after` and before `until`, as keys. Fragments from
  // `until` on are left to a later pass.
  struct Window {
    alignas(64) std::int32_t after[kLanes];
    alignas(64) std::int32_t until[kLanes];
    bool isCut = false;     // some were left
    bool isCounted = false; // fragments are only counted: nothing shows behind what was blended
  };

  struct State { // of a block: what its samples come to
    Blended samples[kMaxSamples];
    bool isUniform = true; // all of them the same: only the first is there

    State() { samples[0].clear(); }
    void separate(std::uint32_t count) {
      if (!isUniform) return;
      for (std::uint32_t s = 1; s < count; ++s) samples[s] = samples[0];
      isUniform = false;
    }
    const Blended& of(std::uint32_t sample) const { return samples[isUniform ? 0 : sample]; }
  };

  void merge(const Frame& frame, std::uint32_t tile, bool opaque);
  template <class Emit>
  bool rasterise(const Frame& frame, std::uint64_t blocks, Emit emit);
  template <class Emit>
  bool flush(const Frame& frame, std::uint64_t blocks, Emit emit);
  struct Fetched {
    const VitrailCpuDraw* draw;
    std::array<const Corner*, 3> corners; // the first is null where it is no triangle
  };
  void fetch(const Frame& frame, std::size_t first, std::uint32_t count, Fetched* fetched) const;
  void add(std::uint32_t number, const VitrailCpuDraw& draw, const Corner& a, const Corner& b, const Corner& c);
  template <class Emit>
  bool stage(const Frame& frame, std::uint32_t number, const Fetched& f, std::uint64_t blocks, Emit emit);
  template <class Emit>
  bool stagePieces(const Frame& frame, std::uint32_t number, std::uint64_t blocks, Emit emit);
  HWY_INLINE std::uint32_t cover(std::uint64_t blocks, std::uint32_t items);
  HWY_INLINE std::uint32_t coverSamples(std::uint64_t blocks, std::uint32_t items, std::uint32_t samples);

  HWY_INLINE void perspective(std::uint32_t t, const F& flatSecond, const F& flatThird, bool derivatives,
                              F* weights) const;
  enum class Emitted { IsStored, IsCrowded, IsFull };
  template <bool kShaded>
  Emitted emitTransparent(const Frame& frame, std::uint32_t item, Window* window);
  template <bool kShaded>
  bool emit(const Frame& frame, std::uint32_t item, Window* window);
  HWY_INLINE void emitOpaque(const Frame& frame, std::uint32_t item);
  HWY_INLINE std::uint32_t testDepth(const Frame& frame, const Work& work, std::uint32_t item, const F& depth, I* keys);

  void drawOpaque(const Frame& frame, std::uint32_t tile);
  void shadeOpaque(const Frame& frame, std::uint32_t block);
  void drawParts(const Frame& frame, std::uint64_t blocks, TileCounts& counts);
  void drawInWindows(const Frame& frame, std::uint32_t block, TileCounts& counts);
  void shrink(Window& window, std::uint32_t block);
  void thin(const Frame& frame, std::uint32_t block);
  bool mayHide(const Frame& frame) const;
  void shadeBlock(const Frame& frame, std::uint32_t block);
  I saturationOf(const Frame& frame, const SortedRows& sorted) const;
  void resolveBlock(const Frame& frame, std::uint32_t block, TileCounts& counts);
  SortedRows sortBlock(const Frame& frame, std::uint32_t block);
  static void count(const std::int32_t* layers, TileCounts& counts);
  static bool isHidden(const Frame& frame, const State& state);
  void blendInto(const Frame& frame, std::uint32_t block, const SortedRows& sorted, State& state);
  void coveragesOf(const SortedRows& sorted, std::uint32_t* coverages) const;
  Row rowOf(const SortedRows& sorted, std::size_t r, std::size_t lane) const;
  void behind(const Frame& frame, std::uint32_t block, std::uint32_t sample, F* color);
  float* pixelsOf(const Frame& frame, std::uint32_t block, std::size_t& stride) const;
  void write(const Frame& frame, std::uint32_t block, const F* color);
  void blendedOver(const Frame& frame, std::uint32_t block, const State* state, F* sum);
  void finishBlock(const Frame& frame, std::uint32_t block, const State* state);
  void listBlock(const Frame& frame, std::uint32_t block, const SortedRows& sorted);
  void layersOf(const Frame& frame, const SortedRows& sorted, std::uint32_t lane);

  RowShape shape_;
  Store store_;
  Batch batch_{};
  TileBox tile_{};
  std::vector<std::uint32_t> numbers_;
  std::array<std::array<Fetched, kBatch>, 2> fetched_{};
  std::unique_ptr<OpaqueTile> opaque_;
  bool hasDepth_ = false; // opaque surfaces may hide fragments of this tile
  std::array<std::uint8_t, kBatch * kBlocks + 64> ids_{};
  std::array<std::uint8_t, kBatch * kBlocks + 64> tags_{};
  std::array<Work, kBatch * kBlocks + 64> work_{};
  std::array<std::array<std::uint16_t, kBatch * kBlocks + 64>, kMaxSamples> sampleMasks_{};
  // Blocks in which what is far away is known to be hidden: from which depth on, and how many fragments were left out.
  std::uint64_t saturated_ = 0;
  std::uint64_t edges_ = 0; // blocks in which a fragment does not cover all samples of its pixel
  alignas(64) std::int32_t until_[kBlocks][kLanes];
  alignas(64) std::int32_t hidden_[kBlocks][kLanes];
  alignas(64) std::int32_t layers_[kLanes]; // fragments of each pixel of the block that was sorted last
  std::vector<Row> rows_;
  std::vector<double> keyMemory_;
  std::vector<std::uint32_t> coverageMemory_;
  std::vector<VitrailLayer> list_;
  PixelBlock pixels_;
  PixelBlock behind_;
  alignas(64) VitrailCpuFragments fragments_{};
};

// ---- Triangles to blocks

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

// Memory that is aligned as vectors are, of one that has 64 bytes to spare.
template <class T>
T* aligned(T* p) {
  const std::uintptr_t past = reinterpret_cast<std::uintptr_t>(p) % 64;
  return reinterpret_cast<T*>(reinterpret_cast<char*>(p) + (past == 0 ? 0 : 64 - past));
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

HWY_INLINE std::uint32_t TileWorker::cover(std::uint64_t blocks, std::uint32_t items) {
  std::uint32_t count = 0;
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
    work_[count] = {static_cast<std::uint8_t>(t), static_cast<std::uint8_t>(block), static_cast<std::uint16_t>(mask)};
    count += static_cast<std::uint32_t>(mask != 0) & static_cast<std::uint32_t>(blocks >> block & 1U);
  }
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
  const std::uint32_t count = samples == 1 ? cover(blocks, items) : coverSamples(blocks, items, samples);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!emit(i)) return false;
  }
  return true;
}

// ---- A triangle in a block

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

// Stores the fragments of a triangle in a block.
template <bool kShaded>
HWY_INLINE TileWorker::Emitted TileWorker::emitTransparent(const Frame& frame, std::uint32_t item, Window* window) {
  const Work work = work_[item];
  const std::uint32_t t = work.triangle;
  const std::uint32_t block = work.block;
  F second;
  F third;
  weightsAt(batch_, t, load(kBlockLanes.position[block]), second, third);
  const F depth = fma(third, set(batch_.z[2][t]), fma(second, set(batch_.z[1][t]), set(batch_.z[0][t])));
  std::uint32_t mask = work.pixels;
  I keys[kMaxSamples];
  if (hasDepth_) mask = testDepth(frame, work, item, depth, keys);
  const I key = keyOf(depth, frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE);
  if (window != nullptr) {
    const std::uint32_t later = mask & ~bitsOf(load(window->until) > key);
    window->isCut = window->isCut || later != 0;
    mask &= ~later & bitsOf(key > load(window->after));
    if (window->isCounted) {
      store(layers_, load(layers_) + keep(maskOf(mask), set(1)));
      return Emitted::IsStored;
    }
  }
  if (HWY_UNLIKELY((saturated_ >> block & 1U) != 0)) {
    const M hidden = andNot(load(until_[block]) > key, maskOf(mask));
    store(hidden_[block], load(hidden_[block]) + keep(hidden, set(1)));
    mask &= ~bitsOf(hidden);
  }
  if (mask == 0) return Emitted::IsStored;
  std::uint32_t isFresh = 0;
  const Row row = store_.rowFor(block, mask, isFresh);
  if (HWY_UNLIKELY(row == nullptr)) {
    return store_.isCrowded(block) ? Emitted::IsCrowded : Emitted::IsFull;
  }
  const M here = maskOf(mask);
  const M fresh = maskOf(0U - isFresh); // without a branch: nobody could tell which it takes
  const auto put = [&](std::uint32_t vector, const I& value, const I& elsewhere) HWY_ATTR {
    std::int32_t* to = row + kLanes * vector;
    store(to, select(here, value, select(fresh, elsewhere, load(to))));
  };
  put(RowShape::kKey, key, set(kFarKey));
  if constexpr (!kShaded) {
    const std::uint32_t number = static_cast<std::uint32_t>(batch_.number[t]) & ~kFrontBit;
    put(RowShape::kNumber, set(static_cast<std::int32_t>(frame.jobs[number >> kJobBits].draw)), set(shape_.nothing));
  } else {
    F weights[6];
    perspective(t, second, third, frame.needs.derivatives, weights);
    const I number = set(batch_.number[t]);
    put(RowShape::kNumber, number, number); // where nothing is, there is still the number of one that exists
    const std::uint32_t count = frame.needs.derivatives ? 6 : 2;
    for (std::uint32_t i = 0; i < count; ++i) put(RowShape::kSecond + i, bitsOf(weights[i]), bitsOf(weights[i]));
  }
  if (kShaded && shape_.coverage != 0) {
    I covered = set(0);
    std::uint32_t isEdge = 0;
    for (std::uint32_t s = 0; s < frame.info.samples; ++s) {
      covered = covered | keep(maskOf(sampleMasks_[s][item]), set(static_cast<std::int32_t>(1U << s)));
      isEdge |= mask & ~static_cast<std::uint32_t>(sampleMasks_[s][item]);
    }
    edges_ |= static_cast<std::uint64_t>(isEdge != 0) << block;
    put(shape_.coverage, covered, set(0));
  }
  return Emitted::IsStored;
}

// The same, and makes room where hidden fragments take it. False: the store is full.
template <bool kShaded>
HWY_INLINE bool TileWorker::emit(const Frame& frame, std::uint32_t item, Window* window) {
  Emitted emitted = emitTransparent<kShaded>(frame, item, window);
  if (HWY_UNLIKELY(emitted == Emitted::IsCrowded)) {
    thin(frame, work_[item].block);
    emitted = emitTransparent<kShaded>(frame, item, window);
  }
  return emitted == Emitted::IsStored;
}

// ---- Opaque surfaces

HWY_INLINE void TileWorker::emitOpaque(const Frame& frame, std::uint32_t item) {
  const Work work = work_[item];
  const std::uint32_t t = work.triangle;
  const std::uint32_t block = work.block;
  F second;
  F third;
  weightsAt(batch_, t, load(kBlockLanes.position[block]), second, third);
  const F depth = fma(third, set(batch_.z[2][t]), fma(second, set(batch_.z[1][t]), set(batch_.z[0][t])));
  I keys[kMaxSamples];
  std::uint32_t mask = testDepth(frame, work, item, depth, keys);
  if (mask == 0) return;
  F weights[6];
  perspective(t, second, third, frame.needs.opaqueDerivatives, weights);
  const I centre = keyOf(depth, frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE);
  const std::uint32_t number = static_cast<std::uint32_t>(batch_.number[t]) & ~kFrontBit;
  const VitrailCpuDraw& draw = frame.draws[frame.jobs[number >> kJobBits].draw].draw;
  if ((draw.shadeFlags & VITRAIL_CPU_SHADE_DISCARD) != 0) {
    ToShade s;
    s.x = frame.info.originX + static_cast<std::uint32_t>(tile_.x) + block % kBlocksAcross * kBlockSide;
    s.y = frame.info.originY + static_cast<std::uint32_t>(tile_.y) + block / kBlocksAcross * kBlockSide;
    s.numbers = set(batch_.number[t]);
    s.present = maskOf(mask);
    s.depth = depthOf(centre, frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE);
    s.second = weights[0];
    s.third = weights[1];
    for (std::size_t i = 0; i < 4; ++i) s.derivatives[i] = weights[2 + i];
    shadeAll(frame, s, frame.needs.opaqueDerivatives, fragments_,
             [&](const VitrailCpuDraw& /*draw*/, const VitrailCpuFragments& f, std::uint32_t /*mask*/) {
               mask &= ~f.discarded;
             });
    if (mask == 0) return;
  }
  opaque_->drawn |= std::uint64_t{1} << block;
  for (std::uint32_t s = 0; s < frame.info.samples; ++s) {
    const std::uint32_t covered = frame.info.samples == 1 ? mask : mask & sampleMasks_[s][item];
    if (covered == 0) continue;
    const M here = maskOf(covered);
    OpaqueTile::Surface& shown = opaque_->shown[s];
    std::int32_t* nearest = opaque_->depth[s].value[block];
    store(nearest, select(here, keys[s], load(nearest)));
    store(shown.centre[block], select(here, centre, load(shown.centre[block])));
    // The number plus 1, so that 0 is none; what is added to the front bit's number cannot carry into it.
    store(shown.number[block], select(here, set(batch_.number[t]) + set(1), load(shown.number[block])));
    const std::uint32_t count = frame.needs.opaqueDerivatives ? 6 : 2;
    for (std::uint32_t i = 0; i < count; ++i) {
      store(shown.weights[i][block], select(here, weights[i], load(shown.weights[i][block])));
    }
  }
}

// Shades what is seen of opaque surfaces, each once in a pixel.
inline void TileWorker::shadeOpaque(const Frame& frame, std::uint32_t block) {
  const std::uint32_t samples = frame.info.samples;
  std::array<std::uint32_t, kMaxSamples> left{}; // pixels whose sample is still to be shaded
  for (std::uint32_t s = 0; s < samples; ++s) {
    left[s] = ~bitsOf(load(opaque_->shown[s].number[block]) == set(0)) & 0xffffU;
  }
  for (std::uint32_t s = 0; s < samples; ++s) {
    if (left[s] == 0) continue;
    const OpaqueTile::Surface& shown = opaque_->shown[s];
    const I number = load(shown.number[block]);
    ToShade job;
    job.x = frame.info.originX + static_cast<std::uint32_t>(tile_.x) + block % kBlocksAcross * kBlockSide;
    job.y = frame.info.originY + static_cast<std::uint32_t>(tile_.y) + block / kBlocksAcross * kBlockSide;
    job.present = maskOf(left[s]);
    // Where there is none, any number that exists.
    const auto lane = static_cast<std::uint32_t>(__builtin_ctz(left[s]));
    job.numbers = select(job.present, number - set(1), set(shown.number[block][lane] - 1));
    job.depth = depthOf(load(shown.centre[block]), frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE);
    job.second = load(shown.weights[0][block]);
    job.third = load(shown.weights[1][block]);
    for (std::size_t i = 0; i < 4; ++i) job.derivatives[i] = load(shown.weights[2 + i][block]);
    const std::uint32_t shading = left[s];
    shadeAll(frame, job, frame.needs.opaqueDerivatives, fragments_,
             [&](const VitrailCpuDraw& /*draw*/, const VitrailCpuFragments& f, std::uint32_t mask) HWY_ATTR {
               F color[4];
               for (std::size_t c = 0; c < 3; ++c) color[c] = clamped(load(f.color[c]), kLargestColor);
               color[3] = set(1.0F);
               for (std::uint32_t other = s; other < samples; ++other) {
                 const std::uint32_t same =
                     bitsOf(load(opaque_->shown[other].number[block]) == number) & mask & left[other];
                 for (std::size_t c = 0; c < 4; ++c) {
                   float* to = opaque_->color[other].value[c][block];
                   store(to, select(maskOf(same), color[c], load(to)));
                 }
                 left[other] &= ~same;
               }
             });
    left[s] &= ~shading;
  }
}

inline void TileWorker::drawOpaque(const Frame& frame, std::uint32_t tile) {
  if (opaque_ == nullptr) return;
  merge(frame, tile, true);
  hasDepth_ = !numbers_.empty() || frame.info.depth != nullptr;
  opaque_->drawn = 0;
  if (!hasDepth_) return;
  const std::uint32_t samples = frame.info.samples;
  for (std::uint32_t s = 0; s < samples; ++s) {
    std::memset(&opaque_->shown[s], 0, sizeof(OpaqueTile::Surface));
    for (auto& block : opaque_->depth[s].value) std::fill(std::begin(block), std::end(block), kFarKey);
  }
  const bool nearestIsOne = frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
  alignas(64) float depths[kLanes];
  for (std::uint32_t s = 0; frame.info.depth != nullptr && s < samples; ++s) {
    for (std::uint32_t block = 0; block < kBlocks; ++block) {
      readDepths(frame, tile_, block, s, depths);
      store(opaque_->depth[s].value[block], keyOf(load(depths), nearestIsOne));
    }
  }
  if (numbers_.empty()) return;
  rasterise(frame, ~std::uint64_t{0}, [&](std::uint32_t item) HWY_ATTR {
    emitOpaque(frame, item);
    return true;
  });
  for (std::uint64_t left = opaque_->drawn; left != 0; left &= left - 1) {
    const auto block = static_cast<std::uint32_t>(__builtin_ctzll(left));
    for (std::uint32_t s = 0; s < samples; ++s) {
      if (s == 0 || frame.info.sampleColors != nullptr) readPixels(frame, tile_, block, s, pixels_);
      for (std::size_t c = 0; c < 4; ++c) {
        store(opaque_->color[s].value[c][block], load(pixels_.color[c]));
      }
    }
    shadeOpaque(frame, block);
    for (std::uint32_t s = 0; frame.info.depth != nullptr && s < samples; ++s) {
      const I keys = load(opaque_->depth[s].value[block]);
      store(depths, depthOf(keys, nearestIsOne));
      const std::uint32_t written = ~bitsOf(load(opaque_->shown[s].number[block]) == set(0)) & 0xffffU;
      writeDepths(frame, tile_, block, s, depths, written);
    }
  }
}

// ---- Transparent surfaces

inline void TileWorker::drawParts(const Frame& frame, std::uint64_t blocks, TileCounts& counts) {
  store_.reset();
  saturated_ = 0;
  edges_ = 0;
  const bool hasFitted =
      frame.needs.shaded
          ? rasterise(frame, blocks, [&](std::uint32_t i) HWY_ATTR { return emit<true>(frame, i, nullptr); })
          : rasterise(frame, blocks, [&](std::uint32_t i) HWY_ATTR { return emit<false>(frame, i, nullptr); });
  if (hasFitted) {
    for (std::uint64_t left = blocks; left != 0; left &= left - 1) {
      const auto block = static_cast<std::uint32_t>(__builtin_ctzll(left));
      if (store_.rows(block) == 0) {
        const bool isDrawn = opaque_ != nullptr && (opaque_->drawn >> block & 1U) != 0;
        if (isDrawn || frame.info.sampleColors != nullptr) finishBlock(frame, block, nullptr);
        continue;
      }
      resolveBlock(frame, block, counts);
    }
    return;
  }
  if ((blocks & (blocks - 1)) == 0)
    return drawInWindows(frame, static_cast<std::uint32_t>(__builtin_ctzll(blocks)), counts);
  // In two halves of as many blocks.
  std::uint64_t half = 0;
  std::uint64_t left = blocks;
  for (int i = __builtin_popcountll(blocks) / 2; i > 0; --i) {
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
  if (most == rows_.size()) return store_.grow(); // at one depth are more than fit: they are held at once

  const std::size_t stride = shape_.vectors * kLanes;
  std::vector<std::int32_t> copy(most * stride);
  for (std::size_t r = 0; r < most; ++r) { // what is not filled in below is not there, but names what exists
    std::memcpy(copy.data() + r * stride, rows_[r], shape_.bytes());
    std::fill_n(copy.data() + r * stride, kLanes, kFarKey);
    if (shape_.isFlat) std::fill_n(copy.data() + r * stride + kLanes * RowShape::kNumber, kLanes, shape_.nothing);
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

// A block whose fragments do not fit: the nearest ones are blended, then those behind them, and so on.
inline void TileWorker::drawInWindows(const Frame& frame, std::uint32_t block, TileCounts& counts) {
  State state;
  Window window;
  std::fill(std::begin(window.after), std::end(window.after), 0);
  std::array<std::int32_t, kLanes> layers{};
  do {
    window.isCut = false;
    std::fill(std::begin(window.until), std::end(window.until), kFarKey);
    store_.reset();
    store_.setLimit(block, Store::kNoLimit);
    saturated_ = 0;
    store(layers_, set(0));
    rasterise(frame, std::uint64_t{1} << block, [&](std::uint32_t item) HWY_ATTR {
      while (!(frame.needs.shaded ? emit<true>(frame, item, &window) : emit<false>(frame, item, &window))) {
        if (frame.info.list != nullptr) {
          store_.grow(); // the hook takes whole lists
        } else {
          shrink(window, block);
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

// ---- A block's rows to pixels

inline void TileWorker::count(const std::int32_t* layers, TileCounts& counts) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const auto here = static_cast<std::uint32_t>(layers[lane]);
    counts.fragments += here;
    counts.pixels += static_cast<std::uint64_t>(here > 0);
    counts.layersMax = std::max(counts.layersMax, here);
  }
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

// Collects a block's rows, and shades those that are not.
inline void TileWorker::shadeBlock(const Frame& frame, std::uint32_t block) {
  store_.collect(block, rows_);
  if (!frame.needs.shaded) return;
  const std::uint32_t x = frame.info.originX + static_cast<std::uint32_t>(tile_.x) + block % kBlocksAcross * kBlockSide;
  const std::uint32_t y = frame.info.originY + static_cast<std::uint32_t>(tile_.y) + block / kBlocksAcross * kBlockSide;
  for (std::size_t r = store_.shadedRows(block); r < rows_.size(); ++r) shadeRow(frame, rows_[r], x, y, fragments_);
  store_.setShaded(block);
}

inline SortedRows TileWorker::sortBlock(const Frame& frame, std::uint32_t block) {
  shadeBlock(frame, block);
  SortedRows sorted;
  sorted.rows = sortedRows(rows_.size());
  if (keyMemory_.size() < sorted.rows * kLanes + kLanes) keyMemory_.resize(2 * sorted.rows * kLanes + kLanes);
  sorted.keys = aligned(keyMemory_.data());
  const I places = load(kPairPlaces.place);
  I layers = (saturated_ >> block & 1U) != 0 ? load(hidden_[block]) : set(0);
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
    layers = layers + keep(set(kFarKey) > depths, set(1));
    Key keys[kKeyVectors];
    keysOf(depths, place, keys);
    for (std::size_t v = 0; v < kKeyVectors; ++v) hn::Store(keys[v], kD, sorted.keys + r * kLanes + v * kKeyLanes);
  }
  store(layers_, layers);
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
    sorted.pairs = frame.flatPairs.front().data();
    sorted.filters = frame.needs.filters ? frame.flatFilters.front().data() : nullptr;
  }
  sortKeys(sorted.keys, sorted.rows);
  sorted.rows = rows_.size(); // those that were added are last
  if (HWY_UNLIKELY(hasTies(sorted.keys, sorted.rows))) orderTies(sorted, frame.needs.filters);
  return sorted;
}

inline void TileWorker::blendInto(const Frame& frame, std::uint32_t block, const SortedRows& sorted, State& state) {
  const float least = frame.leastTransmittance;
  if (state.isUniform && (edges_ >> block & 1U) == 0) {
    if (frame.needs.filters) {
      blendRows<true>(sorted, least, state.samples[0]);
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

// The row of a sorted fragment. Of flat ones, whose place is that of their draw's pair, nobody asks: with several
// samples or a hook everything is shaded (frame_rules.cpp).
inline Row TileWorker::rowOf(const SortedRows& sorted, std::size_t r, std::size_t lane) const {
  const std::size_t first = sorted.placeOf(r, lane) - placeOfFour(lane); // of the row's pairs, in units of four
  return store_.arena() + first * 4 - kLanes * RowShape::kPairs;
}

inline void TileWorker::resolveBlock(const Frame& frame, std::uint32_t block, TileCounts& counts) {
  const SortedRows sorted = sortBlock(frame, block);
  count(layers_, counts);
  if (frame.info.list != nullptr) return listBlock(frame, block, sorted);
  State state;
  blendInto(frame, block, sorted, state);
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

// What is behind the transparent fragments of a block, in each sample.
inline void TileWorker::behind(const Frame& frame, std::uint32_t block, std::uint32_t sample, F* color) {
  if (opaque_ != nullptr && (opaque_->drawn >> block & 1U) != 0) {
    for (std::size_t c = 0; c < 4; ++c) color[c] = load(opaque_->color[sample].value[c][block]);
    return;
  }
  std::size_t stride = 0;
  if (const float* first = pixelsOf(frame, block, stride)) {
    loadFours([&](std::size_t lane) HWY_ATTR { return first + lane / kBlockSide * stride + lane % kBlockSide * 4; },
              color[0], color[1], color[2], color[3]);
    return;
  }
  if (sample == 0 || frame.info.sampleColors != nullptr) readPixels(frame, tile_, block, sample, behind_);
  for (std::size_t c = 0; c < 4; ++c) color[c] = load(behind_.color[c]);
}

// Writes the picture's pixels: r, g, b, alpha.
inline void TileWorker::write(const Frame& frame, std::uint32_t block, const F* color) {
  std::size_t stride = 0;
  float* const first = pixelsOf(frame, block, stride);
  if (first == nullptr) {
    for (std::size_t c = 0; c < 4; ++c) store(pixels_.color[c], color[c]);
    writePixels(frame, tile_, block, pixels_);
    return;
  }
  alignas(64) float fours[4 * kLanes];
  storeFours(fours, color[0], color[1], color[2], color[3]);
  const hn::FixedTag<float, 4> four;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    hn::StoreU(hn::Load(four, fours + 4 * placeOfFour(lane)), four,
               first + lane / kBlockSide * stride + lane % kBlockSide * 4);
  }
}

// The mean of the samples, each over what is behind it.
inline void TileWorker::blendedOver(const Frame& frame, std::uint32_t block, const State* state, F* sum) {
  const std::uint32_t samples = frame.info.samples;
  for (std::uint32_t s = 0; s < samples; ++s) {
    F color[4];
    behind(frame, block, s, color);
    if (state != nullptr) {
      if (frame.needs.filters) {
        over<true>(state->of(s), frame.leastTransmittance, color);
      } else {
        over<false>(state->of(s), frame.leastTransmittance, color);
      }
    }
    for (std::size_t c = 0; c < 4; ++c) sum[c] = s == 0 ? color[c] : sum[c] + color[c];
  }
  if (samples == 1) return;
  for (std::size_t c = 0; c < 4; ++c) sum[c] = sum[c] * set(1.0F / static_cast<float>(samples));
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
    const std::uint32_t x =
        static_cast<std::uint32_t>(tile_.x) + block % kBlocksAcross * kBlockSide + lane % kBlockSide;
    const std::uint32_t y =
        static_cast<std::uint32_t>(tile_.y) + block / kBlocksAcross * kBlockSide + lane / kBlockSide;
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
    for (std::size_t c = 0; c < 4; ++c) {
      float sum = 0.0F;
      for (std::uint32_t s = 0; s < samples; ++s) sum += color[4 * s + c];
      result[c][lane] = sum / static_cast<float>(samples);
    }
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
    const auto number = static_cast<std::uint32_t>(row[kLanes * RowShape::kNumber + lane]) & ~kFrontBit;
    const VitrailCpuDraw& draw = frame.draws[frame.jobs[number >> kJobBits].draw].draw;
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

inline void TileWorker::draw(const Frame& frame, std::uint32_t tile, TileCounts& counts) {
  tile_.x = static_cast<std::int32_t>(tile % frame.tilesX * kTileSide);
  tile_.y = static_cast<std::int32_t>(tile / frame.tilesX * kTileSide);
  tile_.lastX = std::min<std::int32_t>(kTileSide, static_cast<std::int32_t>(frame.info.width) - tile_.x) - 1;
  tile_.lastY = std::min<std::int32_t>(kTileSide, static_cast<std::int32_t>(frame.info.height) - tile_.y) - 1;
  std::uint64_t blocks = 0;
  for (std::uint32_t b = 0; b < kBlocks; ++b) {
    // Columns and rows of the block that lie within the frame.
    const std::int32_t columns = tile_.lastX + 1 - static_cast<std::int32_t>(b % kBlocksAcross * kBlockSide);
    const std::int32_t rows = tile_.lastY + 1 - static_cast<std::int32_t>(b / kBlocksAcross * kBlockSide);
    const std::uint32_t row = columns <= 0 ? 0 : 0xfU >> std::max(4 - columns, 0);
    const std::uint32_t all = rows <= 0 ? 0 : 0xffffU >> 4 * std::max(4 - rows, 0);
    tile_.pixels[b] = static_cast<std::uint16_t>(row * 0x1111U & all);
    if (tile_.pixels[b] != 0) blocks |= std::uint64_t{1} << b;
  }
  drawOpaque(frame, tile);
  merge(frame, tile, false);
  if (!numbers_.empty() || (opaque_ != nullptr && opaque_->drawn != 0) || frame.info.sampleColors != nullptr) {
    drawParts(frame, blocks, counts);
  }
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
