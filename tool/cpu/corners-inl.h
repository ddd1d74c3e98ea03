// The corners of the triangles that a call shades, and what is interpolated between them. Included once a target.
//
// A call's sixteen fragments belong to few triangles. What their corners have is fetched and unpacked once a triangle,
// into an array of three numbers each for every attribute, from which each fragment takes its own three.
#if defined(VITRAIL_TOOL_CPU_CORNERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_TOOL_CPU_CORNERS_INL_H
#undef VITRAIL_TOOL_CPU_CORNERS_INL_H
#else
#define VITRAIL_TOOL_CPU_CORNERS_INL_H
#endif

#include <algorithm>
#include <bit>

#include "lanes-inl.h"
#include "shade.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::tool {
namespace HWY_NAMESPACE {

constexpr std::size_t kCornersApart = 4; // those of a triangle, and the third one again
constexpr std::size_t kMostCorners = kCornersApart * VITRAIL_CPU_LANES;

// One number for each corner.
struct CornerValues {
  alignas(64) float of[kMostCorners];
};

struct Corners {
  std::size_t count = 0; // kCornersApart for each triangle
  alignas(64) std::uint32_t vertex[kMostCorners];
  alignas(64) std::int32_t first[VITRAIL_CPU_LANES]; // by fragment: its triangle's first corner
};

// Finds the triangles of all fragments that are wanted. The others are given the first one.
HWY_INLINE void findCorners(const VitrailCpuFragments& fragments, const ShadeMesh& mesh, Corners& corners) {
  const IntTag di;
  const auto* triangles = reinterpret_cast<const std::int32_t*>(fragments.triangle);
  alignas(64) std::int32_t lanes[VITRAIL_CPU_LANES];
  for (std::size_t i = 0; i < VITRAIL_CPU_LANES; i += kLanes) {
    hn::Store(hn::Zero(di), di, corners.first + i);
    storeForLanes(hn::LoadU(di, triangles + i), lanes + i);
  }
  std::size_t count = 0;
  for (std::uint32_t left = fragments.mask; left != 0; count += kCornersApart) {
    const auto triangle = static_cast<std::uint32_t>(lanes[hwy::Num0BitsBelowLS1Bit_Nonzero32(left)]);
    std::uint32_t same = 0;
    for (std::size_t i = 0; i < VITRAIL_CPU_LANES; i += kLanes) {
      const auto equal = hn::LoadU(di, triangles + i) == setInt(static_cast<std::int32_t>(triangle));
      same |= bitsOf(di, equal, i);
      const VI first = loadInt(corners.first + i);
      hn::Store(hn::IfThenElse(equal, setInt(static_cast<std::int32_t>(count)), first), di, corners.first + i);
    }
    left &= ~same;
    // Lines and points stand for triangles whose further corners are the first one again.
    const std::uint32_t* indices = mesh.indices + std::size_t{triangle} * mesh.corners;
    corners.vertex[count] = indices[0];
    corners.vertex[count + 1] = indices[mesh.corners > 1 ? 1 : 0];
    corners.vertex[count + 2] = corners.vertex[count + 3] = indices[mesh.corners > 2 ? 2 : 0];
  }
  corners.count = count;
}

// Where the fragments of some lanes are: their triangles and the weights of its corners.
struct Places {
  VI first;
  V weight, second, third;
};

HWY_INLINE Places placesOf(const VitrailCpuFragments& fragments, const Corners& corners, const ShadeMesh& mesh,
                           std::size_t lane) {
  const Tag d;
  const V second = mesh.corners > 1 ? hn::LoadU(d, fragments.second + lane) : zero();
  const V third = mesh.corners > 2 ? hn::LoadU(d, fragments.third + lane) : zero();
  return {loadInt(corners.first + lane), one() - second - third, second, third};
}

// What each fragment's triangle has at a corner, 0 to 2.
HWY_INLINE V valueAt(const Corners& corners, const CornerValues& values, VI first, std::int32_t corner) {
  const Tag d;
  if (corners.count == kCornersApart) return set(values.of[corner]); // of one triangle
#if HWY_TARGET == HWY_AVX3
  const __m512i at = (first + setInt(corner)).raw;
  if (HWY_LIKELY(corners.count <= 2 * kLanes)) {
    return V{_mm512_permutex2var_ps(load(values.of).raw, at, load(values.of + kLanes).raw)};
  }
  const __m512 nearer = _mm512_permutex2var_ps(load(values.of).raw, at, load(values.of + kLanes).raw);
  const __m512 further = _mm512_permutex2var_ps(load(values.of + 2 * kLanes).raw, at, load(values.of + 3 * kLanes).raw);
  return V{_mm512_mask_blend_ps(_mm512_test_epi32_mask(at, _mm512_set1_epi32(32)), nearer, further)};
#elif HWY_TARGET == HWY_AVX2
  // Shuffles of whole vectors: calls have five triangles on average, and their corners fit into one or two.
  const VI at = first + setInt(corner);
  const auto within = hn::IndicesFromVec(d, hn::And(at, setInt(static_cast<std::int32_t>(kLanes - 1))));
  V result = hn::TableLookupLanes(load(values.of), within);
  for (std::size_t i = kLanes; i < corners.count; i += kLanes) {
    const M further = hn::RebindMask(d, at > setInt(static_cast<std::int32_t>(i - 1)));
    result = select(further, hn::TableLookupLanes(load(values.of + i), within), result);
  }
  return result;
#else
  if (corners.count > 4 * kCornersApart) return hn::GatherIndex(d, values.of, first + setInt(corner));
  V result = set(values.of[corner]);
  for (std::size_t i = kCornersApart; i < corners.count; i += kCornersApart) {
    const M own = hn::RebindMask(d, first == setInt(static_cast<std::int32_t>(i)));
    result = select(own, set(values.of[i + static_cast<std::size_t>(corner)]), result);
  }
  return result;
#endif
}

HWY_INLINE V interpolate(const Corners& corners, const CornerValues& values, const Places& places) {
  const V a = valueAt(corners, values, places.first, 0);
  const V b = valueAt(corners, values, places.first, 1);
  const V c = valueAt(corners, values, places.first, 2);
  return mulAdd(c, places.third, mulAdd(b, places.second, a * places.weight));
}

HWY_INLINE Float3 interpolate3(const Corners& corners, const CornerValues* values, const Places& places) {
  return {interpolate(corners, values[0], places), interpolate(corners, values[1], places),
          interpolate(corners, values[2], places)};
}

// Numbers of kLanes corners from `first` on, of what `of(vertex)` gives for each; beyond the last triangle that one's
// again. They are put together in registers: what was stored number by number cannot be loaded as a whole before it has
// left for the cache, behind all that was stored before it.
template <class Of>
HWY_INLINE VI numbersOf(const Corners& corners, std::size_t first, Of of) {
#if HWY_TARGET == HWY_SCALAR
  return setInt(of(corners.vertex[first]));
#else
  const std::size_t last = corners.count - kCornersApart;
  const auto triangle = [&](std::size_t i) HWY_ATTR {
    const std::uint32_t* const vertex = corners.vertex + std::min(first + i * kCornersApart, last);
    const auto third = of(vertex[2]);
    return fourOf(of(vertex[0]), of(vertex[1]), third, third);
  };
  return blocksOf(triangle);
#endif
}

// Fills in one number of each vertex, `values` being those of all vertices, some floats apart.
HWY_INLINE void fetch(const Corners& corners, const float* values, std::size_t stride, CornerValues& to) {
  if (corners.count == kCornersApart) { // which is read number by number
    for (std::size_t i = 0; i < 3; ++i) to.of[i] = values[corners.vertex[i] * stride];
    return;
  }
  const auto bitsOfValue = [&](std::uint32_t vertex) { return std::bit_cast<std::int32_t>(values[vertex * stride]); };
  for (std::size_t i = 0; i < corners.count; i += kLanes) {
    hn::Store(hn::BitCast(Tag(), numbersOf(corners, i, bitsOfValue)), Tag(), to.of + i);
  }
}

// Unit vectors from their octahedral projections, each a vector of floats.
HWY_INLINE Float3 fromOctahedral(V x, V y) {
  const V z = one() - hn::Abs(x) - hn::Abs(y);
  const V fold = max(hn::Neg(z), zero());
  const Float3 v{x - hn::CopySign(fold, x), y - hn::CopySign(fold, y), z};
  return v * inverseSqrt(dot(v, v));
}

// Fetches and unpacks what packDirection() has packed.
HWY_INLINE void fetchDirections(const Corners& corners, const std::uint32_t* packed, CornerValues* to) {
  const Tag d;
  const auto wordOf = [&](std::uint32_t vertex) { return static_cast<std::int32_t>(packed[vertex]); };
  for (std::size_t i = 0; i < corners.count; i += kLanes) {
    const VI word = numbersOf(corners, i, wordOf);
    const V scale = set(1.0F / 32767.0F);
    const V x = hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(word))) * scale;
    const V y = hn::ConvertTo(d, hn::ShiftRight<16>(word)) * scale;
    const Float3 v = fromOctahedral(x, y);
    hn::Store(v.x, d, to[0].of + i);
    hn::Store(v.y, d, to[1].of + i);
    hn::Store(v.z, d, to[2].of + i);
  }
}

