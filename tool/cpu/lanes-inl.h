// Vectors of fragments: as many lanes as the target has, 16 at most. Included once a target.
#if defined(VITRAIL_TOOL_CPU_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_TOOL_CPU_LANES_INL_H
#undef VITRAIL_TOOL_CPU_LANES_INL_H
#else
#define VITRAIL_TOOL_CPU_LANES_INL_H
#endif

#include <hwy/highway.h>
#include <vitrail/cpu.h>

#include "shade.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::tool {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, VITRAIL_CPU_LANES>;
using IntTag = hn::RebindToSigned<Tag>;
using V = hn::Vec<Tag>;
using VI = hn::Vec<IntTag>;
using M = hn::Mask<Tag>;

constexpr std::size_t kLanes = hn::MaxLanes(Tag());

// Stores what is loaded again lane by lane: in halves where vectors have 64 bytes. Some processors (Intel's) hand over
// nothing of the upper half of such a store until it has left for the cache, behind all stores before it.
HWY_INLINE void storeForLanes(VI v, std::int32_t* to) {
#if HWY_MAX_BYTES == 64
  const hn::Half<IntTag> half;
  hn::Store(hn::LowerHalf(half, v), half, to);
  hn::Store(hn::UpperHalf(half, v), half, to + kLanes / 2);
#else
  hn::Store(v, IntTag(), to);
#endif
}

struct Float3 {
  V x, y, z;
};

struct Float4 {
  V x, y, z, w;
};

HWY_INLINE V set(float value) { return hn::Set(Tag(), value); }
HWY_INLINE VI setInt(std::int32_t value) { return hn::Set(IntTag(), value); }
HWY_INLINE V zero() { return hn::Zero(Tag()); }
HWY_INLINE V one() { return set(1.0F); }
HWY_INLINE V load(const float* from) { return hn::Load(Tag(), from); }
HWY_INLINE VI loadInt(const std::int32_t* from) { return hn::Load(IntTag(), from); }

HWY_INLINE Float3 all(V value) { return {value, value, value}; }
template <typename Vec3>
HWY_INLINE Float3 set3(const Vec3& v) {
  return {set(v.x), set(v.y), set(v.z)};
}

