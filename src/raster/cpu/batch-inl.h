// Up to 64 triangles of one tile, set up sixteen at a time. From here on a tile is 32 x 32 pixels whose first has its
// centre at (0, 0).
#if defined(VITRAIL_BATCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_BATCH_INL_H
#undef VITRAIL_BATCH_INL_H
#else
#define VITRAIL_BATCH_INL_H
#endif

#include "raster/cpu/frame.h"
#include "raster/cpu/geometry-inl.h"
#include "raster/cpu/lanes-inl.h"
#include "raster/cpu/store-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

constexpr std::uint32_t kBatch = 64;
constexpr std::uint32_t kFrontBit = 0x80000000U; // beside a triangle's number: it shows its front

// Triangles that are about to be set up: where their corners are, which primitives they are of, and of which draws.
struct Staged {
  const Corner* corners[3][kBatch];
  alignas(64) std::int32_t number[kBatch];
  alignas(64) std::int32_t draw[kBatch];
  alignas(64) std::int32_t cull[kBatch]; // 1: if it shows its back, 2: if it shows its front
  std::uint32_t count = 0;
};

// What clipping, lines and points leave: triangles whose corners are weights of the primitive's.
struct StagedPieces : Staged {
  Corner place[3][kBatch];
  float second[3][kBatch];
  float third[3][kBatch];
};

// Columns, an entry a triangle. A triangle covers a pixel's sample where all three a * x + b * y + c are not negative;
// its weights at a pixel's centre are (a * x + b * y + weightC) * scale + offset, and its depth there is
// (x - fromX) * right + (y - fromY) * down + from, or where it is careful what the weights make of its corners' depths.
struct Batch {
  const std::int32_t* draw;                 // the host's number, or that in TileColors
  const StagedPieces* pieces;               // null: whole triangles
  alignas(64) std::int32_t number[kBatch];  // with kFrontBit
  alignas(64) std::int32_t big[kBatch];     // not 0: edges need more than 16 bits
  alignas(64) std::int32_t careful[kBatch]; // not 0: its depth as a plane could be too far off (setUpDepth())

  alignas(64) std::int32_t a[3][kBatch];
  alignas(64) std::int32_t b[3][kBatch];
  alignas(64) std::int32_t ab[3][kBatch]; // a and b in 16 bits each
  alignas(64) std::int32_t c[kMaxSamples][3][kBatch];
  alignas(64) std::int32_t weightC[2][kBatch]; // of edges 1 and 2
  alignas(64) float scale[kBatch];
  alignas(64) float offset[2][kBatch];
  alignas(64) double exactC[2][kBatch]; // the same where numbers are too large for 32 bits: undivided
  alignas(64) double inverseArea[kBatch];
  // Depth and 1 / w, of which only the proportions matter: at corner 0, and from there to corners 1 and 2.
  alignas(64) float z[3][kBatch];
  alignas(64) float w[3][kBatch];
  alignas(64) float from[kBatch];
  alignas(64) float fromX[kBatch];
  alignas(64) float fromY[kBatch];
  alignas(64) float right[kBatch];
  alignas(64) float down[kBatch];
  alignas(64) float w1[kBatch]; // at corners 1 and 2
  alignas(64) float w2[kBatch];
  alignas(64) float leastW[kBatch];                   // how near to 0 it comes at pixels' centres
  alignas(64) float sampleDepth[kMaxSamples][kBatch]; // from a pixel's centre to a sample
  alignas(64) std::int32_t x0[kBatch];                // blocks; x1 is -1: none
  alignas(64) std::int32_t x1[kBatch];
  alignas(64) std::int32_t y0[kBatch];
  alignas(64) std::int32_t y1[kBatch];
  bool isBig = false; // some triangle's edges need more than 16 bits
};

HWY_INLINE D exactly(const I& x) { return toDouble(x); }

