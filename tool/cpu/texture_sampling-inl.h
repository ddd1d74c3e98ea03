// Samples textures as the Vulkan specification states it ("Image Sample Operations"). Included once a target.
#if defined(VITRAIL_TOOL_CPU_TEXTURE_SAMPLING_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_TOOL_CPU_TEXTURE_SAMPLING_INL_H
#undef VITRAIL_TOOL_CPU_TEXTURE_SAMPLING_INL_H
#else
#define VITRAIL_TOOL_CPU_TEXTURE_SAMPLING_INL_H
#endif

#include <algorithm>
#include <cstring>

#include <hwy/cache_control.h>
#include <hwy/contrib/math/math-inl.h>

#include "corners-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::tool {
namespace HWY_NAMESPACE {

// Texture coordinates and how they change from pixel to pixel.
struct Coordinates {
  V u, v;
  V uDx, vDx, uDy, vDy;
};

// Two texels next to each other along an axis, and the second one's weight.
struct Neighbours {
  VI first, second;
  V weight;
};

// `linear`: in which lanes both count.
HWY_INLINE Neighbours neighboursOf(V at, VI size, M linear, Wrap wrap) {
  const Tag d;
  const IntTag di;
  const V length = hn::ConvertTo(d, size);
  // Into [0, 1] first: far away coordinates then still fit into an integer.
  if (wrap == Wrap::Repeat) at = at - hn::Floor(at);
  if (wrap == Wrap::MirroredRepeat) {
    at = at - set(2.0F) * hn::Floor(at * set(0.5F));
    at = min(at, set(2.0F) - at);
  }
  if (wrap == Wrap::ClampToEdge) at = clamp(at, -1.0F, 2.0F);
  const V place = at * length - hn::IfThenElseZero(linear, set(0.5F));
  const V floored = hn::Floor(place);
  VI first = hn::ConvertTo(di, floored);
  VI second = first + setInt(1);
  const VI last = size - setInt(1);
  if (wrap == Wrap::Repeat) {
    first = hn::IfThenElse(first < hn::Zero(di), first + size, first);
    second = hn::IfThenElse(second > last, second - size, second);
  }
  // Also what is not a number at all stays within the texture.
  first = hn::Min(hn::Max(first, hn::Zero(di)), last);
  second = hn::Min(hn::Max(second, hn::Zero(di)), last);
  return {first, second, hn::IfThenElseZero(linear, place - floored)};
}

// The linear values of 8-bit codes on the sRGB curve. The polynomial is the one of its degree that is nowhere further
// from the curve in steps of the code, at most 0.012 of one; below the code 11 the curve is a line. A table would have
// to be read lane by lane.
HWY_INLINE V fromSrgbCode(VI code) {
  const V x = hn::ConvertTo(Tag(), code) * set(1.0F / 255.0F);
  V curve = mulAdd(set(0.0855950340628624F), x, set(-0.3033049702644348F));
  curve = mulAdd(curve, x, set(0.6637017130851746F));
  curve = mulAdd(curve, x, set(0.5206166505813599F));
  curve = mulAdd(curve, x, set(0.03257186338305473F));
  curve = mulAdd(curve, x, set(0.0009242223459295928F));
  return select(x > set(10.5F / 255.0F), curve, x * set(1.0F / 12.92F));
}

// The four texels between which fragments read, bit for bit: of 8-bit ones a word, of premultiplied ones two. By lane:
// upper left, upper right, lower left, lower right.
struct FetchedTexels {
  alignas(64) std::uint32_t upper[kLanes][4]; // of 8-bit ones all four, of premultiplied ones two
  alignas(64) std::uint32_t lower[kLanes][4]; // premultiplied ones
};

HWY_INLINE Float4 mix4(const Float4& a, const Float4& b, V share) {
  return {mix(a.x, b.x, share), mix(a.y, b.y, share), mix(a.z, b.z, share), mix(a.w, b.w, share)};
}

HWY_INLINE Float4 bilinear(const Float4* texels, V x, V y) {
  return mix4(mix4(texels[0], texels[1], x), mix4(texels[2], texels[3], x), y);
}

// Red, green, blue and alpha of texels of eight bits a channel.
HWY_INLINE Float4 unpackBytes(VI word, bool srgb) {
  const VI byte = setInt(255);
  const VI r = hn::And(word, byte);
  const VI g = hn::And(hn::ShiftRight<8>(word), byte);
  const VI b = hn::And(hn::ShiftRight<16>(word), byte);
  const V scale = set(1.0F / 255.0F);
  const V alpha = hn::ConvertTo(Tag(), hn::And(hn::ShiftRight<24>(word), byte)) * scale;
  if (srgb) return {fromSrgbCode(r), fromSrgbCode(g), fromSrgbCode(b), alpha};
  return {hn::ConvertTo(Tag(), r) * scale, hn::ConvertTo(Tag(), g) * scale, hn::ConvertTo(Tag(), b) * scale, alpha};
}

// The two 16-bit floats in a word, which are not negative: as in fromHalf().
constexpr float kHalfScale = 5.192296858534828e33F; // 2^112
HWY_INLINE V lowerHalf(VI word) {
  return hn::BitCast(Tag(), hn::ShiftLeft<13>(hn::And(word, setInt(0x7fff)))) * set(kHalfScale);
}
HWY_INLINE V upperHalf(VI word) {
  return hn::BitCast(Tag(), hn::And(hn::ShiftRight<3>(word), setInt(0x0fffe000))) * set(kHalfScale);
}

// Which texels of a level fragments read, and how much of each.
struct LevelPlaces {
  alignas(64) std::int32_t index[4][kLanes]; // by texel as in FetchedTexels
  bool arePairs;                             // in all lanes the right texels follow the left ones in memory
  V right, down;
};

HWY_INLINE void placeInLevel(const CpuSlot& slot, VI level, V u, V v, M linear, LevelPlaces& places) {
  const CpuTexture& texture = *slot.texture;
  const IntTag di;
  const auto first = static_cast<std::size_t>(hn::GetLane(level));
  VI width = setInt(texture.width[first]);
  VI height = setInt(texture.height[first]);
  VI offset = setInt(texture.offset[first]);
  if (!hn::AllTrue(di, level == setInt(static_cast<std::int32_t>(first)))) {
    width = hn::GatherIndex(di, texture.width.data(), level);
    height = hn::GatherIndex(di, texture.height.data(), level);
    offset = hn::GatherIndex(di, texture.offset.data(), level);
  }
  const Neighbours x = neighboursOf(u, width, linear, slot.sampler.wrapU);
  const Neighbours y = neighboursOf(v, height, linear, slot.sampler.wrapV);
  const VI upper = offset + y.first * width;
  const VI lower = offset + y.second * width;
  hn::Store(upper + x.first, di, places.index[0]);
  hn::Store(upper + x.second, di, places.index[1]);
  hn::Store(lower + x.first, di, places.index[2]);
  hn::Store(lower + x.second, di, places.index[3]);
  places.arePairs = hn::AllTrue(di, x.second == x.first + setInt(1));
  places.right = x.weight;
  places.down = y.weight;
}

// Asks for most of what fetchTexels() is to read: the first and the last of each four pixels, which are neighbours. The
// rasteriser shades a block's layers one after the other, each of which shows another place of its texture: that is in
// no near cache, and waiting for it line by line would be what sampling costs.
HWY_INLINE void prefetchTexels(const CpuTexture& texture, const LevelPlaces& places) {
  const std::size_t words = texture.kind == Texels::Premultiplied ? 2 : 1;
  const auto ask = [&](std::size_t lane) HWY_ATTR {
    hwy::Prefetch(texture.texels.data() + words * static_cast<std::size_t>(places.index[0][lane]));
  };
  for (std::size_t i = 0; i < kLanes; i += 4) {
    ask(i);
    ask(std::min(i + 3, kLanes - 1));
  }
}

// Copies by one vector of exactly so many words: left to itself, the compiler takes them through several registers.
template <std::size_t kWords>
HWY_INLINE void copyWords(const std::uint32_t* from, std::uint32_t* to) {
  if constexpr (kWords <= HWY_LANES(std::uint32_t)) {
    const hn::FixedTag<std::uint32_t, kWords> d;
    hn::StoreU(hn::LoadU(d, from), d, to);
  } else {
    std::memcpy(to, from, kWords * sizeof(std::uint32_t));
  }
}

// Loads of one texel, or two neighbours, after the other: they are faster than gathers, of which processors make more
// steps than that.
HWY_INLINE void fetchTexels(const CpuTexture& texture, const LevelPlaces& places, FetchedTexels& to) {
  const std::uint32_t* texels = texture.texels.data();
  const auto at = [&](std::size_t k, std::size_t i) HWY_ATTR { return static_cast<std::size_t>(places.index[k][i]); };
  if (texture.kind == Texels::Premultiplied) {
    if (HWY_LIKELY(places.arePairs)) {
      for (std::size_t i = 0; i < kLanes; ++i) {
        copyWords<4>(texels + 2 * at(0, i), to.upper[i]);
        copyWords<4>(texels + 2 * at(2, i), to.lower[i]);
      }
      return;
    }
    for (std::size_t i = 0; i < kLanes; ++i) {
      copyWords<2>(texels + 2 * at(0, i), to.upper[i]);
      copyWords<2>(texels + 2 * at(1, i), to.upper[i] + 2);
      copyWords<2>(texels + 2 * at(2, i), to.lower[i]);
      copyWords<2>(texels + 2 * at(3, i), to.lower[i] + 2);
    }
    return;
  }
  if (HWY_LIKELY(places.arePairs)) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      copyWords<2>(texels + at(0, i), to.upper[i]);
      copyWords<2>(texels + at(2, i), to.upper[i] + 2);
    }
    return;
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    for (std::size_t k = 0; k < 4; ++k) to.upper[i][k] = texels[at(k, i)];
  }
}