// The same for packTangent(), with the sign.
HWY_INLINE void fetchTangents(const Corners& corners, const std::uint32_t* packed, CornerValues* to) {
  const Tag d;
  const IntTag di;
  const auto wordOf = [&](std::uint32_t vertex) { return static_cast<std::int32_t>(packed[vertex]); };
  for (std::size_t i = 0; i < corners.count; i += kLanes) {
    const VI word = numbersOf(corners, i, wordOf);
    const V x = hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(word))) * set(1.0F / 32767.0F);
    const V y = hn::ConvertTo(d, hn::ShiftRight<17>(word)) * set(1.0F / 16383.0F);
    const Float3 v = fromOctahedral(x, y);
    const auto negative = hn::RebindMask(d, hn::TestBit(word, hn::Set(di, 1 << 16)));
    hn::Store(v.x, d, to[0].of + i);
    hn::Store(v.y, d, to[1].of + i);
    hn::Store(v.z, d, to[2].of + i);
    hn::Store(select(negative, set(-1.0F), one()), d, to[3].of + i);
  }
}

// 16-bit floats in the lower halves of 32-bit numbers, not infinite: a 32-bit float has the same bits 13 places higher,
// and an exponent that is 112 larger.
HWY_INLINE V fromHalf(VI half) {
  const IntTag di;
  const VI magnitude = hn::ShiftLeft<13>(hn::And(half, setInt(0x7fff)));
  const VI sign = hn::ShiftLeft<16>(hn::And(half, setInt(0x8000)));
  const V value = hn::BitCast(Tag(), magnitude) * set(5.192296858534828e33F);
  return hn::BitCast(Tag(), hn::Or(hn::BitCast(di, value), sign));
}

// The same for packColor().
HWY_INLINE void fetchColors(const Corners& corners, const std::uint64_t* packed, CornerValues* to) {
  const Tag d;
  for (std::size_t i = 0; i < corners.count; i += kLanes) {
    for (std::size_t half = 0; half < 2; ++half) {
      const auto halfOf = [&](std::uint32_t vertex) {
        return static_cast<std::int32_t>(packed[vertex] >> 32U * half & 0xffffffffU);
      };
      const VI word = numbersOf(corners, i, halfOf);
      hn::Store(fromHalf(word), d, to[2 * half].of + i);
      hn::Store(fromHalf(hn::ShiftRight<16>(word)), d, to[2 * half + 1].of + i);
    }
  }
}

} // namespace HWY_NAMESPACE
} // namespace vitrail::tool
HWY_AFTER_NAMESPACE();

#endif
