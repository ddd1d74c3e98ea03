// A tile's fragments. A row holds one fragment for each of a block's sixteen pixels, a vector (64 bytes) for each
// value. A triangle goes to the first of the block's last four rows in which its pixels are still free; where there is
// none, a row is opened: neighbouring small triangles of one surface, and thin ones that cross, fill rows together.
// Rows come in chunks, from an arena that is as large as the budget.
#if defined(VITRAIL_STORE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_STORE_INL_H
#undef VITRAIL_STORE_INL_H
#else
#define VITRAIL_STORE_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>
#include <vector>

#include "raster/cpu/frame.h"
#include "raster/cpu/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

constexpr std::size_t kVectorBytes = 64;
constexpr std::uint32_t kChunkRows = 8;

// Depths as integers that grow away from the viewer. Above zero, so that with what goes below they are normal doubles.
constexpr std::int32_t kNearestKey = 0x00100000;
constexpr std::int32_t kOneBits = 0x3f800000;
constexpr std::int32_t kFarKey = 0x7f000000; // farther than anything: there is no fragment

HWY_INLINE I keyOf(const F& depth, bool nearestIsOne) {
  // A NaN becomes the farthest depth.
  const F zero = set(0.0F);
  const F one = set(1.0F);
  const I base = set(kNearestKey);
  if (nearestIsOne) return set(kOneBits + kNearestKey) - bitsOf(min(keep(depth > zero, depth), one));
  return bitsOf(select(one >= depth, max(depth, zero), one)) + base;
}

HWY_INLINE F depthOf(const I& key, bool nearestIsOne) {
  return nearestIsOne ? floatOf(set(kOneBits + kNearestKey) - key) : floatOf(key - set(kNearestKey));
}

// Which vector of a row holds what. Shading replaces the weights by what is blended.
struct RowShape {
  static constexpr std::uint32_t kKey = 0;
  static constexpr std::uint32_t kNumber = 1; // shaded: the triangle's number; else: the draw's place in flatPairs
  static constexpr std::uint32_t kPairs = 2;  // shaded, four vectors: r, g, b, alpha of each pixel, side by side
  static constexpr std::uint32_t kSecond = 2; // weights and derivatives, until they are shaded
  static constexpr std::uint32_t kThird = 3;
  static constexpr std::uint32_t kDerivatives = 4;
  static constexpr std::uint32_t kFilters = 6; // four vectors
  static constexpr std::uint32_t kMost = 11;
  std::uint32_t coverage = 0;
  std::uint32_t vectors = 2; // at most kMost
  bool isFlat = false;
  std::int32_t nothing = 0; // flat: the place of the pair that does nothing

  RowShape(const FrameNeeds& needs, bool multisampled, std::size_t draws)
      : isFlat(!needs.shaded), nothing(static_cast<std::int32_t>(draws)) {
    if (needs.shaded) vectors = needs.filters ? 10 : needs.derivatives ? 8 : 6;
    if (multisampled) coverage = vectors++;
  }
  std::size_t bytes() const { return vectors * kVectorBytes; }
};

using Row = std::int32_t*; // vector i at 16 * i

HWY_INLINE float* floatsOf(Row row, std::uint32_t vector) { return reinterpret_cast<float*>(row + kLanes * vector); }

class Store {
 public:
  static constexpr std::uint32_t kNone = ~0U;
  static constexpr std::uint64_t kFull = ~std::uint64_t{0}; // so that the first fragment opens a row
  static constexpr std::uint32_t kFirstLimit = 64;
  static constexpr std::uint32_t kNoLimit = ~0U;

  // Where pairs are is told in 32 bits, in units of 16 bytes.
  static constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 36U;

  Store(const RowShape& shape, std::uint64_t budget) : shape_(shape) {
    chunkBytes_ = shape.bytes() * kChunkRows;
    chunks_ = chunksWithin(budget);
    arena_.reset(allocate(chunks_));
    previous_.resize(chunks_);
    makeBlank();
  }