// floor((c - (owned ? 0 : 1)) / 256), within 31 bits: beyond, its sign is the same all over the tile.
HWY_INLINE I stepsOf(const D& c, const M& owned) {
  const D biased = c + exactly(select(owned, set(0), set(-1)));
  const D limit = setDouble((1 << 30) - 1);
  const D low = setDouble(-((1 << 30) - 1));
  return toInt(min(max(floorOf(biased * setDouble(1.0 / 256.0)), low), limit));
}

struct SetUp {
  I a[3];
  I b[3];
  D exactA[3]; // the same
  D exactB[3];
  D c[3];
  M owned[3];
  D inverseArea;
};

HWY_INLINE void setUpWeights(Batch& batch, std::uint32_t at, const SetUp& s) {
  const F scale = toFloat(s.inverseArea * setDouble(256.0));
  store(batch.scale + at, scale);
  for (std::size_t k = 0; k < 2; ++k) {
    const D& c = s.c[k + 1];
    const D limit = setDouble((1 << 30) - 1);
    const D low = setDouble(-((1 << 30) - 1));
    const D steps = min(max(floorOf(c * setDouble(1.0 / 256.0)), low), limit);
    store(batch.weightC[k] + at, toInt(steps));
    store(batch.offset[k] + at, toFloat((c - steps * setDouble(256.0)) * s.inverseArea));
    for (std::size_t i = 0; i < 2 * kVectors; ++i) hn::Store(c.v[i], kD, batch.exactC[k] + at + i * kKeyLanes);
  }
  for (std::size_t i = 0; i < 2 * kVectors; ++i)
    hn::Store(s.inverseArea.v[i], kD, batch.inverseArea + at + i * kKeyLanes);
}

// Returns whether some pixel or sample of the tile may be covered, and stores what decides it.
HWY_INLINE M setUpEdges(Batch& batch, std::uint32_t at, const SetUp& s, std::uint32_t samples) {
  const I zero = set(0);
  I rejected = zero;
  for (std::size_t k = 0; k < 3; ++k) {
    I most = set(INT32_MIN);
    for (std::uint32_t sample = 0; sample < samples; ++sample) {
      const SamplePlace place = samplePlaces(samples)[sample];
      const std::int32_t x = place.x * (kSubpixels / 16) - kSubpixels / 2;
      const std::int32_t y = place.y * (kSubpixels / 16) - kSubpixels / 2;
      D c = s.c[k];
      if (samples > 1) c = c + s.exactA[k] * setDouble(x) + s.exactB[k] * setDouble(y);
      const I steps = stepsOf(c, s.owned[k]);
      store(batch.c[sample][k] + at, steps);
      most = max(most, steps);
    }
    store(batch.a[k] + at, s.a[k]);
    store(batch.b[k] + at, s.b[k]);
    store(batch.ab[k] + at, (s.a[k] & set(0xffff)) | shiftLeft<16>(s.b[k]));
    rejected =
        rejected | (most + (max(s.a[k], zero) + max(s.b[k], zero)) * set(static_cast<std::int32_t>(kTileSide) - 1));
  }
  return ~(zero > rejected);
}

