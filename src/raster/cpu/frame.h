// A frame as the stages of the rasteriser see it: the host's draws with what was worked out of them, and what the
// geometry stage leaves for the tiles. All memory is counted and can run out: std::bad_alloc.
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "raster/clip.h"
#include "raster/rules.h"
#include "vitrail/cpu.h"

namespace vitrail::raster {

constexpr std::uint32_t kTileSide = 32;
constexpr std::uint32_t kBlockSide = 4;
constexpr std::uint32_t kBlocks = kTileSide / kBlockSide * (kTileSide / kBlockSide); // of a tile
constexpr std::uint32_t kBlockPixels = kBlockSide * kBlockSide;

// Triangles are numbered through the frame: the number of their job, and within it. The last bit is free.
constexpr std::uint32_t kJobBits = 12;
constexpr std::uint32_t kJobTriangles = 1U << kJobBits;
constexpr std::uint32_t kMaxJobs = (1U << (31U - kJobBits)) - 1;
constexpr std::uint32_t kVertexChunk = 4096;

// A draw, with its defaults filled in.
struct DrawInfo {
  VitrailCpuDraw draw{};
  std::uint32_t primitives = 0;
  std::uint64_t firstVertex = 0; // among Frame::corners
  std::uint32_t firstJob = 0;
};

// Up to kJobTriangles triangles of a draw.
struct Job {
  std::uint32_t draw;
  std::uint32_t first;
  std::uint32_t count;
  std::uint64_t firstNearest; // in Frame::nearest, where that is there
};

// Triangle numbers of one thread and each tile, in the order in which they were added: in chunks, each twice as large
// as the one before it, up to 4 KB. Who reads them waits for each chunk's address, and goes through a chunk as through
// any array.
class Bins {
 public:
  void reset(std::size_t tiles) {
    bins_.assign(tiles, {});
    slab_ = 0;
    used_ = 0;
  }

  void add(std::size_t tile, std::uint32_t number) {
    Bin& bin = bins_[tile];
    if (bin.next == bin.end) append(bin);
    *bin.next++ = number;
  }

  std::uint32_t countOf(std::size_t tile) const {
    const Bin& bin = bins_[tile];
    return bin.room - static_cast<std::uint32_t>(bin.end - bin.next);
  }

  // Writes the numbers of a tile one after the other.
  void copy(std::size_t tile, std::uint32_t* to) const;

 private:
  static constexpr std::uint32_t kLine = 16; // numbers in a line of the cache
  static constexpr std::uint32_t kLeastLines = 2;
  static constexpr std::uint32_t kMostLines = 64;
  static constexpr std::uint32_t kSlabLines = 8192;
  struct Line {
    alignas(64) std::array<std::uint32_t, kLine> numbers;
  };
  struct Chunk { // at the begin of its lines; numbers follow
    Chunk* next;
    std::uint32_t room;
    std::uint32_t* numbers() { return reinterpret_cast<std::uint32_t*>(this + 1); }
    const std::uint32_t* numbers() const { return reinterpret_cast<const std::uint32_t*>(this + 1); }
  };
  struct Bin {
    std::uint32_t* next = nullptr; // where the next number goes
    std::uint32_t* end = nullptr;  // of its chunk
    Chunk* first = nullptr;
    Chunk* last = nullptr;
    std::uint32_t room = 0; // of all its chunks
  };
  using Slab = std::array<Line, kSlabLines>;

  void append(Bin& bin);

  std::vector<Bin> bins_;
  std::vector<std::unique_ptr<Slab>> slabs_;
  std::size_t slab_ = 0;   // the one that chunks come from
  std::uint32_t used_ = 0; // its lines
};

// Of one thread.
struct ThreadBins {
  Bins opaque;
  Bins transparent;
};

struct VertexChunk {
  std::uint32_t draw;
  std::uint32_t first;
  std::uint32_t count;
};

// What a frame has of each fragment: decides how much of it is kept.
struct FrameNeeds {
  bool shaded = false;      // some transparent draw has a shade function, or more is kept than its pair
  bool derivatives = false; // one of them reads derivatives
  bool filters = false;     // something passes light through coloured: BLEND_MULTIPLY, or a filter
  bool opaque = false;      // there are opaque draws, or a depth of the host's
  bool opaqueDerivatives = false;