  // Gets ready for another frame, whose rows are as large. False: the store is not as large as that budget makes one.
  bool begin(const RowShape& shape, std::uint64_t budget) {
    shape_ = shape;
    peak_ = 0;
    makeBlank();
    return chunks_ == chunksWithin(budget);
  }

  const RowShape& shape() const { return shape_; }
  const float* base() const { return reinterpret_cast<const float*>(arena_.get()); }

  // Lets go of everything. `limit`: how many rows make a block crowded.
  void reset(std::uint32_t limit) {
    used_ = 0;
    free_ = kNone;
    for (Head& head : heads_) {
      head = {};
      head.limit = limit;
    }
  }

  std::uint32_t rows(std::uint32_t block) const { return heads_[block].rows; }

  // The row for fragments of a block at the pixels of `mask`, and the one whose values its other pixels keep: itself,
  // or where nothing is in it yet one without fragments. Null: the arena is full.
  HWY_INLINE Row rowFor(std::uint32_t block, std::uint32_t mask, const std::int32_t*& kept) {
    Head& head = heads_[block];
    constexpr std::uint64_t kOnes = 0x0001000100010001U;
    // The top bit of each row in which all pixels of the mask are free, and maybe of rows above the lowest such one.
    const std::uint64_t taken = head.filled & mask * kOnes;
    const std::uint64_t free = (taken - kOnes) & ~taken & kOnes << 15U;
    const auto isFresh = static_cast<std::uint32_t>(free == 0);
    if (HWY_UNLIKELY((isFresh & static_cast<std::uint32_t>(head.left == 0)) != 0)) {
      if (!addChunk(head)) return nullptr;
    } else {
      head.row += isFresh * shape_.vectors * kLanes;
    }
    head.left -= isFresh;
    head.rows += isFresh;
    constexpr std::uint64_t kTop = std::uint64_t{1} << 63U;
    const auto place = static_cast<std::uint32_t>(std::countr_zero(free | kTop)) & 48U; // of its sixteen bits
    head.filled = head.filled >> 16U * isFresh | std::uint64_t{mask} << place;
    const Row row = head.row - (48U - place) * shape_.vectors;          // kLanes numbers a vector, 16 bits a row
    kept = row + (blank_ - row) * static_cast<std::ptrdiff_t>(isFresh); // without a branch: nobody could tell
    return row;
  }

  // All rows of a block, in the order in which they were opened.
  void collect(std::uint32_t block, std::vector<Row>& rows) const {
    const Head& head = heads_[block];
    rows.resize(head.rows);
    std::uint32_t chunk = head.chunk;
    for (std::uint32_t left = head.rows; left > 0;) {
      const std::uint32_t count = (left - 1) % kChunkRows + 1;
      left -= count;
      for (std::uint32_t i = 0; i < count; ++i) rows[left + i] = rowAt(chunk, i);
      chunk = previous_[chunk];
    }
  }

  void setLimit(std::uint32_t block, std::uint32_t limit) { heads_[block].limit = limit; }
  // Whether it is time to look which fragments of a block can still be seen.
  bool isCrowded(std::uint32_t block) const { return heads_[block].rows >= heads_[block].limit; }
  // How many of a block's rows, its first ones, were shaded.
  std::uint32_t shadedRows(std::uint32_t block) const { return heads_[block].shaded; }

  // All of its rows were.
  void setShaded(std::uint32_t block) {
    heads_[block].shaded = heads_[block].rows;
    heads_[block].filled = kFull; // nothing is added to a row that was shaded
  }

  // Keeps the first `rows` rows of a block, all of them shaded; `limit`: how many make it crowded.
  void keepFirst(std::uint32_t block, std::uint32_t rows, std::uint32_t limit) {
    Head& head = heads_[block];
    const std::uint32_t chunks = (rows + kChunkRows - 1) / kChunkRows;
    for (std::uint32_t i = (head.rows + kChunkRows - 1) / kChunkRows; i > chunks; --i) {
      const std::uint32_t before = previous_[head.chunk];
      previous_[head.chunk] = free_;
      free_ = head.chunk;
      head.chunk = before;
    }
    head.rows = rows;
    head.shaded = rows;
    head.limit = limit;
    head.filled = kFull;
    head.left = chunks * kChunkRows - rows;
    head.row = rows == 0 ? nullptr : rowAt(head.chunk, (rows - 1) % kChunkRows);
  }