// Depth as a plane, from the pixel that is nearest to corner 0. What it rounds is at most 2^-24 of the largest depth
// and of how much the plane changes from there to the pixel, a few times; where that could be more than the 2^-22 of
// the largest depth that cpu.h promises (thin triangles, and such as go far into the picture) it is a careful one;
// returns which. Nothing of it depends on the tile.
HWY_INLINE M setUpDepth(Batch& batch, std::uint32_t at, const I* x, const I* y, const F* z, const SetUp& s,
                        std::uint32_t samples) {
  const I fromX = shiftRight<kSubpixelBits>(x[0] + set(kSubpixels / 2));
  const I fromY = shiftRight<kSubpixelBits>(y[0] + set(kSubpixels / 2));
  const D toX = exactly(fromX) * setDouble(kSubpixels);
  const D toY = exactly(fromY) * setDouble(kSubpixels);
  const D first = toDouble(z[0]);
  D from = setDouble(0.0);
  D right = setDouble(0.0);
  D down = setDouble(0.0);
  for (std::size_t k = 1; k < 3; ++k) {
    const D change = toDouble(z[k]) - first;
    from = from + (s.exactA[k] * toX + s.exactB[k] * toY + s.c[k]) * change;
    right = right + s.exactA[k] * change;
    down = down + s.exactB[k] * change;
  }
  const D perPixel = s.inverseArea * setDouble(kSubpixels);
  const F rightward = toFloat(right * perPixel);
  const F downward = toFloat(down * perPixel);
  store(batch.from + at, toFloat(from * s.inverseArea + first));
  store(batch.fromX + at, toFloat(fromX));
  store(batch.fromY + at, toFloat(fromY));
  store(batch.right + at, rightward);
  store(batch.down + at, downward);
  for (std::uint32_t sample = 0; samples > 1 && sample < samples; ++sample) {
    const SamplePlace place = samplePlaces(samples)[sample];
    const F toRight = set(static_cast<float>(place.x - 8) / 16.0F);
    const F toBottom = set(static_cast<float>(place.y - 8) / 16.0F);
    store(batch.sampleDepth[sample] + at, fma(rightward, toRight, downward * toBottom));
  }
  // The extent in pixels, and one.
  const F pixels = set(1.0F / static_cast<float>(kSubpixels));
  const F one = set(1.0F);
  const F width = fma(toFloat(max(x[0], max(x[1], x[2])) - min(x[0], min(x[1], x[2]))), pixels, one);
  const F height = fma(toFloat(max(y[0], max(y[1], y[2])) - min(y[0], min(y[1], y[2]))), pixels, one);
  const F zero = set(0.0F);
  const F change = fma(max(rightward, zero - rightward), width, max(downward, zero - downward) * height);
  const M careful = change > max(z[0], max(z[1], z[2])) * set(0.4F);
  store(batch.careful + at, keep(careful, set(1)));
  return careful;
}

// Where some samples of a pixel are covered its centre may lie outside: how near to 0 its 1 / w comes, as a part of
// that of the farthest corner.
constexpr float kBeyondCorners = 1.0F / 1024.0F;

HWY_INLINE void setUpPerspective(Batch& batch, std::uint32_t at, const F* inverseW, std::uint32_t samples) {
  // Times a power of two, so that the largest is at least 1 and below 2: products of the smallest and the largest w
  // that there are have no place in a float. What is less than 2^-60 of the largest decides nothing farther from its
  // corner than that.
  const F most = max(inverseW[0], max(inverseW[1], inverseW[2]));
  const F scale = floatOf(set(254 << 23) - (bitsOf(most) & set(0xff << 23)));
  F w[3];
  for (std::size_t i = 0; i < 3; ++i) w[i] = max(inverseW[i] * scale, set(0x1.0p-60F));
  const F least = min(w[0], min(w[1], w[2]));
  store(batch.leastW + at, samples == 1 ? least : least * set(kBeyondCorners));
  store(batch.w[0] + at, w[0]);
  store(batch.w[1] + at, w[1] - w[0]);
  store(batch.w[2] + at, w[2] - w[0]);
  store(batch.w1 + at, w[1]);
  store(batch.w2 + at, w[2]);
}

// A key that is nearer than those of all that sixteen triangles cover.
HWY_INLINE I nearestOf(const Batch& batch, std::uint32_t at, bool nearestIsOne) {
  const F z = load(batch.z[0] + at);
  return keyOf(nearestOfDepths(z, z + load(batch.z[1] + at), z + load(batch.z[2] + at), nearestIsOne), nearestIsOne);
}

