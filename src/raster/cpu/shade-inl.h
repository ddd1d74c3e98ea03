// Calls the host's shade functions, and turns what they give into what a fragment does to the light d behind it: c + t
// * d (shaders/vitrail/node.glsl, VitrailPair).
#if defined(VITRAIL_SHADE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_SHADE_INL_H
#undef VITRAIL_SHADE_INL_H
#else
#define VITRAIL_SHADE_INL_H
#endif

#include <bit>
#include <cstring>

#include "raster/cpu/frame.h"
#include "raster/cpu/lanes-inl.h"
#include "raster/cpu/store-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::raster::HWY_NAMESPACE {

struct Pairs {
  F color[3];
  F alpha;     // what it hides of what is behind it: 0 of what adds or multiplies
  F filter[3]; // what passes through, per channel; where the frame needs it
  M isNothing; // it would change nothing
};

constexpr float kLargestColor = 65504.0F;

// In [0, most]; a NaN is 0.
HWY_INLINE F clamped(const F& v, float most) { return min(keep(v > set(0.0F), v), set(most)); }

HWY_INLINE Pairs pairsOf(const VitrailCpuDraw& draw, const VitrailCpuFragments& f, bool filters) {
  const F one = set(1.0F);
  const F zero = set(0.0F);
  const bool isOver = draw.blend == VITRAIL_BLEND_OVER;
  const bool isAdded = draw.blend == VITRAIL_BLEND_ADDITIVE;
  const F alpha = clamped(load(f.color[3]), 1.0F);
  Pairs pairs;
  pairs.alpha = isAdded || draw.blend == VITRAIL_BLEND_MULTIPLY ? zero : alpha;
  pairs.isNothing = alpha == zero;
  for (std::size_t c = 0; c < 3; ++c) {
    const F color = clamped(load(f.color[c]), kLargestColor);
    pairs.filter[c] = one - pairs.alpha;
    if (isOver) {
      pairs.color[c] = min(color, set(draw.brightest)) * alpha;
    } else if (isAdded) {
      pairs.color[c] = min(color * alpha, set(draw.brightest));
    } else if (draw.blend == VITRAIL_BLEND_PREMULTIPLIED) {
      pairs.color[c] = min(color, set(draw.brightest));
      pairs.isNothing = pairs.isNothing & (color == zero);
    } else {
      pairs.color[c] = zero;
      pairs.filter[c] = fma(alpha, min(color, set(draw.brightest)) - one, one);
    }
    if (filters && (draw.shadeFlags & VITRAIL_CPU_SHADE_FILTER) != 0) {
      const F filter = clamped(load(f.filter[c]), 1.0F);
      pairs.filter[c] = pairs.filter[c] * filter;
      pairs.isNothing = pairs.isNothing & (filter == one);
    }
  }
  return pairs;
}

// Fills in the fragments of a draw without a shade function.
HWY_INLINE void shadeFlat(const VitrailCpuDraw& draw, VitrailCpuFragments& f) {
  for (std::size_t c = 0; c < 4; ++c) store(f.color[c], set(draw.color[c]));
}

// A block's fragments, one a pixel, of any draws.
struct ToShade {
  std::uint32_t x; // of the block, in the picture
  std::uint32_t y;
  I numbers; // of triangles, with kFrontBit
  M present;
  F depth;
  F second;
  F third;
  F derivatives[4];
};