  // Twice as much room, for what has to be held at once. Rows move.
  void grow() {
    if (2 * chunks_ * chunkBytes_ > kMostBytes) throw std::bad_alloc();
    std::unique_ptr<std::int32_t, Free> larger(allocate(chunks_ * 2));
    std::memcpy(larger.get(), arena_.get(), chunks_ * chunkBytes_);
    for (Head& head : heads_) {
      if (head.row != nullptr) head.row = larger.get() + (head.row - arena_.get());
    }
    arena_ = std::move(larger);
    chunks_ *= 2;
    previous_.resize(chunks_);
  }

  // An empty store but for `rows` rows of one block, to be filled in.
  void restart(std::uint32_t block, std::uint32_t rows) {
    reset(heads_[block].limit);
    const std::int32_t* kept = nullptr;
    for (std::uint32_t i = 0; i < rows; ++i) static_cast<void>(rowFor(block, 0xffffU, kept));
  }

  std::uint64_t peakBytes() const { return peak_ * chunkBytes_; }
  std::int32_t* arena() const { return arena_.get(); }

 private:
  struct Free {
    void operator()(std::int32_t* p) const { ::operator delete (p, std::align_val_t{kVectorBytes}); }
  };
  struct Head {
    std::uint64_t filled = kFull; // pixels of the last four rows, the last one's in the uppermost bits
    std::uint32_t rows = 0;
    std::uint32_t left = 0; // rows of the last chunk that are free
    std::uint32_t chunk = 0;
    std::uint32_t shaded = 0; // of its first rows
    std::uint32_t limit = kFirstLimit;
    Row row = nullptr; // the last one
  };

  void makeBlank() {
    std::fill_n(blank_, kLanes, kFarKey);
    if (shape_.isFlat) std::fill_n(blank_ + kLanes * RowShape::kNumber, kLanes, shape_.nothing);
  }

  std::uint32_t chunksWithin(std::uint64_t budget) const {
    const std::uint64_t chunks = std::min(budget, kMostBytes) / chunkBytes_;
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(chunks, 4, 1U << 24U));
  }

  std::int32_t* allocate(std::size_t chunks) const {
    return static_cast<std::int32_t*>(::operator new (chunks* chunkBytes_, std::align_val_t{kVectorBytes}));
  }

  Row rowAt(std::uint32_t chunk, std::uint32_t i) const {
    return arena_.get() + (std::size_t{chunk} * kChunkRows + i) * shape_.vectors * kLanes;
  }

  HWY_NOINLINE bool addChunk(Head& head) {
    if (head.rows >= head.limit) return false;
    if (free_ == kNone && used_ == chunks_) return false;
    const std::uint32_t chunk = free_ != kNone ? free_ : used_++;
    peak_ = std::max(peak_, used_);
    if (chunk == free_) free_ = previous_[chunk];
    previous_[chunk] = head.chunk;
    head.chunk = chunk;
    head.row = rowAt(head.chunk, 0);
    head.left = kChunkRows;
    head.filled = kFull; // rows before it are in another chunk
    return true;
  }

  RowShape shape_;
  alignas(64) std::int32_t blank_[RowShape::kMost * kLanes] = {}; // a row without fragments
  std::size_t chunkBytes_ = 0;
  std::uint32_t chunks_ = 0;
  std::uint32_t used_ = 0;
  std::uint32_t peak_ = 0;     // the most that were used
  std::uint32_t free_ = kNone; // chunks that were given back, a list
  std::unique_ptr<std::int32_t, Free> arena_;
  std::vector<std::uint32_t> previous_; // of a chunk: the one before it
  std::array<Head, kBlocks> heads_{};
};

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
