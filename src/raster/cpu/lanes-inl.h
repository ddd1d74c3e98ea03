// Sixteen lanes, a block of 4 x 4 pixels, however many vectors of the target that takes. The only file that knows how
// wide vectors are. Included once for each target (Highway's foreach_target).
#if defined(VITRAIL_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_LANES_INL_H
#undef VITRAIL_LANES_INL_H
#else
#define VITRAIL_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kLanes = 16;
using TagF = hn::CappedTag<float, kLanes>;
using TagI = hn::RebindToSigned<TagF>;
using TagU = hn::RebindToUnsigned<TagF>;
using TagS = hn::Repartition<std::int16_t, TagI>;
using TagD = hn::Repartition<double, TagF>;
using TagL = hn::Repartition<std::uint64_t, TagF>;
constexpr std::size_t kVectorLanes = hn::MaxLanes(TagF());
constexpr std::size_t kVectors = kLanes / kVectorLanes;
constexpr TagF kF;
constexpr TagI kI;
constexpr TagU kU;
constexpr TagD kD;

#define VITRAIL_EACH for (std::size_t i = 0; i < kVectors; ++i)

struct F { // floats
  hn::Vec<TagF> v[kVectors];
};
struct I { // 32-bit signed integers
  hn::Vec<TagI> v[kVectors];
};
struct M { // masks
  hn::Mask<TagF> v[kVectors];
};
struct D { // doubles: twice as many vectors, in the order of lanes
  hn::Vec<TagD> v[2 * kVectors];
};

#define VITRAIL_UNARY(R, A, name, expression) \
  HWY_INLINE R name(const A& a) {             \
    R r;                                      \
    VITRAIL_EACH r.v[i] = expression;         \
    return r;                                 \
  }
#define VITRAIL_BINARY(R, A, B, name, expression) \
  HWY_INLINE R name(const A& a, const B& b) {     \
    R r;                                          \
    VITRAIL_EACH r.v[i] = expression;             \
    return r;                                     \
  }
#define VITRAIL_TERNARY(R, A, B, C, name, expression)     \
  HWY_INLINE R name(const A& a, const B& b, const C& c) { \
    R r;                                                  \
    VITRAIL_EACH r.v[i] = expression;                     \
    return r;                                             \
  }

HWY_INLINE F set(float x) {
  F r;
  VITRAIL_EACH r.v[i] = hn::Set(kF, x);
  return r;
}
HWY_INLINE I set(std::int32_t x) {
  I r;
  VITRAIL_EACH r.v[i] = hn::Set(kI, x);
  return r;
}
// From memory that is aligned to 64 bytes.
HWY_INLINE F load(const float* p) {
  F r;
  VITRAIL_EACH r.v[i] = hn::Load(kF, p + i * kVectorLanes);
  return r;
}
HWY_INLINE I load(const std::int32_t* p) {
  I r;
  VITRAIL_EACH r.v[i] = hn::Load(kI, p + i * kVectorLanes);
  return r;
}
HWY_INLINE void store(float* p, const F& a) { VITRAIL_EACH hn::Store(a.v[i], kF, p + i * kVectorLanes); }
HWY_INLINE void store(std::int32_t* p, const I& a) { VITRAIL_EACH hn::Store(a.v[i], kI, p + i * kVectorLanes); }
// At any address.
HWY_INLINE void storeAnywhere(float* p, const F& a) { VITRAIL_EACH hn::StoreU(a.v[i], kF, p + i * kVectorLanes); }

VITRAIL_BINARY(F, F, F, operator+, hn::Add(a.v[i], b.v[i]))
VITRAIL_BINARY(F, F, F, operator-, hn::Sub(a.v[i], b.v[i]))
VITRAIL_BINARY(F, F, F, operator*, hn::Mul(a.v[i], b.v[i]))
VITRAIL_BINARY(F, F, F, operator/, hn::Div(a.v[i], b.v[i]))
VITRAIL_BINARY(F, F, F, min, hn::Min(a.v[i], b.v[i]))
VITRAIL_BINARY(F, F, F, max, hn::Max(a.v[i], b.v[i]))
VITRAIL_TERNARY(F, F, F, F, fma, hn::MulAdd(a.v[i], b.v[i], c.v[i]))
VITRAIL_TERNARY(F, F, F, F, fnma, hn::NegMulAdd(a.v[i], b.v[i], c.v[i]))
VITRAIL_BINARY(M, F, F, operator>=, hn::Ge(a.v[i], b.v[i]))
VITRAIL_BINARY(M, F, F, operator>, hn::Gt(a.v[i], b.v[i]))
VITRAIL_BINARY(M, F, F, operator==, hn::Eq(a.v[i], b.v[i]))
VITRAIL_TERNARY(F, M, F, F, select, hn::IfThenElse(a.v[i], b.v[i], c.v[i]))
VITRAIL_BINARY(F, M, F, keep, hn::IfThenElseZero(a.v[i], b.v[i]))

