// Vertices to corners, and triangles to the tiles that they may touch.
#if defined(VITRAIL_GEOMETRY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_GEOMETRY_INL_H
#undef VITRAIL_GEOMETRY_INL_H
#else
#define VITRAIL_GEOMETRY_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cstring>

#include "raster/cpu/frame.h"
#include "raster/cpu/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

// Up to sixteen vertices in clip space, as columns. Those that are not there repeat the last one.
struct Vertices {
  alignas(64) float value[4][kLanes];
};

HWY_INLINE void fetchVertices(const VitrailCpuDraw& draw, std::uint32_t first, std::uint32_t count, Vertices& to) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(draw.positions);
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    const std::uint64_t vertex = first + std::min(lane, count - 1);
    float p[4] = {0.0F, 0.0F, 0.0F, 1.0F};
    if (draw.components == 3) {
      std::memcpy(p, bytes + vertex * draw.vertexStride, 3 * sizeof(float));
    } else {
      std::memcpy(p, bytes + vertex * draw.vertexStride, 4 * sizeof(float));
    }
    for (std::size_t c = 0; c < 4; ++c) to.value[c][lane] = p[c];
  }
}

// Lanes whose vertex lies outside of what can be rasterised: `outside` of clip.h's needsClipping().
HWY_INLINE M isOutside(const Viewport& viewport, const F& x, const F& y, const F& z, const F& w) {
  const auto pixels = static_cast<float>(kGuardBand - 1);
  const F bandX = set(2.0F * pixels / static_cast<float>(viewport.width)) * w;
  const F bandY = set(2.0F * pixels / static_cast<float>(viewport.height)) * w;
  const F zero = set(0.0F);
  const F near = viewport.depthFromMinusW ? w + z : z;
  const M inside = (w >= set(kLeastW)) & (set(kMostW) >= w) & (near >= zero) & (w - z >= zero) & (bandX >= x) &
                   (bandX + x >= zero) & (bandY >= y) & (bandY + y >= zero);
  return ~inside;
}

// Corners of sixteen vertices. `cut` bits: those that need clipping whatever their place.
HWY_INLINE void placeSixteen(const Viewport& viewport, const F& x, const F& y, const F& z, const F& w,
                             std::uint32_t cut, std::uint32_t count, Corner* corners) {
  const F inverse = set(1.0F) / w;
  const F halfWidth = set(0.5F * static_cast<float>(viewport.width));
  const F halfHeight = set(0.5F * static_cast<float>(viewport.height));
  const F subpixels = set(static_cast<float>(kSubpixels));
  const F ndcX = x * inverse;
  const F ndcY = viewport.yUp ? set(0.0F) - y * inverse : y * inverse;
  const F ndcZ = z * inverse;
  const F depth = viewport.depthFromMinusW ? ndcZ * set(0.5F) + set(0.5F) : ndcZ;
  const M outside = isOutside(viewport, x, y, z, w) | maskOf(cut);
  I placeX;
  I placeY;
  VITRAIL_EACH {
    placeX.v[i] = hn::NearestInt((ndcX * halfWidth + halfWidth).v[i] * subpixels.v[i]);
    placeY.v[i] = hn::NearestInt((ndcY * halfHeight + halfHeight).v[i] * subpixels.v[i]);
  }
  placeX = select(outside, set(kNeedsClipping), placeX - set(viewport.originX * kSubpixels));
  placeY = placeY - set(viewport.originY * kSubpixels);
  static_assert(sizeof(Corner) == 4 * sizeof(float));
  alignas(64) float fours[4 * kLanes];
  storePixels(fours, floatOf(placeX), floatOf(placeY), depth, inverse);
  if (HWY_LIKELY(count == kLanes)) {
    std::memcpy(corners, fours, sizeof(fours));
  } else {
    std::memcpy(corners, fours, count * sizeof(Corner));
  }
}

// Bits of vertices that a plane of the draw's cuts away.
HWY_INLINE std::uint32_t cutByPlanes(const VitrailCpuDraw& draw, const F& x, const F& y, const F& z, const F& w) {
  M kept = set(0.0F) == set(0.0F);
  for (std::uint32_t i = 0; i < draw.clipPlaneCount; ++i) {
    const float* p = draw.clipPlanes + std::size_t{4} * i;
    kept = kept & (((set(p[3]) * w + set(p[2]) * z) + set(p[1]) * y) + set(p[0]) * x >= set(0.0F));
  }
  return ~bitsOf(kept) & 0xffffU;
}