  bool operator==(const FrameNeeds&) const = default;
};

// How far an 8-bit sRGB picture may be off for what is left out as hidden, in steps: as of the rasteriser for GPUs.
constexpr float kLeftOut = 0.35F;
// The least room for fragments that a thread can draw a tile with, in bytes.
constexpr std::uint64_t kLeastOfThread = 22528;
// What is behind less light than this shows nothing, however much light it sends.
constexpr float kNoTransmittance = 1e-30F;

struct Frame {
  VitrailCpuFrame info{}; // with its defaults filled in
  Viewport viewport{};
  FrameNeeds needs{};
  float leastTransmittance = 0.0F; // what is behind less than that does not count
  // Less than that, for what rounds otherwise where light is multiplied up in the order in which fragments come.
  float trackedTransmittance = 0.0F;
  bool addsUp = false; // surfaces may add light without hiding any
  std::vector<DrawInfo> draws;
  std::vector<Job> jobs;
  // Of each job's primitives a depth, nearer than all that it covers. Empty: their order does not matter.
  std::vector<float> nearest;
  std::vector<VertexChunk> vertexChunks;
  std::vector<Corner> corners;
  // Of draws without a shade function: what they do to the light behind them (below); after them, one that does
  // nothing.
  std::vector<std::array<float, 4>> flatPairs;
  std::vector<std::array<float, 4>> flatFilters; // where needs.filters
  // Of draws: how much each of their fragments hides at least of what is behind it, and the same as an optical depth:
  // how many times the light is halved.
  std::vector<float> leastAlphas;
  std::vector<float> opticalDepths;
  std::uint32_t tilesX = 0;
  std::uint32_t tilesY = 0;
  bool counts = false;           // the host asks how many fragments there are, hidden or not
  std::uint64_t budget = 0;      // bytes of one thread's fragments
  std::uint32_t tileThreads = 1; // how many threads draw tiles: as many as have room for theirs
  std::vector<ThreadBins> bins;  // one for each thread

  std::uint32_t tiles() const { return tilesX * tilesY; }

  float nearestOf(std::uint32_t number) const {
    return nearest[jobs[number >> kJobBits].firstNearest + (number & (kJobTriangles - 1))];
  }
  // Whether each fragment has the colour of its draw.
  bool isFlat() const { return !needs.shaded && !needs.filters && leastTransmittance > 0.0F; }
  // The optical depth behind which nothing counts.
  float opaqueDepth() const { return -std::log2(trackedTransmittance); }
  // Whether what hides others may be known when it comes.
  bool mayTrackHidden() const { return info.samples == 1 && !needs.filters && leastTransmittance > 0.0F; }
};

// What tiles counted.
struct TileCounts {
  std::uint64_t fragments = 0;
  std::uint64_t pixels = 0; // with at least one
  std::uint32_t layersMax = 0;

  void add(const TileCounts& other);
};

// A tile's pixels in the picture.
struct TileBox {
  std::int32_t x = 0; // of its first one
  std::int32_t y = 0;
  std::int32_t lastX = 0; // of its last one, within the tile
  std::int32_t lastY = 0;
  std::array<std::uint16_t, kBlocks> pixels{}; // of each block: those within the frame, a bit each
};

// Memory of one thread that works on tiles; kept from tile to tile and, where the next frame needs the same, from frame
// to frame: memory that the system has to hand out anew is slower than all that small frames do with it.
class TileWorkspace {
 public:
  TileWorkspace() = default;
  virtual ~TileWorkspace() = default;
  TileWorkspace(const TileWorkspace&) = delete;
  TileWorkspace& operator=(const TileWorkspace&) = delete;

  // Gets ready for another frame. False: that one needs another workspace.
  virtual bool begin(const Frame& frame) = 0;
  // The most that fragments have taken since then.
  virtual std::uint64_t fragmentBytes() const = 0;
};

// The stages, compiled for one set of instructions.
struct Stages {
  VitrailCpuInstructions instructions;
  void (*placeVertices)(Frame& frame, const VertexChunk& chunk);
  void (*binJob)(Frame& frame, std::uint32_t job, ThreadBins& bins);
  std::unique_ptr<TileWorkspace> (*makeWorkspace)(const Frame& frame);
  void (*drawTile)(const Frame& frame, std::uint32_t tile, TileWorkspace& workspace, TileCounts& counts);
};

// Those that the processor has, the widest first.
std::span<const Stages* const> stagesHere();

// ---- What several stages do alike, a vertex or triangle at a time

// A vertex in clip space, with the distances from the draw's planes.
ClipVertex clipVertexOf(const DrawInfo& info, std::uint32_t vertex);

// The vertex number of a primitive's corner.
inline std::uint32_t vertexOf(const VitrailCpuDraw& draw, std::uint64_t i) {
  return draw.indices != nullptr ? draw.indices[i] : static_cast<std::uint32_t>(i);
}

// What is rasterised of a primitive that is no triangle, or whose corners need clipping.
Pieces piecesOf(const Frame& frame, const DrawInfo& info, std::uint32_t primitive);

} // namespace vitrail::raster