VITRAIL_BINARY(I, I, I, operator+, hn::Add(a.v[i], b.v[i]))
VITRAIL_BINARY(I, I, I, operator-, hn::Sub(a.v[i], b.v[i]))
VITRAIL_BINARY(I, I, I, operator*, hn::Mul(a.v[i], b.v[i]))
VITRAIL_BINARY(I, I, I, operator&, hn::And(a.v[i], b.v[i]))
VITRAIL_BINARY(I, I, I, operator|, hn::Or(a.v[i], b.v[i]))
VITRAIL_BINARY(I, I, I, operator^, hn::Xor(a.v[i], b.v[i]))
VITRAIL_BINARY(I, I, I, min, hn::Min(a.v[i], b.v[i]))
VITRAIL_BINARY(I, I, I, max, hn::Max(a.v[i], b.v[i]))
VITRAIL_BINARY(M, I, I, operator>, hn::RebindMask(kF, hn::Gt(a.v[i], b.v[i])))
VITRAIL_BINARY(M, I, I, operator==, hn::RebindMask(kF, hn::Eq(a.v[i], b.v[i])))
VITRAIL_TERNARY(I, M, I, I, select, hn::IfThenElse(hn::RebindMask(kI, a.v[i]), b.v[i], c.v[i]))
VITRAIL_BINARY(I, M, I, keep, hn::IfThenElseZero(hn::RebindMask(kI, a.v[i]), b.v[i]))

VITRAIL_BINARY(M, M, M, operator&, hn::And(a.v[i], b.v[i]))
VITRAIL_BINARY(M, M, M, operator|, hn::Or(a.v[i], b.v[i]))
VITRAIL_BINARY(M, M, M, andNot, hn::AndNot(a.v[i], b.v[i])) // not a, and b
VITRAIL_UNARY(M, M, operator~, hn::Not(a.v[i]))

VITRAIL_UNARY(I, F, bitsOf, hn::BitCast(kI, a.v[i]))
VITRAIL_UNARY(F, I, floatOf, hn::BitCast(kF, a.v[i]))
VITRAIL_UNARY(F, I, toFloat, hn::ConvertTo(kF, a.v[i]))

template <int kBits>
HWY_INLINE I shiftLeft(const I& a) {
  I r;
  VITRAIL_EACH r.v[i] = hn::ShiftLeft<kBits>(a.v[i]);
  return r;
}
template <int kBits>
HWY_INLINE I shiftRight(const I& a) { // keeps the sign
  I r;
  VITRAIL_EACH r.v[i] = hn::ShiftRight<kBits>(a.v[i]);
  return r;
}

// A bit a lane.
HWY_INLINE std::uint32_t bitsOf(const M& m) {
#if HWY_TARGET == HWY_AVX3
  return _cvtmask16_u32(m.v[0].raw);
#elif HWY_TARGET == HWY_AVX2
  const int low = _mm256_movemask_ps(hn::VecFromMask(kF, m.v[0]).raw);
  const int high = _mm256_movemask_ps(hn::VecFromMask(kF, m.v[1]).raw);
  return static_cast<std::uint32_t>(low | high << 8);
#else
  std::uint32_t bits = 0;
  VITRAIL_EACH {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(kF, m.v[i], bytes);
    bits |= static_cast<std::uint32_t>(bytes[0]) << (i * kVectorLanes);
  }
  return bits;
#endif
}
// Of the signs of integers.
HWY_INLINE std::uint32_t signsOf(const I& a) {
#if HWY_TARGET == HWY_AVX3
  return _cvtmask16_u32(_mm512_movepi32_mask(a.v[0].raw));
#elif HWY_TARGET == HWY_AVX2
  const int low = _mm256_movemask_ps(_mm256_castsi256_ps(a.v[0].raw));
  const int high = _mm256_movemask_ps(_mm256_castsi256_ps(a.v[1].raw));
  return static_cast<std::uint32_t>(low | high << 8);
#else
  return bitsOf(set(0) > a);
#endif
}