HWY_INLINE void loadWords(const std::uint32_t (*words)[4], VI* to) {
  hn::LoadInterleaved4(IntTag(), reinterpret_cast<const std::int32_t*>(words), to[0], to[1], to[2], to[3]);
}

// What is between the texels.
HWY_INLINE Float4 filterTexels(const CpuTexture& texture, const LevelPlaces& places, const FetchedTexels& fetched) {
  Float4 texels[4];
  VI words[4];
  loadWords(fetched.upper, words);
  if (texture.kind != Texels::Premultiplied) {
    for (std::size_t i = 0; i < 4; ++i) texels[i] = unpackBytes(words[i], texture.kind == Texels::Srgb);
    return bilinear(texels, places.right, places.down);
  }
  for (std::size_t i = 0; i < 4; i += 2) {
    if (i != 0) loadWords(fetched.lower, words);
    texels[i] = {lowerHalf(words[0]), upperHalf(words[0]), lowerHalf(words[1]), upperHalf(words[1])};
    texels[i + 1] = {lowerHalf(words[2]), upperHalf(words[2]), lowerHalf(words[3]), upperHalf(words[3])};
  }
  return bilinear(texels, places.right, places.down);
}

HWY_INLINE Float4 readLevel(const CpuTexture& texture, const LevelPlaces& places) {
  FetchedTexels fetched;
  fetchTexels(texture, places, fetched);
  return filterTexels(texture, places, fetched);
}