// Sixteen triangles from entry `at` on; of those that need clipping nothing comes: returns which they are, a bit each.
// `weights`: they are shaded.
HWY_INLINE std::uint32_t setUpSixteen(Batch& batch, const Staged& staged, std::uint32_t at, const TileBox& tile,
                                      std::uint32_t samples, bool weights) {
  I x[3];
  I y[3];
  F z[3];
  F w[3];
  D exactX[3];
  D exactY[3];
  M unclipped = maskOf(0xffff);
  for (std::size_t i = 0; i < 3; ++i) {
    F column[2];
    const Corner* const* corners = staged.corners[i] + at;
    loadFours([corners](std::size_t lane) { return reinterpret_cast<const float*>(corners[lane]); }, column[0],
              column[1], z[i], w[i]);
    unclipped = andNot(bitsOf(column[0]) == set(kNeedsClipping), unclipped);
    x[i] = bitsOf(column[0]) - set(tile.x * kSubpixels + kSubpixels / 2);
    y[i] = bitsOf(column[1]) - set(tile.y * kSubpixels + kSubpixels / 2);
    exactX[i] = exactly(x[i]);
    exactY[i] = exactly(y[i]);
  }
  SetUp s;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t p = (k + 1) % 3;
    const std::size_t q = (k + 2) % 3;
    s.a[k] = y[p] - y[q];
    s.b[k] = x[q] - x[p];
    s.exactA[k] = exactY[p] - exactY[q];
    s.exactB[k] = exactX[q] - exactX[p];
    s.c[k] = setDouble(0.0) - (s.exactA[k] * exactX[p] + s.exactB[k] * exactY[p]);
  }
  const D area = s.exactA[0] * exactX[0] + s.exactB[0] * exactY[0] + s.c[0];
  const I zero = set(0);
  const F rounded = toFloat(area);
  const M isFront = set(0.0F) > rounded;
  const M isEmpty = rounded == set(0.0F);
  const D signs = exactly(select(isFront, set(-1), set(1)));
  M isBig = maskOf(0);
  for (std::size_t k = 0; k < 3; ++k) {
    s.a[k] = select(isFront, zero - s.a[k], s.a[k]);
    s.b[k] = select(isFront, zero - s.b[k], s.b[k]);
    s.exactA[k] = s.exactA[k] * signs;
    s.exactB[k] = s.exactB[k] * signs;
    s.c[k] = s.c[k] * signs;
    s.owned[k] = (s.a[k] > zero) | ((s.a[k] == zero) & (s.b[k] > zero));
    isBig = isBig | (s.a[k] > set(32767)) | (set(-32768) > s.a[k]) | (s.b[k] > set(32767)) | (set(-32768) > s.b[k]);
  }
  s.inverseArea = setDouble(1.0) / max(area * signs, setDouble(1.0));
  const I cull = load(staged.cull + at);
  const M culled = select(isFront, cull & set(2), cull & set(1)) > zero;
  const M touched = setUpEdges(batch, at, s, samples);
  // The pixels whose samples the triangle's box may hold, in blocks.
  const std::int32_t reach = samples == 1 ? 0 : kSubpixels / 2 - sampleMargin(samples);
  const I up = set(kSubpixels - 1 - reach);
  const I x0 = max(shiftRight<8>(min(x[0], min(x[1], x[2])) + up), zero);
  const I y0 = max(shiftRight<8>(min(y[0], min(y[1], y[2])) + up), zero);
  const I x1 = min(shiftRight<8>(max(x[0], max(x[1], x[2])) + set(reach)), set(tile.lastX));
  const I y1 = min(shiftRight<8>(max(y[0], max(y[1], y[2])) + set(reach)), set(tile.lastY));
  const M kept = andNot(isEmpty | culled | (x0 > x1) | (y0 > y1), touched & unclipped);
  store(batch.x0 + at, keep(kept, shiftRight<2>(x0)));
  store(batch.y0 + at, keep(kept, shiftRight<2>(y0)));
  store(batch.x1 + at, select(kept, shiftRight<2>(x1), set(-1)));
  store(batch.y1 + at, keep(kept, shiftRight<2>(y1)));
  store(batch.big + at, keep(isBig, set(1)));
  batch.isBig = batch.isBig || !none(kept & isBig);
  const M careful = setUpDepth(batch, at, x, y, z, s, samples);
  store(batch.z[0] + at, z[0]);
  store(batch.z[1] + at, z[1] - z[0]);
  store(batch.z[2] + at, z[2] - z[0]);
  if (weights) setUpPerspective(batch, at, w, samples);
  if (weights || !none(kept & careful)) setUpWeights(batch, at, s);
  store(batch.number + at, load(staged.number + at) | keep(isFront, set(static_cast<std::int32_t>(kFrontBit))));
  return ~bitsOf(unclipped) & 0xffffU;
}

