// What one thread keeps while it draws tiles, and the steps of a tile; each step is a file of its own.
#if defined(VITRAIL_WORKER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_WORKER_INL_H
#undef VITRAIL_WORKER_INL_H
#else
#define VITRAIL_WORKER_INL_H
#endif

#include <array>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "raster/cpu/batch-inl.h"
#include "raster/cpu/colors-inl.h"
#include "raster/cpu/picture.h"
#include "raster/cpu/resolve-inl.h"
#include "raster/cpu/shade-inl.h"
#include "raster/cpu/store-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

constexpr std::uint32_t kBlocksAcross = kTileSide / kBlockSide;

// The pixels of each block, in the tile: x below, y in the upper 16 bits; and both as numbers.
struct BlockLanes {
  alignas(64) std::int32_t position[kBlocks][kLanes];
  alignas(64) float place[kBlocks][2][kLanes];
  constexpr BlockLanes() : position(), place() {
    for (std::uint32_t b = 0; b < kBlocks; ++b) {
      for (std::uint32_t l = 0; l < kLanes; ++l) {
        const std::uint32_t column = b % kBlocksAcross * kBlockSide + l % kBlockSide;
        const std::uint32_t row = b / kBlocksAcross * kBlockSide + l / kBlockSide;
        position[b][l] = static_cast<std::int32_t>(column | row << 16U);
        place[b][0][l] = static_cast<float>(column);
        place[b][1][l] = static_cast<float>(row);
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

// A triangle of the batch and a block in which it covers something, and what: from below 8, 8 and 16 bits.
struct Work {
  std::uint32_t bits;
  std::uint32_t triangle() const { return bits & 0xffU; }
  std::uint32_t block() const { return bits >> 8U & 0xffU; }
  std::uint32_t pixels() const { return bits >> 16U; } // in which some sample is covered
};

// Lists triangle t with the blocks in a rectangle, as in Work; none where x1 is below x0. Writes up to kListedTooMany
// pairs too many: what most triangles need, without asking.
constexpr std::uint32_t kListedTooMany = 32;
HWY_INLINE std::uint32_t listBlocks(std::uint16_t* pairs, std::int32_t x0, std::int32_t x1, std::int32_t y0,
                                    std::int32_t y1, std::uint32_t t) {
  constexpr std::uint64_t kOnes = 0x0001000100010001U;
  std::uint64_t left = 0x0300020001000000U + (t + (static_cast<std::uint64_t>(x0 + 8 * y0) << 8U)) * kOnes;
  const auto width = static_cast<std::uint32_t>(x1 - x0 + 1);
  const auto height = static_cast<std::uint32_t>(y1 - y0 + 1);
  const auto list = [&](std::uint32_t y) {
    const std::uint64_t row[2] = {left, left + 0x0400U * kOnes};
    std::memcpy(pairs + y * width, row, sizeof(row));
    left += 0x0800U * kOnes;
  };
  list(0);
  list(1);
  list(2);
  if (HWY_UNLIKELY(height > 3)) {
    for (std::uint32_t y = 3; y < height; ++y) list(y);
  }
  return width * height;
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

// Equal parts of the depths of a tile's triangles, from near to far.
class DepthSteps {
 public:
  static constexpr std::uint32_t kCount = 512;

  DepthSteps() = default;
  DepthSteps(float least, float most, bool nearestIsOne) : first_(nearestIsOne ? most : least) {
    const float range = std::max(most - least, 1e-30F);
    scale_ = (nearestIsOne ? -1.0F : 1.0F) * (kCount - 1.0F) / range;
    size_ = (nearestIsOne ? -1.0F : 1.0F) * range / (kCount - 1.0F);
  }
  HWY_INLINE I of(const F& depth) const {
    return toInt(max(set(0.0F), min(set(kCount - 1.0F), (depth - set(first_)) * set(scale_))));
  }
  // Nearer than all that is in the step of a depth or in those behind it.
  HWY_INLINE F nearestFrom(const F& depth) const {
    return fma(toFloat(of(depth)) - set(0.01F), set(size_), set(first_)); // a little for what rounds
  }

 private:
  float first_ = 0.0F;
  float scale_ = 0.0F; // steps of a depth
  float size_ = 0.0F;  // of a step
};

// In which tiles shaded triangles are drawn in the order of depth. Shading takes longer in it, since neighbours come
// apart, so that it pays only where it spares an eighth of the triangles: at the optical depths at which it did, and in
// one of 32 tiles it is tried.
class OrderTrial {
 public:
  bool isWorth(float depth) {
    depth_ = depth;
    return depth >= paysFrom_ || asked_++ % 32 == 0;
  }
  // Of the tile that was asked for last.
  void learn(bool pays) { paysFrom_ = pays ? std::min(paysFrom_, depth_) : std::max(paysFrom_, depth_ * 1.05F); }

 private:
  std::uint32_t asked_ = 0;
  float depth_ = 0.0F;
  float paysFrom_ = 3.0e38F;
};

class TileWorker final : public TileWorkspace {
 public:
  explicit TileWorker(const Frame& frame)
      : needs_(frame.needs), samples_(frame.info.samples), shape_(shapeOf(frame)), store_(shape_, frame.budget) {
    if (frame.needs.opaque) opaque_ = std::make_unique<OpaqueTile>(frame.info.samples);
  }

  void draw(const Frame& frame, std::uint32_t tile, TileCounts& counts);
  bool begin(const Frame& frame) override {
    if (needs_ != frame.needs || samples_ != frame.info.samples) return false;
    order_ = {};
    rowsBefore_ = 0;
    shape_ = shapeOf(frame);
    return store_.begin(shape_, frame.budget);
  }
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

  // A block's first pixel in the frame.
  std::uint32_t blockX(std::uint32_t block) const {
    return static_cast<std::uint32_t>(tile_.x) + block % kBlocksAcross * kBlockSide;
  }
  std::uint32_t blockY(std::uint32_t block) const {
    return static_cast<std::uint32_t>(tile_.y) + block / kBlocksAcross * kBlockSide;
  }

  static RowShape shapeOf(const Frame& frame) { return {frame.needs, frame.info.samples > 1}; }
  void takeNumbers(const Frame& frame, std::uint32_t tile, bool opaque);
  void merge();
  bool orderByDepth(const Frame& frame);
  bool orderLarge(const Frame& frame);
  bool areBehind(const Frame& frame, std::size_t first, std::uint64_t blocks) const;
  void stage(const Frame& frame, std::size_t first, std::uint32_t count, bool isShaded, Staged& staged);
  template <class Emit>
  bool rasterise(const Frame& frame, std::uint64_t blocks, bool isShaded, Emit emit);
  template <class Emit>
  bool stagePieces(const Frame& frame, std::uint32_t number, bool isShaded, Emit emit);
  template <class Emit>
  bool drawPieces(const Frame& frame, bool isShaded, Emit emit);
  template <class Emit>
  bool drawBatch(const Frame& frame, const Staged& staged, const StagedPieces* pieces, bool isShaded,
                 std::uint64_t& clipped, Emit emit);
  enum class Hidden { None, Counted, Dropped }; // what may be hidden, and what becomes of it
  template <bool kIsBig, Hidden kHidden>
  HWY_INLINE std::uint32_t cover(std::uint32_t items);
  HWY_INLINE std::uint32_t coverSamples(std::uint32_t items, std::uint32_t samples);

  // At the pixels' centres.
  HWY_INLINE F depthOfWork(const Work& work) const {
    const std::uint32_t block = work.block();
    return depthAt(batch_, work.triangle(), load(kBlockLanes.position[block]), load(kBlockLanes.place[block][0]),
                   load(kBlockLanes.place[block][1]));
  }
  template <bool kPlain = false>
  HWY_INLINE void perspective(const Work& work, bool derivatives, F* weights) const;
  HWY_INLINE void countHidden(std::uint32_t block, std::uint32_t mask);
  // What is kept of a fragment: its triangle and place, or its draw. Where it is tracked, also what light is left
  // behind those of its pixel.
  enum class Kept { Shaded, ShadedTracked, Flat, FlatTracked };
  static constexpr bool isShaded(Kept kept) { return kept == Kept::Shaded || kept == Kept::ShadedTracked; }
  static constexpr bool isTracked(Kept kept) { return kept == Kept::ShadedTracked || kept == Kept::FlatTracked; }
  // What a fragment hides at least, by its draw's number in the batch.
  template <Kept kKept>
  HWY_INLINE float hidingOf(const Frame& frame, std::int32_t draw) const {
    return isShaded(kKept) ? frame.leastAlphas[static_cast<std::uint32_t>(draw)] : colors_.alphaOf(draw);
  }
  enum class Emitted { IsStored, IsCrowded, IsFull };
  template <Kept kKept>
  Emitted emitTransparent(const Frame& frame, std::uint32_t item, Window* window);
  template <Kept kKept>
  bool emit(const Frame& frame, std::uint32_t item, Window* window);
  template <Kept kKept>
  std::uint32_t emitPlain(const Frame& frame, std::uint32_t item, std::uint32_t count);
  template <Kept kKept>
  bool emitAll(const Frame& frame, std::uint32_t count);
  HWY_INLINE std::uint32_t withoutLater(const Frame& frame, const Work& work, std::uint32_t item, std::uint32_t mask,
                                        const I* keys);
  HWY_INLINE void emitOpaque(const Frame& frame, std::uint32_t item);
  HWY_INLINE std::uint32_t testDepth(const Frame& frame, const Work& work, std::uint32_t item, const F& depth, I* keys);

  void drawOpaque(const Frame& frame, std::uint32_t tile);
  void shadeOpaque(const Frame& frame, std::uint32_t block);
  template <Kept kKept>
  bool collect(const Frame& frame, std::uint64_t blocks);
  void drawParts(const Frame& frame, std::uint64_t blocks, TileCounts& counts);
  void drawInWindows(const Frame& frame, std::uint32_t block, TileCounts& counts);
  void shrink(Window& window, std::uint32_t block);
  void thin(const Frame& frame, std::uint32_t block);
  void dropHidden(const Frame& frame, std::uint32_t block);
  std::uint32_t letGo(std::uint32_t block);
  void dropTracked(std::uint32_t block);
  HWY_INLINE void trackHidden(const Frame& frame, std::uint32_t block, const M& here, const I& key, float alpha);
  void hideFrom(std::uint32_t block, const I& until);
  bool mayHide(const Frame& frame) const;
  bool mayHideFlat(const Frame& frame, std::uint32_t block);
  void shadeBlock(const Frame& frame, std::uint32_t block);
  bool shadesOnDemand(const Frame& frame, std::uint32_t block);
  void shadeRowsFrom(const Frame& frame, std::uint32_t block, std::size_t first);
  HWY_INLINE std::uint32_t demand(const Frame& frame, std::uint32_t block, const SortedRows& sorted, std::size_t r,
                                  std::uint32_t lanes);
  template <bool kFilters>
  void blendOnDemand(const Frame& frame, std::uint32_t block, const SortedRows& sorted, Blended& blended);
  I saturationOf(const Frame& frame, const SortedRows& sorted) const;
  void resolveBlock(const Frame& frame, std::uint32_t block, TileCounts& counts);
  SortedRows sortBlock(const Frame& frame, std::uint32_t block);
  static void count(const std::int32_t* layers, TileCounts& counts);
  static bool isHidden(const Frame& frame, const State& state);
  void blendInto(const Frame& frame, std::uint32_t block, const SortedRows& sorted, State& state);
  void coveragesOf(const SortedRows& sorted, std::uint32_t* coverages) const;
  std::array<std::uint32_t, 4> hookOrderOf(const Frame& frame, std::uint64_t key, std::size_t lane) const;
  static const VitrailCpuDraw& drawOfNumber(const Frame& frame, std::int32_t number);
  Row rowOf(const SortedRows& sorted, std::size_t r, std::size_t lane) const;
  Row rowAt(std::uint32_t place, std::size_t lane) const;
  void behind(const Frame& frame, std::uint32_t block, std::uint32_t sample, F* color);
  void behindAll(const Frame& frame, std::uint32_t block, std::uint32_t sample, F* color);
  float* pixelsOf(const Frame& frame, std::uint32_t block, std::size_t& stride) const;
  HWY_INLINE void prefetchPixels(const Frame& frame, std::uint32_t block) const;
  void write(const Frame& frame, std::uint32_t block, const F* color);
  void writeTile(const Frame& frame);
  void blendedOver(const Frame& frame, std::uint32_t block, const State* state, F* mean);
  void finishBlock(const Frame& frame, std::uint32_t block, const State* state);
  void listBlock(const Frame& frame, std::uint32_t block, const SortedRows& sorted);
  void layersOf(const Frame& frame, const SortedRows& sorted, std::uint32_t lane);

  FrameNeeds needs_; // and for how many samples the memory below is
  std::uint32_t samples_;
  RowShape shape_;
  Store store_;
  Batch batch_{};
  TileColors colors_;
  TileBox tile_{};
  std::vector<std::uint32_t> numbers_;
  std::vector<std::size_t> lists_; // where those of each thread begin
  union Nearest {                  // of sixteen triangles
    alignas(64) float depth[kLanes];
    std::int32_t step[kLanes];
  };
  std::vector<Nearest> nearest_; // of numbers_, before they were ordered
  DepthSteps steps_;             // by which they were
  std::vector<std::uint32_t> inOrder_;
  std::vector<std::pair<float, std::uint32_t>> farther_; // depths, and numbers
  std::size_t rowsBefore_ = 0;                           // of the last tile: rows of all blocks, and triangles
  std::size_t trianglesBefore_ = 0;
  std::size_t shownTriangles_ = 0; // of numbers_: those behind them are hidden
  std::array<Staged, 2> staged_{};
  StagedPieces pieces_{};
  std::unique_ptr<OpaqueTile> opaque_;
  bool hasDepth_ = false;                       // opaque surfaces may hide fragments of this tile
  std::array<std::uint16_t, kBlocks> wanted_{}; // pixels of each block that are drawn
  std::array<std::uint16_t, kBatch * kBlocks + kListedTooMany> pairs_{};
  std::array<Work, kBatch * kBlocks + 64> work_{};
  std::array<Work, kBatch * kBlocks + 64> hiddenWork_{};
  std::array<std::array<std::uint16_t, kBatch * kBlocks + 64>, kMaxSamples> sampleMasks_{};
  // Blocks in which what is far away is known to be hidden: from which depth on, and how many fragments were left out.
  std::uint64_t saturated_ = 0;
  struct Trial {
    std::uint32_t asked = 0;
    bool pays = false;
  };
  Trial demand_; // blocks of the tile that are shaded in the order of depth
  OrderTrial order_;
  std::uint64_t edges_ = 0; // blocks in which a fragment does not cover all samples of its pixel
  alignas(64) std::int32_t until_[kBlocks][kLanes];
  alignas(64) std::int32_t hidden_[kBlocks][kLanes];
  alignas(64) std::array<std::int32_t, kBlocks> allUntil_{}; // in all pixels; kFarKey: in some nothing is hidden
  // Of flat fragments, whose alpha is known when they come, where there may be enough of them: what light comes through
  // them, the farthest of them, and the pixels in which it is too little to show anything.
  alignas(64) float through_[kBlocks][kLanes];
  alignas(64) std::int32_t farthest_[kBlocks][kLanes];
  std::array<std::uint16_t, kBlocks> opaquePixels_{};
  bool tracksHidden_ = false;
  // Nearer than all that the batch's triangles cover, as keys; where some block is saturated.
  alignas(64) std::array<std::int32_t, kBatch> batchNearest_{};
  alignas(64) std::int32_t layers_[kLanes] = {}; // fragments of each pixel of the block that was sorted last
  std::vector<Row> rows_;
  std::vector<double> keyMemory_;
  std::vector<std::uint32_t> coverageMemory_;
  std::vector<VitrailLayer> list_;
  PixelBlock pixels_;
  PixelBlock behind_;
  // Blocks that are done but not in the picture yet: four floats a pixel.
  alignas(64) std::array<std::array<float, 4 * kLanes>, kBlocks> drawn_{};
  std::uint64_t written_ = 0;
  std::uint64_t untouched_ = 0; // blocks in which there is nothing
  alignas(64) VitrailCpuFragments fragments_{};
};

// Memory that is aligned as vectors are, of one that has 64 bytes to spare.
template <class T>
T* aligned(T* p) {
  const std::uintptr_t past = reinterpret_cast<std::uintptr_t>(p) % 64;
  return reinterpret_cast<T*>(reinterpret_cast<char*>(p) + (past == 0 ? 0 : 64 - past));
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