alignas(64) inline constexpr std::int32_t kLaneBits[kLanes] = {1,   2,   4,    8,    16,   32,   64,    128,
                                                               256, 512, 1024, 2048, 4096, 8192, 16384, 32768};

HWY_INLINE M maskOf(std::uint32_t bits) {
  M m;
#if HWY_TARGET == HWY_AVX3
  m.v[0] = hn::Mask<TagF>{static_cast<__mmask16>(bits)};
#else
  const hn::Vec<TagI> all = hn::Set(kI, static_cast<std::int32_t>(bits));
  VITRAIL_EACH m.v[i] = hn::RebindMask(kF, hn::TestBit(all, hn::Load(kI, kLaneBits + i * kVectorLanes)));
#endif
  return m;
}

HWY_INLINE bool none(const M& m) {
  hn::Mask<TagF> any = m.v[0];
  for (std::size_t i = 1; i < kVectors; ++i) any = hn::Or(any, m.v[i]);
  return hn::AllFalse(kF, any);
}
HWY_INLINE bool all(const M& m) {
  hn::Mask<TagF> every = m.v[0];
  for (std::size_t i = 1; i < kVectors; ++i) every = hn::And(every, m.v[i]);
  return hn::AllTrue(kF, every);
}

// The floats at places of an array.
HWY_INLINE F gather(const float* from, const I& at) {
  F r;
  VITRAIL_EACH r.v[i] = hn::GatherIndex(kF, from, at.v[i]);
  return r;
}

// Up to how many floats lookUpFloats() finds without memory: 0 where it is no faster than memory.
#if HWY_TARGET == HWY_AVX3
constexpr std::size_t kLookedUp = 64;
#else
constexpr std::size_t kLookedUp = 0;
#endif
// The floats at places, below `count`, of a table of kLookedUp.
HWY_INLINE F lookUpFloats(const float* table, const I& at, std::size_t count) {
#if HWY_TARGET == HWY_AVX3
  F r;
  const auto quarter = [table](std::size_t i) HWY_ATTR { return _mm512_load_ps(table + 16 * i); };
  r.v[0].raw = _mm512_permutex2var_ps(quarter(0), at.v[0].raw, quarter(1));
  if (count > 32) {
    const __m512 upper = _mm512_permutex2var_ps(quarter(2), at.v[0].raw, quarter(3));
    r.v[0].raw = _mm512_mask_blend_ps(_mm512_cmpgt_epi32_mask(at.v[0].raw, _mm512_set1_epi32(31)), r.v[0].raw, upper);
  }
  return r;
#else
  static_cast<void>(count);
  return gather(table, at);
#endif
}

HWY_INLINE std::int32_t sumOf(const I& a) {
  hn::Vec<TagI> sum = a.v[0];
  for (std::size_t i = 1; i < kVectors; ++i) sum = hn::Add(sum, a.v[i]);
  return hn::GetLane(hn::SumOfLanes(kI, sum));
}
HWY_INLINE float mostOf(const F& a) {
  hn::Vec<TagF> most = a.v[0];
  for (std::size_t i = 1; i < kVectors; ++i) most = hn::Max(most, a.v[i]);
  return hn::GetLane(hn::MaxOfLanes(kF, most));
}
HWY_INLINE float leastOf(const F& a) {
  hn::Vec<TagF> least = a.v[0];
  for (std::size_t i = 1; i < kVectors; ++i) least = hn::Min(least, a.v[i]);
  return hn::GetLane(hn::MinOfLanes(kF, least));
}
HWY_INLINE std::int32_t mostOf(const I& a) {
  hn::Vec<TagI> most = a.v[0];
  for (std::size_t i = 1; i < kVectors; ++i) most = hn::Max(most, a.v[i]);
  return hn::GetLane(hn::MaxOfLanes(kI, most));
}

// acc + a's lower half * b's lower half + a's upper half * b's upper half, halves of 16 bits.
HWY_INLINE I multiplyHalves(const I& acc, const I& a, const I& b) {
  I r;
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_SSE4
  VITRAIL_EACH {
    hn::Vec<TagI> unused = hn::Zero(kI);
    r.v[i] =
        hn::ReorderWidenMulAccumulate(kI, hn::BitCast(TagS(), a.v[i]), hn::BitCast(TagS(), b.v[i]), acc.v[i], unused);
  }
#else
  r = acc + shiftRight<16>(shiftLeft<16>(a)) * shiftRight<16>(shiftLeft<16>(b)) + shiftRight<16>(a) * shiftRight<16>(b);
#endif
  return r;
}