inline void placeVertices(Frame& frame, const VertexChunk& chunk) {
  const DrawInfo& info = frame.draws[chunk.draw];
  const VitrailCpuDraw& draw = info.draw;
  Vertices vertices;
  for (std::uint32_t done = 0; done < chunk.count; done += kLanes) {
    const std::uint32_t count = std::min<std::uint32_t>(kLanes, chunk.count - done);
    fetchVertices(draw, chunk.first + done, count, vertices);
    F p[4];
    for (std::size_t c = 0; c < 4; ++c) p[c] = load(vertices.value[c]);
    if (const float* m = draw.model) {
      F moved[3];
      for (F& v : moved) {
        v = ((set(m[3]) * p[3] + set(m[2]) * p[2]) + set(m[1]) * p[1]) + set(m[0]) * p[0];
        m += 4;
      }
      for (std::size_t c = 0; c < 3; ++c) p[c] = moved[c];
    }
    const std::uint32_t cut = draw.clipPlaneCount == 0 ? 0 : cutByPlanes(draw, p[0], p[1], p[2], p[3]);
    F q[4] = {p[0], p[1], p[2], p[3]};
    if (const float* m = draw.transform) {
      for (F& v : q) {
        v = ((set(m[12]) * p[3] + set(m[8]) * p[2]) + set(m[4]) * p[1]) + set(m[0]) * p[0];
        ++m;
      }
    }
    placeSixteen(frame.viewport, q[0], q[1], q[2], q[3], cut, count,
                 &frame.corners[info.firstVertex + chunk.first + done]);
  }
}

// How near to a pixel's borders samples lie, in subpixels.
inline std::int32_t sampleMargin(std::uint32_t samples) {
  return samples == 1 ? 128 : samples == 2 ? 64 : samples == 4 ? 32 : 16;
}

// Tiles whose pixels' samples a box in subpixels may hold; where x1 is below x0, or y1 below y0, none.
struct TileRange {
  std::int32_t x0;
  std::int32_t y0;
  std::int32_t x1;
  std::int32_t y1;
};

// The same of sixteen boxes.
struct TileRanges {
  alignas(64) std::int32_t x0[kLanes];
  alignas(64) std::int32_t y0[kLanes];
  alignas(64) std::int32_t x1[kLanes];
  alignas(64) std::int32_t y1[kLanes];
  alignas(64) std::int32_t first[kLanes]; // number of the first tile
  std::uint32_t single = 0;               // those of one tile, a bit each
};

// Returns which of them hold anything, a bit each.
HWY_INLINE std::uint32_t tilesOfSixteen(const Frame& frame, const I& left, const I& top, const I& right,
                                        const I& bottom, TileRanges& ranges) {
  const std::int32_t margin = sampleMargin(frame.info.samples);
  // From the first pixel with a sample at or right of `left` to the last one with a sample at or left of `right`.
  const I before = set(margin - 1);
  const I after = set(margin);
  const I zero = set(0);
  const I x0 = max(shiftRight<kSubpixelBits>(left + before), zero);
  const I y0 = max(shiftRight<kSubpixelBits>(top + before), zero);
  const I x1 = min(shiftRight<kSubpixelBits>(right - after), set(static_cast<std::int32_t>(frame.info.width) - 1));
  const I y1 = min(shiftRight<kSubpixelBits>(bottom - after), set(static_cast<std::int32_t>(frame.info.height) - 1));
  const I tileX0 = shiftRight<5>(x0);
  const I tileY0 = shiftRight<5>(y0);
  const I tileX1 = shiftRight<5>(x1);
  const I tileY1 = shiftRight<5>(y1);
  store(ranges.x0, tileX0);
  store(ranges.y0, tileY0);
  store(ranges.x1, tileX1);
  store(ranges.y1, tileY1);
  store(ranges.first, tileY0 * set(static_cast<std::int32_t>(frame.tilesX)) + tileX0);
  const std::uint32_t seen = ~bitsOf((x0 > x1) | (y0 > y1)) & 0xffffU;
  ranges.single = seen & bitsOf((tileX0 == tileX1) & (tileY0 == tileY1));
  return seen;
}

inline void addTo(Bins& bins, const Frame& frame, const TileRange& range, std::uint32_t number) {
  for (std::int32_t y = range.y0; y <= range.y1; ++y) {
    for (std::int32_t x = range.x0; x <= range.x1; ++x) {
      bins.add(static_cast<std::size_t>(y) * frame.tilesX + static_cast<std::size_t>(x), number);
    }
  }
}

// Of primitives that are rasterised as several triangles: each tile gets the number once.
inline void binPieces(const Frame& frame, const DrawInfo& info, std::uint32_t primitive, std::uint32_t number,
                      Bins& bins) {
  const Pieces pieces = piecesOf(frame, info, primitive);
  if (pieces.count == 0) return;
  std::int32_t left = INT32_MAX;
  std::int32_t top = INT32_MAX;
  std::int32_t right = INT32_MIN;
  std::int32_t bottom = INT32_MIN;
  for (const Piece& piece : pieces.all()) {
    for (const Corner& corner : piece.corners) {
      left = std::min(left, corner.x);
      right = std::max(right, corner.x);
      top = std::min(top, corner.y);
      bottom = std::max(bottom, corner.y);
    }
  }
  TileRanges ranges;
  if (tilesOfSixteen(frame, set(left), set(top), set(right), set(bottom), ranges) == 0) return;
  addTo(bins, frame, {ranges.x0[0], ranges.y0[0], ranges.x1[0], ranges.y1[0]}, number);
}