HWY_INLINE Float3 operator+(const Float3& a, const Float3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Float3 operator-(const Float3& a, const Float3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Float3 operator*(const Float3& a, const Float3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
HWY_INLINE Float3 operator*(const Float3& a, V b) { return {a.x * b, a.y * b, a.z * b}; }

HWY_INLINE V mulAdd(V a, V b, V c) { return hn::MulAdd(a, b, c); }
HWY_INLINE Float3 mulAdd(const Float3& a, V b, const Float3& c) {
  return {mulAdd(a.x, b, c.x), mulAdd(a.y, b, c.y), mulAdd(a.z, b, c.z)};
}
HWY_INLINE Float3 mulAdd(const Float3& a, const Float3& b, const Float3& c) {
  return {mulAdd(a.x, b.x, c.x), mulAdd(a.y, b.y, c.y), mulAdd(a.z, b.z, c.z)};
}
HWY_INLINE V dot(const Float3& a, const Float3& b) { return mulAdd(a.x, b.x, mulAdd(a.y, b.y, a.z * b.z)); }
HWY_INLINE Float3 cross(const Float3& a, const Float3& b) {
  return {hn::MulSub(a.y, b.z, a.z * b.y), hn::MulSub(a.z, b.x, a.x * b.z), hn::MulSub(a.x, b.y, a.y * b.x)};
}

HWY_INLINE V select(M mask, V yes, V no) { return hn::IfThenElse(mask, yes, no); }
HWY_INLINE Float3 select(M mask, const Float3& yes, const Float3& no) {
  return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
HWY_INLINE V min(V a, V b) { return hn::Min(a, b); }
HWY_INLINE V max(V a, V b) { return hn::Max(a, b); }
HWY_INLINE V clamp(V v, float low, float high) { return min(max(v, set(low)), set(high)); }
HWY_INLINE V mix(V a, V b, V share) { return mulAdd(b - a, share, a); }
HWY_INLINE Float3 mix(const Float3& a, const Float3& b, V share) {
  return {mix(a.x, b.x, share), mix(a.y, b.y, share), mix(a.z, b.z, share)};
}
HWY_INLINE V largest(const Float3& v) { return max(v.x, max(v.y, v.z)); }

// 1 / sqrt(v) to the last bit but one or two, for v > 0. One step of Newton's makes 12 bits, or 14, 23.
HWY_INLINE V inverseSqrt(V v) {
#if HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3
  const V guess = hn::ApproximateReciprocalSqrt(v);
  return guess * hn::NegMulAdd(v * guess * set(0.5F), guess, set(1.5F));
#else
  return one() / hn::Sqrt(v);
#endif
}

// Unit length; `fallback` for a vector without a direction.
HWY_INLINE Float3 direction(const Float3& v, const Float3& fallback) {
  const V squared = dot(v, v);
  return select(squared > zero(), v * inverseSqrt(squared), fallback);
}

// The normal of the plane in which two directions lie, not of unit length. Each is made about 1 long first, so that no
// square of the normal overflows in a large model, or vanishes in a small one.
HWY_INLINE Float3 normalOfPlane(const Float3& a, const Float3& b) {
  const auto sized = [](const Float3& v) HWY_ATTR {
    return v * (one() / max(largest({hn::Abs(v.x), hn::Abs(v.y), hn::Abs(v.z)}), set(1e-37F)));
  };
  return cross(sized(a), sized(b));
}

// Which lanes have a bit set: lane i of those from `first` on has bit first + i.
HWY_INLINE M maskOf(std::uint32_t bits, std::size_t first) {
  alignas(64) static constexpr std::int32_t kBits[VITRAIL_CPU_LANES] = {
      1,      1 << 1, 1 << 2,  1 << 3,  1 << 4,  1 << 5,  1 << 6,  1 << 7,
      1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15};
  const auto mask = hn::TestBit(setInt(static_cast<std::int32_t>(bits)), loadInt(kBits + first));
  return hn::RebindMask(Tag(), mask);
}

// The same the other way.
template <typename AnyTag, typename AnyMask>
HWY_INLINE std::uint32_t bitsOf(AnyTag tag, AnyMask mask, std::size_t first) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(tag, mask, bytes);
  const std::uint32_t bits = static_cast<std::uint32_t>(bytes[0] | bytes[1] << 8) & ((1U << kLanes) - 1U);
  return bits << first;
}

// Four numbers side by side, and twice two of them from two places.
#if HWY_TARGET == HWY_SCALAR
struct Four {
  std::int32_t of[4];
};
HWY_INLINE Four loadFour(const std::int32_t* from) { return {{from[0], from[1], from[2], from[3]}}; }
HWY_INLINE Four loadTwos(const std::int32_t* a, const std::int32_t* b) { return {{a[0], a[1], b[0], b[1]}}; }
#else
using FourTag = hn::FixedTag<std::int32_t, 4>;
using Four = hn::Vec<FourTag>;
HWY_INLINE Four loadFour(const std::int32_t* from) { return hn::LoadU(FourTag(), from); }
HWY_INLINE Four loadTwos(const std::int32_t* a, const std::int32_t* b) {
  const hn::FixedTag<std::int32_t, 2> two;
  return hn::Combine(FourTag(), hn::LoadU(two, b), hn::LoadU(two, a));
}
HWY_INLINE Four fourOf(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
#if HWY_ARCH_X86
  return Four{_mm_setr_epi32(a, b, c, d)};
#else
  const std::int32_t all[4] = {a, b, c, d};
  return loadFour(all);
#endif
}

// What `of(i)` gives for i = 0, 1, ... side by side.
template <class Of>
HWY_INLINE VI blocksOf(Of of) {
#if HWY_MAX_BYTES == 16
  return of(0);
#elif HWY_MAX_BYTES == 32
  return hn::Combine(IntTag(), of(1), of(0));
#else
  const hn::FixedTag<std::int32_t, 8> eight;
  return hn::Combine(IntTag(), hn::Combine(eight, of(3), of(2)), hn::Combine(eight, of(1), of(0)));
#endif
}
#endif

// The first, second, third and fourth number of what `of(lane)` gives for each lane.
template <class Of>
HWY_INLINE void columnsOf(Of of, VI* to) {
#if HWY_TARGET == HWY_SCALAR
  const Four four = of(0);
  for (std::size_t i = 0; i < 4; ++i) to[i] = setInt(four.of[i]);
#else
  const IntTag di;
  const hn::Repartition<std::int64_t, IntTag> pairs;
  VI column[4]; // block b of column c: lane 4 b + c
  for (std::size_t c = 0; c < 4; ++c) {
    column[c] = blocksOf([&](std::size_t block) HWY_ATTR { return of(c + 4 * block); });
  }
  const auto low01 = hn::BitCast(pairs, hn::InterleaveLower(di, column[0], column[1]));
  const auto high01 = hn::BitCast(pairs, hn::InterleaveUpper(di, column[0], column[1]));
  const auto low23 = hn::BitCast(pairs, hn::InterleaveLower(di, column[2], column[3]));
  const auto high23 = hn::BitCast(pairs, hn::InterleaveUpper(di, column[2], column[3]));
  to[0] = hn::BitCast(di, hn::InterleaveLower(pairs, low01, low23));
  to[1] = hn::BitCast(di, hn::InterleaveUpper(pairs, low01, low23));
  to[2] = hn::BitCast(di, hn::InterleaveLower(pairs, high01, high23));
  to[3] = hn::BitCast(di, hn::InterleaveUpper(pairs, high01, high23));
#endif
}

// The way from the pixels of some lanes to the eye of a perspective camera, not of unit length.
HWY_INLINE Float3 toEye(const ShadeFrame& frame, const VitrailCpuFragments& fragments, std::size_t lane) {
  alignas(64) static constexpr float kX[VITRAIL_CPU_LANES] = {0.5F, 1.5F, 2.5F, 3.5F, 0.5F, 1.5F, 2.5F, 3.5F,
                                                              0.5F, 1.5F, 2.5F, 3.5F, 0.5F, 1.5F, 2.5F, 3.5F};
  alignas(64) static constexpr float kY[VITRAIL_CPU_LANES] = {0.5F, 0.5F, 0.5F, 0.5F, 1.5F, 1.5F, 1.5F, 1.5F,
                                                              2.5F, 2.5F, 2.5F, 2.5F, 3.5F, 3.5F, 3.5F, 3.5F};
  const V x = set(static_cast<float>(fragments.x)) + load(kX + lane);
  const V y = set(static_cast<float>(fragments.y)) + load(kY + lane);
  return mulAdd(set3(frame.toEyeY), y, mulAdd(set3(frame.toEyeX), x, set3(frame.toEye)));
}

} // namespace HWY_NAMESPACE
} // namespace vitrail::tool
HWY_AFTER_NAMESPACE();

#endif