// Weights of the second and third corner at a block's pixels, `position` of kBlockLanes, straight on the picture.
template <bool kPlain = false>
HWY_INLINE void weightsAt(const Batch& batch, std::uint32_t t, const I& position, F& second, F& third) {
  F* weights[2] = {&second, &third};
  for (std::size_t k = 0; k < 2; ++k) {
    if (kPlain || HWY_LIKELY(batch.big[t] == 0)) {
      const I e = multiplyHalves(set(batch.weightC[k][t]), set(batch.ab[k + 1][t]), position);
      *weights[k] = fma(toFloat(e), set(batch.scale[t]), set(batch.offset[k][t]));
    } else {
      const I x = position & set(0xffff);
      const I y = shiftRight<16>(position);
      const D e =
          setDouble(batch.exactC[k][t]) +
          (setDouble(batch.a[k + 1][t]) * exactly(x) + setDouble(batch.b[k + 1][t]) * exactly(y)) * setDouble(256.0);
      *weights[k] = toFloat(e * setDouble(batch.inverseArea[t]));
    }
  }
}

HWY_INLINE F planeAt(const Batch& batch, std::uint32_t t, const F& placeX, const F& placeY) {
  return fma(placeX - set(batch.fromX[t]), set(batch.right[t]),
             fma(placeY - set(batch.fromY[t]), set(batch.down[t]), set(batch.from[t])));
}

// Depth at a block's pixels, whose places in the tile `place` has.
HWY_INLINE F depthAt(const Batch& batch, std::uint32_t t, const I& position, const F& placeX, const F& placeY) {
  if (HWY_LIKELY(batch.careful[t] == 0)) return planeAt(batch, t, placeX, placeY);
  F second;
  F third;
  weightsAt(batch, t, position, second, third);
  return fma(third, set(batch.z[2][t]), fma(second, set(batch.z[1][t]), set(batch.z[0][t])));
}

// Of a careful one depth at a sample of the block's pixels, from the weights there: a pixel's centre may lie so far
// outside that a step from its depth would round more than is promised.
HWY_NOINLINE inline F carefulDepthAt(const Batch& batch, std::uint32_t t, const I& position, const SamplePlace& place) {
  constexpr double kStep = kSubpixels / 16.0; // of sample places, which are from the pixel's corner on
  constexpr double kHalf = kSubpixels / 2.0;
  const D x = exactly(position & set(0xffff)) * setDouble(kSubpixels) + setDouble(place.x * kStep - kHalf);
  const D y = exactly(shiftRight<16>(position)) * setDouble(kSubpixels) + setDouble(place.y * kStep - kHalf);
  F weights[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const D e = setDouble(batch.exactC[k][t]) + (setDouble(batch.a[k + 1][t]) * x + setDouble(batch.b[k + 1][t]) * y);
    weights[k] = toFloat(e * setDouble(batch.inverseArea[t]));
  }
  return fma(weights[1], set(batch.z[2][t]), fma(weights[0], set(batch.z[1][t]), set(batch.z[0][t])));
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