// Calls the shade function of each draw that is there, for all of its fragments at once, and then
// take(draw, fragments, mask). `f` is memory for the call.
template <class Take>
HWY_INLINE void shadeAll(const Frame& frame, const ToShade& s, bool derivatives, VitrailCpuFragments& f, Take take) {
  std::uint32_t left = bitsOf(s.present);
  if (left == 0) return;
  alignas(64) std::int32_t numbers[kLanes];
  store(numbers, s.numbers);
  f.x = s.x;
  f.y = s.y;
  const std::uint32_t front = signsOf(s.numbers);
  store(f.depth, s.depth);
  store(f.second, s.second);
  store(f.third, s.third);
  if (derivatives) {
    store(f.secondDx, s.derivatives[0]);
    store(f.secondDy, s.derivatives[1]);
    store(f.thirdDx, s.derivatives[2]);
    store(f.thirdDy, s.derivatives[3]);
  }
  const I jobs = shiftRight<kJobBits>(s.numbers & set(0x7fffffff));
  const I within = s.numbers & set(static_cast<std::int32_t>(kJobTriangles) - 1);
  const std::uint32_t every = left;
  while (left != 0) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
    const std::uint32_t jobNumber = (static_cast<std::uint32_t>(numbers[lane]) & 0x7fffffffU) >> kJobBits;
    const Job& job = frame.jobs[jobNumber];
    const DrawInfo& info = frame.draws[job.draw];
    // Lanes of the same draw: those of the same job, mostly. In the others, also where nothing is, the triangle of this
    // one: functions may look up what they do not use.
    M same = jobs == set(static_cast<std::int32_t>(jobNumber));
    const I own = set(numbers[lane] & static_cast<std::int32_t>(kJobTriangles - 1));
    I triangles = select(same, within, own) + set(static_cast<std::int32_t>(job.first));
    std::uint32_t mask = bitsOf(same) & left;
    if (mask != every) {
      const auto first = static_cast<std::int32_t>(info.firstJob);
      const auto last = static_cast<std::int32_t>(info.firstJob + (info.primitives - 1) / kJobTriangles);
      same = ~((set(first) > jobs) | (jobs > set(last)));
      triangles = shiftLeft<kJobBits>(jobs - set(first)) + within;
      triangles = select(same, triangles, own + set(static_cast<std::int32_t>(job.first)));
      mask = bitsOf(same) & left;
    }
    f.mask = mask;
    f.draw = job.draw;
    f.front = front & mask;
    f.discarded = 0;
    store(reinterpret_cast<std::int32_t*>(f.triangle), triangles);
    if (info.draw.shade != nullptr) {
      info.draw.shade(info.draw.shadeUser, &f);
    } else {
      shadeFlat(info.draw, f);
    }
    take(info.draw, f, mask);
    left &= ~mask;
  }
}

// Replaces a row's weights by what is blended. Fragments that are not there after all, or change nothing, leave the
// row; returns how many lanes did, a bit each.
HWY_INLINE std::uint32_t shadeRow(const Frame& frame, Row row, std::uint32_t x, std::uint32_t y,
                                  VitrailCpuFragments& f) {
  const bool filters = frame.needs.filters;
  const I keys = load(row);
  ToShade s;
  s.x = x;
  s.y = y;
  s.numbers = load(row + kLanes * RowShape::kNumber);
  s.present = set(kFarKey) > keys;
  s.depth = keep(s.present, depthOf(keys, frame.info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE));
  s.second = load(floatsOf(row, RowShape::kSecond));
  s.third = load(floatsOf(row, RowShape::kThird));
  if (frame.needs.derivatives) {
    for (std::uint32_t i = 0; i < 4; ++i) s.derivatives[i] = load(floatsOf(row, RowShape::kDerivatives + i));
  }
  const F zero = set(0.0F);
  const F one = set(1.0F);
  F color[3] = {zero, zero, zero};
  F alpha = zero;
  F filter[3] = {one, one, one};
  std::uint32_t gone = 0;
  shadeAll(frame, s, frame.needs.derivatives, f,
           [&](const VitrailCpuDraw& draw, const VitrailCpuFragments& shaded, std::uint32_t mask) HWY_ATTR {
             const Pairs pairs = pairsOf(draw, shaded, filters);
             const std::uint32_t lost = (bitsOf(pairs.isNothing) | shaded.discarded) & mask;
             gone |= lost;
             const M taken = maskOf(mask & ~lost);
             for (std::size_t c = 0; c < 3; ++c) color[c] = select(taken, pairs.color[c], color[c]);
             alpha = select(taken, pairs.alpha, alpha);
             if (filters) {
               for (std::size_t c = 0; c < 3; ++c) filter[c] = select(taken, pairs.filter[c], filter[c]);
             }
           });
  if (gone != 0) store(row, select(maskOf(gone), set(kFarKey), keys));
  storeFours(floatsOf(row, RowShape::kPairs), color[0], color[1], color[2], alpha);
  if (filters) storeFours(floatsOf(row, RowShape::kFilters), filter[0], filter[1], filter[2], zero);
  return gone;
}

} // namespace vitrail::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
