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

// The same of a depth between those of a triangle's corners, which is a number.
HWY_INLINE I keyOfInner(const F& depth, bool nearestIsOne) {
  const I bits = bitsOf(min(max(depth, set(0.0F)), set(1.0F)));
  return nearestIsOne ? set(kOneBits + kNearestKey) - bits : bits + set(kNearestKey);
}

HWY_INLINE F depthOf(const I& key, bool nearestIsOne) {
  return nearestIsOne ? floatOf(set(kOneBits + kNearestKey) - key) : floatOf(key - set(kNearestKey));
}

// Which vector of a row holds what. Shading replaces the weights by what is blended.
struct RowShape {
  static constexpr std::uint32_t kKey = 0;
  static constexpr std::uint32_t kNumber = 1; // shaded: the triangle's number; else: the draw's in TileColors
  static constexpr std::uint32_t kPairs = 2;  // shaded, four vectors: r, g, b, alpha of each pixel, side by side
  static constexpr std::uint32_t kSecond = 2; // weights and derivatives, until they are shaded
  static constexpr std::uint32_t kThird = 3;
  static constexpr std::uint32_t kDerivatives = 4;
  static constexpr std::uint32_t kFilters = 6; // four vectors
  static constexpr std::uint32_t kMost = 11;
  std::uint32_t coverage = 0;
  static constexpr std::uint32_t kFlatVectors = 2;
  std::uint32_t vectors = kFlatVectors; // at most kMost
  bool isFlat = false;

  RowShape(const FrameNeeds& needs, bool multisampled) : isFlat(!needs.shaded) {
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
  static constexpr std::uint32_t kRoomForAll = 16 * kBlocks; // chunks

  static constexpr std::uint32_t kLeastChunks = 4;
  static_assert(kLeastChunks * kChunkRows * RowShape::kMost * kVectorBytes <= kLeastOfThread);

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
      head.row = head.last = arena_.get();
      head.limit = limit;
      // The first chunk is there before it is needed, where there is room for many: whether a block's first fragment
      // comes is what nobody can foresee.
      if (chunks_ >= kRoomForAll) openChunk(head, used_++);
    }
    peak_ = std::max(peak_, used_);
  }

  std::uint32_t rows(std::uint32_t block) const {
    const Head& head = heads_[block];
    return head.chunks * kChunkRows - static_cast<std::uint32_t>((head.last - head.row) / stride_);
  }

  struct Head {                   // of a block
    std::uint64_t filled = kFull; // pixels of the last four rows, the last one's in the uppermost bits
    Row row = nullptr;            // the last one
    Row last = nullptr;           // of its chunk; where there is none, both are the arena
    std::uint32_t chunk = 0;      // the last one
    std::uint32_t chunks = 0;
    std::uint32_t shaded = 0; // of its first rows
    std::uint32_t limit = kFirstLimit;
  };

  // Which of the block's last four rows is the first in which all pixels of a mask are free: 0 to 3, or 4: none of
  // them, another row is opened. What follows from it has no branches: nobody could tell which way they go.
  static HWY_INLINE std::uint32_t freeRow(const Head& head, std::uint32_t mask) {
#if HWY_TARGET == HWY_AVX3
    const __m128i filled = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(&head.filled)); // four more rows: all free
    const auto free = _mm_testn_epi16_mask(filled, _mm_set1_epi16(static_cast<short>(mask)));
    return static_cast<std::uint32_t>(std::countr_zero(static_cast<std::uint32_t>(free)));
#else
    constexpr std::uint64_t kOnes = 0x0001000100010001U;
    const std::uint64_t taken = head.filled & mask * kOnes;
    // The top bit of each such row, and maybe of rows above the lowest one.
    const std::uint64_t free = (taken - kOnes) & ~taken & kOnes << 15U;
    return static_cast<std::uint32_t>(std::countr_zero(free)) >> 4U;