// ---- Doubles

HWY_INLINE D setDouble(double x) {
  D r;
  for (auto& v : r.v) v = hn::Set(kD, x);
  return r;
}
HWY_INLINE D toDouble(const I& a) {
  D r;
  const hn::Half<TagI> half;
  VITRAIL_EACH {
    r.v[2 * i] = hn::PromoteTo(kD, hn::LowerHalf(half, a.v[i]));
    r.v[2 * i + 1] = hn::PromoteTo(kD, hn::UpperHalf(half, a.v[i]));
  }
  return r;
}
HWY_INLINE D toDouble(const F& a) {
  D r;
  const hn::Half<TagF> half;
  VITRAIL_EACH {
    r.v[2 * i] = hn::PromoteTo(kD, hn::LowerHalf(half, a.v[i]));
    r.v[2 * i + 1] = hn::PromoteTo(kD, hn::UpperHalf(half, a.v[i]));
  }
  return r;
}
HWY_INLINE F toFloat(const D& a) {
  F r;
  const hn::Half<TagF> half;
  VITRAIL_EACH r.v[i] = hn::Combine(kF, hn::DemoteTo(half, a.v[2 * i + 1]), hn::DemoteTo(half, a.v[2 * i]));
  return r;
}
// Of numbers within the range.
HWY_INLINE I toInt(const F& a) {
  I r;
  VITRAIL_EACH r.v[i] = hn::ConvertTo(kI, a.v[i]);
  return r;
}
HWY_INLINE I toInt(const D& a) {
  I r;
  const hn::Half<TagI> half;
  VITRAIL_EACH r.v[i] = hn::Combine(kI, hn::DemoteTo(half, a.v[2 * i + 1]), hn::DemoteTo(half, a.v[2 * i]));
  return r;
}
#define VITRAIL_DOUBLES(name, expression)                               \
  HWY_INLINE D name(const D& a, const D& b) {                           \
    D r;                                                                \
    for (std::size_t i = 0; i < 2 * kVectors; ++i) r.v[i] = expression; \
    return r;                                                           \
  }
VITRAIL_DOUBLES(operator+, hn::Add(a.v[i], b.v[i]))
VITRAIL_DOUBLES(operator-, hn::Sub(a.v[i], b.v[i]))
VITRAIL_DOUBLES(operator*, hn::Mul(a.v[i], b.v[i]))
VITRAIL_DOUBLES(operator/, hn::Div(a.v[i], b.v[i]))
VITRAIL_DOUBLES(min, hn::Min(a.v[i], b.v[i]))
VITRAIL_DOUBLES(max, hn::Max(a.v[i], b.v[i]))
HWY_INLINE D floorOf(const D& a) {
  D r;
  for (std::size_t i = 0; i < 2 * kVectors; ++i) r.v[i] = hn::Floor(a.v[i]);
  return r;
}

// ---- Four values a lane, side by side in memory

// The first four floats of what each of sixteen pointers names: `at(l)` is that of lane l. Four vectors, one a value.
template <class At>
HWY_INLINE void loadFours(At at, F& x, F& y, F& z, F& w) {
  const hn::FixedTag<float, 4> four;
  const hn::Repartition<double, TagF> pairs;
  VITRAIL_EACH {
    hn::Vec<TagF> column[4]; // block b of column c: lane 4 b + c
    for (std::size_t c = 0; c < 4; ++c) {
      const std::size_t first = i * kVectorLanes + c;
#if HWY_MAX_BYTES == 16
      column[c] = hn::LoadU(four, at(first));
#elif HWY_MAX_BYTES == 32
      column[c] = hn::Combine(kF, hn::LoadU(four, at(first + 4)), hn::LoadU(four, at(first)));
#else
      const hn::FixedTag<float, 8> eight;
      const auto low = hn::Combine(eight, hn::LoadU(four, at(first + 4)), hn::LoadU(four, at(first)));
      const auto high = hn::Combine(eight, hn::LoadU(four, at(first + 12)), hn::LoadU(four, at(first + 8)));
      column[c] = hn::Combine(kF, high, low);
#endif
    }
    const auto xy01 = hn::BitCast(pairs, hn::InterleaveLower(kF, column[0], column[1]));
    const auto zw01 = hn::BitCast(pairs, hn::InterleaveUpper(kF, column[0], column[1]));
    const auto xy23 = hn::BitCast(pairs, hn::InterleaveLower(kF, column[2], column[3]));
    const auto zw23 = hn::BitCast(pairs, hn::InterleaveUpper(kF, column[2], column[3]));
    x.v[i] = hn::BitCast(kF, hn::InterleaveLower(pairs, xy01, xy23));
    y.v[i] = hn::BitCast(kF, hn::InterleaveUpper(pairs, xy01, xy23));
    z.v[i] = hn::BitCast(kF, hn::InterleaveLower(pairs, zw01, zw23));
    w.v[i] = hn::BitCast(kF, hn::InterleaveUpper(pairs, zw01, zw23));
  }
}