// A little nearer than what triangles cover whose corners have these depths: it may be off by 2^-20 of the way between
// them.
HWY_INLINE F nearestOfDepths(const F& a, const F& b, const F& c, bool nearestIsOne) {
  const F least = min(a, min(b, c));
  const F most = max(a, max(b, c));
  const F margin = fma(set(1.0F / 65536.0F), most - least, set(1.0F / 1048576.0F) * most);
  return nearestIsOne ? most + margin : least - margin;
}

// Up to sixteen triangles of a job, from its `first`th on. Transparent ones in any order, but always the same; opaque
// ones in theirs, since of those at one depth the last one shows. `nearest`: null, or takes how near each comes.
HWY_INLINE void binSixteen(const Frame& frame, const DrawInfo& info, std::uint32_t jobNumber, std::uint32_t first,
                           std::uint32_t count, float* nearest, Bins& bins) {
  const VitrailCpuDraw& draw = info.draw;
  const Job& job = frame.jobs[jobNumber];
  const Corner* const base = frame.corners.data() + info.firstVertex;
  I x[3];
  I y[3];
  F z[3];
  for (std::uint32_t c = 0; c < 3; ++c) {
    F column[4];
    const auto load = [&](auto cornerOf) HWY_ATTR { loadFours(cornerOf, column[0], column[1], column[2], column[3]); };
    if (HWY_LIKELY(count == kLanes && draw.indices != nullptr)) {
      const std::uint32_t* const indices = draw.indices + 3 * std::uint64_t{job.first + first} + c;
      load([base, indices](std::size_t lane) { return reinterpret_cast<const float*>(base + indices[3 * lane]); });
    } else {
      load([&](std::size_t lane) { // what is beyond the job repeats its last triangle
        const std::uint64_t triangle = job.first + std::min(first + static_cast<std::uint32_t>(lane), job.count - 1);
        return reinterpret_cast<const float*>(base + vertexOf(draw, 3 * triangle + c));
      });
    }
    x[c] = bitsOf(column[0]);
    y[c] = bitsOf(column[1]);
    z[c] = column[2];
  }
  const I left = min(x[0], min(x[1], x[2]));
  const std::uint32_t here = 0xffffU >> (kLanes - count);
  const std::uint32_t clipped = bitsOf(left == set(kNeedsClipping)) & here;
  TileRanges ranges;
  const std::uint32_t seen = tilesOfSixteen(frame, left, min(y[0], min(y[1], y[2])), max(x[0], max(x[1], x[2])),
                                            max(y[0], max(y[1], y[2])), ranges);
  const std::uint32_t number = jobNumber << kJobBits | first;
  const std::uint32_t binned = (seen | clipped) & here;
  std::uint32_t single = ranges.single & here & ~clipped;
  if (HWY_UNLIKELY(draw.surface == VITRAIL_CPU_OPAQUE && single != binned)) single = 0; // one by one
  for (std::uint32_t lanes = single; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
    bins.add(static_cast<std::uint32_t>(ranges.first[lane]), number + lane);
  }
  for (std::uint32_t lanes = binned & ~single; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
    if (HWY_UNLIKELY((clipped >> lane & 1U) != 0)) {
      binPieces(frame, info, job.first + first + lane, number + lane, bins);
    } else {
      addTo(bins, frame, {ranges.x0[lane], ranges.y0[lane], ranges.x1[lane], ranges.y1[lane]}, number + lane);
    }
  }
  if (nearest == nullptr) return;
  const bool nearestIsOne = frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
  const F known = nearestOfDepths(z[0], z[1], z[2], nearestIsOne);
  const F depth = select(maskOf(clipped), set(nearestIsOne ? 1.0F : 0.0F), known);
  if (HWY_LIKELY(count == kLanes)) { // a copy by way of memory would read in parts what was stored as a whole, and wait
    storeAnywhere(nearest, depth);
    return;
  }
  alignas(64) float depths[kLanes];
  store(depths, depth);
  std::memcpy(nearest, depths, count * sizeof(float));
}

inline void binJob(Frame& frame, std::uint32_t jobNumber, ThreadBins& threadBins) {
  const Job& job = frame.jobs[jobNumber];
  const DrawInfo& info = frame.draws[job.draw];
  const VitrailCpuDraw& draw = info.draw;
  Bins& bins = draw.surface == VITRAIL_CPU_OPAQUE ? threadBins.opaque : threadBins.transparent;
  const bool isOrdered = !frame.nearest.empty() && draw.surface == VITRAIL_CPU_TRANSPARENT;
  float* const nearest = isOrdered ? frame.nearest.data() + job.firstNearest : nullptr;
  if (draw.topology != VITRAIL_CPU_TRIANGLES) {
    for (std::uint32_t i = 0; i < job.count; ++i) {
      binPieces(frame, info, job.first + i, jobNumber << kJobBits | i, bins);
    }
    const bool nearestIsOne = frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
    if (nearest != nullptr) std::fill_n(nearest, job.count, nearestIsOne ? 1.0F : 0.0F);
    return;
  }
  for (std::uint32_t i = 0; i < job.count; i += kLanes) {
    const std::uint32_t count = std::min<std::uint32_t>(kLanes, job.count - i);
    binSixteen(frame, info, jobNumber, i, count, nearest == nullptr ? nullptr : nearest + i, bins);
  }
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