#endif
  }
  // It is beyond the block's last chunk. `stride`: from row to row.
  static HWY_INLINE Row rowAfter(const Head& head, std::uint32_t index, std::uint32_t stride) {
    return head.row + (static_cast<std::ptrdiff_t>(index) - 3) * static_cast<std::ptrdiff_t>(stride);
  }
  // Takes it, and tells the row whose values its other pixels keep: itself, or where nothing is in it yet one without
  // fragments.
  HWY_INLINE const std::int32_t* take(Head& head, std::uint32_t mask, std::uint32_t index, Row row) const {
    const std::uint32_t isFresh = index >> 2U;
    head.row = std::max(head.row, row);
    head.filled = head.filled >> 16U * isFresh | std::uint64_t{mask} << 16U * (index - isFresh);
    return isFresh != 0 ? blank_ : row;
  }

  // All of these, and a chunk if it takes one. Null: the arena is full, or the block crowded.
  HWY_INLINE Row rowFor(std::uint32_t block, std::uint32_t mask, const std::int32_t*& kept) {
    Head& head = heads_[block];
    std::uint32_t index = freeRow(head, mask);
    Row row = rowAfter(head, index, stride_);
    if (HWY_UNLIKELY(row > head.last)) {
      if (!addChunk(head)) return nullptr;
      index = freeRow(head, mask);
      row = rowAfter(head, index, stride_);
    }
    kept = take(head, mask, index, row);
    return row;
  }

  Head* heads() { return heads_.data(); }

  // All rows of a block, in the order in which they were opened.
  void collect(std::uint32_t block, std::vector<Row>& rows) const {
    const Head& head = heads_[block];
    rows.resize(this->rows(block));
    std::uint32_t chunk = head.chunk;
    for (auto left = static_cast<std::uint32_t>(rows.size()); left > 0;) {
      const std::uint32_t count = (left - 1) % kChunkRows + 1;
      left -= count;
      for (std::uint32_t i = 0; i < count; ++i) rows[left + i] = rowAt(chunk, i);
      chunk = previous_[chunk];
    }
  }

  void setLimit(std::uint32_t block, std::uint32_t limit) { heads_[block].limit = limit; }
  // Whether it is time to look which fragments of a block can still be seen.
  bool isCrowded(std::uint32_t block) const { return rows(block) >= heads_[block].limit; }
  // How many of a block's rows, its first ones, were shaded.
  std::uint32_t shadedRows(std::uint32_t block) const { return heads_[block].shaded; }

  // All of its rows were.
  void setShaded(std::uint32_t block) {
    heads_[block].shaded = rows(block);
    heads_[block].filled = kFull; // nothing is added to a row that was shaded
  }

  // Keeps the first `rows` rows of a block, the first `shaded` of them shaded; `limit`: how many make it crowded.
  void keepFirst(std::uint32_t block, std::uint32_t rows, std::uint32_t shaded, std::uint32_t limit) {
    Head& head = heads_[block];
    const std::uint32_t chunks = (rows + kChunkRows - 1) / kChunkRows;
    for (; head.chunks > chunks; --head.chunks) {
      const std::uint32_t before = previous_[head.chunk];
      previous_[head.chunk] = free_;
      free_ = head.chunk;
      head.chunk = before;
    }
    head.shaded = shaded;
    head.limit = limit;
    head.filled = kFull;
    head.row = rows == 0 ? arena_.get() : rowAt(head.chunk, (rows - 1) % kChunkRows);
    head.last = rows == 0 ? arena_.get() : rowAt(head.chunk, kChunkRows - 1);
  }

  // Twice as much room, for what has to be held at once. Rows move.
  void grow() {
    if (2 * chunks_ * chunkBytes_ > kMostBytes) throw std::bad_alloc();
    std::unique_ptr<std::int32_t, Free> larger(allocate(chunks_ * 2));
    std::memcpy(larger.get(), arena_.get(), chunks_ * chunkBytes_);
    for (Head& head : heads_) {
      head.row = larger.get() + (head.row - arena_.get());
      head.last = larger.get() + (head.last - arena_.get());
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
  void makeBlank() {
    stride_ = static_cast<std::uint32_t>(shape_.vectors * kLanes);
    std::fill_n(blank_, kLanes, kFarKey);
  }

  // An empty one after a block's others.
  void openChunk(Head& head, std::uint32_t chunk) {
    previous_[chunk] = head.chunk;
    head.chunk = chunk;
    ++head.chunks;
    head.last = rowAt(chunk, kChunkRows - 1);
    head.row = head.last - kChunkRows * stride_;
    head.filled = kFull; // rows before it are in another chunk
  }

  std::uint32_t chunksWithin(std::uint64_t budget) const {
    const std::uint64_t chunks = std::min(budget, kMostBytes) / chunkBytes_;
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(chunks, kLeastChunks, 1U << 24U));
  }

  std::int32_t* allocate(std::size_t chunks) const {
    return static_cast<std::int32_t*>(::operator new (chunks* chunkBytes_, std::align_val_t{kVectorBytes}));
  }

  Row rowAt(std::uint32_t chunk, std::uint32_t i) const {
    return arena_.get() + (std::size_t{chunk} * kChunkRows + i) * shape_.vectors * kLanes;
  }

  HWY_NOINLINE bool addChunk(Head& head) {
    if (head.chunks * kChunkRows >= head.limit) return false; // all of them full
    if (free_ == kNone && used_ == chunks_) return false;
    const std::uint32_t chunk = free_ != kNone ? free_ : used_++;
    peak_ = std::max(peak_, used_);
    if (chunk == free_) free_ = previous_[chunk];
    openChunk(head, chunk);
    return true;
  }

  RowShape shape_;
  alignas(64) std::int32_t blank_[RowShape::kMost * kLanes] = {}; // a row without fragments
  std::uint32_t stride_ = 0;                                      // of rows
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