// Where lane l's four are among the sixteen that storeFours() writes.
constexpr std::size_t placeOfFour(std::size_t lane) {
  constexpr std::size_t kBlocks = kVectorLanes / 4;
  const std::size_t inVector = lane % kVectorLanes;
  return lane - inVector + inVector % 4 * kBlocks + inVector / 4;
}

// The other way round: sixteen times four floats, side by side, each lane's at its placeOfFour().
HWY_INLINE void storeFours(float* p, const F& x, const F& y, const F& z, const F& w) {
  const hn::Repartition<double, TagF> pairs;
  VITRAIL_EACH {
    const auto xyLow = hn::BitCast(pairs, hn::InterleaveLower(kF, x.v[i], y.v[i]));
    const auto xyHigh = hn::BitCast(pairs, hn::InterleaveUpper(kF, x.v[i], y.v[i]));
    const auto zwLow = hn::BitCast(pairs, hn::InterleaveLower(kF, z.v[i], w.v[i]));
    const auto zwHigh = hn::BitCast(pairs, hn::InterleaveUpper(kF, z.v[i], w.v[i]));
    float* to = p + i * kVectorLanes * 4;
    hn::Store(hn::BitCast(kF, hn::InterleaveLower(pairs, xyLow, zwLow)), kF, to);
    hn::Store(hn::BitCast(kF, hn::InterleaveUpper(pairs, xyLow, zwLow)), kF, to + kVectorLanes);
    hn::Store(hn::BitCast(kF, hn::InterleaveLower(pairs, xyHigh, zwHigh)), kF, to + 2 * kVectorLanes);
    hn::Store(hn::BitCast(kF, hn::InterleaveUpper(pairs, xyHigh, zwHigh)), kF, to + 3 * kVectorLanes);
  }
}

// The same for a picture's pixels, a row of four every `stride` floats.
HWY_INLINE void loadPixels(const float* first, std::size_t stride, F& x, F& y, F& z, F& w) {
#if HWY_TARGET == HWY_AVX3
  const __m512 row[4] = {_mm512_loadu_ps(first), _mm512_loadu_ps(first + stride), _mm512_loadu_ps(first + 2 * stride),
                         _mm512_loadu_ps(first + 3 * stride)};
  const __m512 upper[2] = {_mm512_shuffle_f32x4(row[0], row[1], 0x44), _mm512_shuffle_f32x4(row[2], row[3], 0x44)};
  const __m512 lower[2] = {_mm512_shuffle_f32x4(row[0], row[1], 0xee), _mm512_shuffle_f32x4(row[2], row[3], 0xee)};
  const __m512 column[4] = {
      _mm512_shuffle_f32x4(upper[0], upper[1], 0x88), _mm512_shuffle_f32x4(upper[0], upper[1], 0xdd),
      _mm512_shuffle_f32x4(lower[0], lower[1], 0x88), _mm512_shuffle_f32x4(lower[0], lower[1], 0xdd)};
  const __m512 xy01 = _mm512_unpacklo_ps(column[0], column[1]);
  const __m512 zw01 = _mm512_unpackhi_ps(column[0], column[1]);
  const __m512 xy23 = _mm512_unpacklo_ps(column[2], column[3]);
  const __m512 zw23 = _mm512_unpackhi_ps(column[2], column[3]);
  x.v[0].raw = _mm512_shuffle_ps(xy01, xy23, 0x44);
  y.v[0].raw = _mm512_shuffle_ps(xy01, xy23, 0xee);
  z.v[0].raw = _mm512_shuffle_ps(zw01, zw23, 0x44);
  w.v[0].raw = _mm512_shuffle_ps(zw01, zw23, 0xee);
#else
  loadFours([first, stride](std::size_t lane) { return first + lane / 4 * stride + lane % 4 * 4; }, x, y, z, w);
#endif
}