// A share of the way from the texels of one level to those of the next.
HWY_NOINLINE Float4 readLevels(const CpuTexture& texture, const LevelPlaces* places, V share) {
  prefetchTexels(texture, places[0]);
  prefetchTexels(texture, places[1]);
  // All are fetched before any is looked at: what was stored in small parts takes a while to be loaded as a whole.
  FetchedTexels fetched[2];
  fetchTexels(texture, places[0], fetched[0]);
  fetchTexels(texture, places[1], fetched[1]);
  const Float4 finer = filterTexels(texture, places[0], fetched[0]);
  return mix4(finer, filterTexels(texture, places[1], fetched[1]), share);
}

// The level of detail before it is clamped: log2 of how many texels of the base level a pixel spans.
HWY_INLINE V levelOfDetail(const CpuTexture& texture, const Coordinates& at) {
  const V width = set(static_cast<float>(texture.width[0]));
  const V height = set(static_cast<float>(texture.height[0]));
  const auto squared = [&](V u, V v) HWY_ATTR {
    const V x = u * width;
    const V y = v * height;
    return mulAdd(x, x, y * y);
  };
  const V span = max(squared(at.uDx, at.vDx), squared(at.uDy, at.vDy));
  return set(0.5F) * hn::Log2(Tag(), clamp(span, 1e-30F, 1e30F));
}

HWY_NOINLINE Float4 sample(const CpuSlot& slot, const Coordinates& at) {
  const Tag d;
  const IntTag di;
  const Sampler& sampler = slot.sampler;
  const CpuTexture& texture = *slot.texture;
  const V detail = levelOfDetail(texture, at);
  const M minified = detail > zero();
  const M linear = hn::Or(hn::And(minified, maskOf(sampler.minLinear ? 0xffffU : 0U, 0)),
                          hn::AndNot(minified, maskOf(sampler.magLinear ? 0xffffU : 0U, 0)));
  const std::int32_t last = sampler.mipmaps ? texture.levels - 1 : 0;
  const V level = clamp(detail, 0.0F, static_cast<float>(last));
  LevelPlaces places[2];
  if (!sampler.mipLinear || last == 0) {
    // Nearest level: ceil(level + 0.5) - 1.
    const VI nearest = hn::ConvertTo(di, hn::Ceil(level - set(0.5F)));
    placeInLevel(slot, hn::Max(nearest, hn::Zero(di)), at.u, at.v, linear, places[0]);
    return readLevel(texture, places[0]);
  }
  const V floored = hn::Floor(level);
  const V share = level - floored;
  const VI fine = hn::ConvertTo(di, floored);
  placeInLevel(slot, fine, at.u, at.v, linear, places[0]);
  if (hn::AllFalse(d, share > zero())) return readLevel(texture, places[0]);
  placeInLevel(slot, hn::Min(fine + setInt(1), setInt(last)), at.u, at.v, linear, places[1]);
  return readLevels(texture, places, share);
}

} // namespace HWY_NAMESPACE
} // namespace vitrail::tool
HWY_AFTER_NAMESPACE();

#endif