// As storeFours(), in the order of lanes.
HWY_INLINE void storePixels(float* p, const F& x, const F& y, const F& z, const F& w) {
#if HWY_TARGET == HWY_AVX3
  const __m512 xyLow = _mm512_unpacklo_ps(x.v[0].raw, y.v[0].raw);
  const __m512 xyHigh = _mm512_unpackhi_ps(x.v[0].raw, y.v[0].raw);
  const __m512 zwLow = _mm512_unpacklo_ps(z.v[0].raw, w.v[0].raw);
  const __m512 zwHigh = _mm512_unpackhi_ps(z.v[0].raw, w.v[0].raw);
  const __m512 column[4] = {_mm512_shuffle_ps(xyLow, zwLow, 0x44), _mm512_shuffle_ps(xyLow, zwLow, 0xee),
                            _mm512_shuffle_ps(xyHigh, zwHigh, 0x44), _mm512_shuffle_ps(xyHigh, zwHigh, 0xee)};
  const __m512 upper[2] = {_mm512_shuffle_f32x4(column[0], column[1], 0x44),
                           _mm512_shuffle_f32x4(column[2], column[3], 0x44)};
  const __m512 lower[2] = {_mm512_shuffle_f32x4(column[0], column[1], 0xee),
                           _mm512_shuffle_f32x4(column[2], column[3], 0xee)};
  _mm512_store_ps(p, _mm512_shuffle_f32x4(upper[0], upper[1], 0x88));
  _mm512_store_ps(p + kLanes, _mm512_shuffle_f32x4(upper[0], upper[1], 0xdd));
  _mm512_store_ps(p + 2 * kLanes, _mm512_shuffle_f32x4(lower[0], lower[1], 0x88));
  _mm512_store_ps(p + 3 * kLanes, _mm512_shuffle_f32x4(lower[0], lower[1], 0xdd));
#else
  alignas(64) float fours[4 * kLanes];
  const hn::FixedTag<float, 4> four;
  storeFours(fours, x, y, z, w);
  for (std::size_t l = 0; l < kLanes; ++l) hn::Store(hn::Load(four, fours + 4 * placeOfFour(l)), four, p + 4 * l);
#endif
}

// ---- Sorting keys: a depth above, what goes with it below, as a positive double, which has the order of its bits

using Key = hn::Vec<TagD>;
constexpr std::size_t kKeyLanes = kVectorLanes / 2;
constexpr std::size_t kKeyVectors = 2 * kVectors; // of sixteen keys

HWY_INLINE void order(Key& a, Key& b) {
  const Key less = hn::Min(a, b);
  b = hn::Max(a, b);
  a = less;
}
// The keys of sixteen lanes, in an order of their own: lane l's is at placeOfKey(l).
HWY_INLINE void keysOf(const I& depth, const I& rest, Key* keys) {
  VITRAIL_EACH {
    keys[2 * i] = hn::BitCast(kD, hn::InterleaveLower(kI, rest.v[i], depth.v[i]));
    keys[2 * i + 1] = hn::BitCast(kD, hn::InterleaveUpper(kI, rest.v[i], depth.v[i]));
  }
}
constexpr std::size_t placeOfKey(std::size_t lane) {
  const std::size_t vector = lane / kVectorLanes;
  const std::size_t block = lane % kVectorLanes / 4;
  return (2 * vector + lane % 4 / 2) * kKeyLanes + 2 * block + lane % 2;
}

// What goes with the depths of sixteen keys, in the order of lanes.
HWY_INLINE I restsOf(const double* keys) {
#if HWY_TARGET == HWY_AVX3
  I r;
  r.v[0].raw = _mm512_castps_si512(_mm512_shuffle_ps(_mm512_castpd_ps(_mm512_load_pd(keys)),
                                                     _mm512_castpd_ps(_mm512_load_pd(keys + kKeyLanes)), 0x88));
  return r;
#else
  alignas(64) std::int32_t rests[kLanes];
  for (std::size_t l = 0; l < kLanes; ++l) std::memcpy(rests + l, keys + placeOfKey(l), sizeof(rests[l]));
  return load(rests);
#endif
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
