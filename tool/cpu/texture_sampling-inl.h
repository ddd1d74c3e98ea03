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

// Which texels of a level fragments read, and how much of each: upper left, upper right, lower left, lower right.
struct LevelPlaces {
  alignas(64) std::int32_t index[4][kLanes]; // the right ones only where they are no pairs
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
  storeForLanes(upper + x.first, places.index[0]);
  storeForLanes(lower + x.first, places.index[2]);
  places.arePairs = hn::AllTrue(di, x.second == x.first + setInt(1));
  if (HWY_UNLIKELY(!places.arePairs)) {
    storeForLanes(upper + x.second, places.index[1]);
    storeForLanes(lower + x.second, places.index[3]);
  }
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

// Words of the texels that one lane reads, side by side in a vector of four: of premultiplied texels, two words each,
// the upper or the lower ones (`row` 0 or 2); of others, a word each, all four. Loads of neighbours as one: they are
// faster than gathers, of which processors make more steps than that, and than what is put together in memory, since
// what was stored in small parts takes a while to be loaded as a whole.
template <bool kArePairs>
struct WordsOfLane {
  const std::uint32_t* texels;
  const LevelPlaces& places;

  HWY_INLINE const std::int32_t* at(std::size_t words, std::size_t k, std::size_t lane) const {
    return reinterpret_cast<const std::int32_t*>(texels + words * static_cast<std::size_t>(places.index[k][lane]));
  }
  HWY_INLINE Four premultiplied(std::size_t row, std::size_t lane) const {
    if constexpr (kArePairs) return loadFour(at(2, row, lane));
    return loadTwos(at(2, row, lane), at(2, row + 1, lane));
  }
  HWY_INLINE Four bytes(std::size_t lane) const {
    if constexpr (kArePairs) return loadTwos(at(1, 0, lane), at(1, 2, lane));
    const std::int32_t words[4] = {*at(1, 0, lane), *at(1, 1, lane), *at(1, 2, lane), *at(1, 3, lane)};
    return loadFour(words);
  }
};

// What is between the texels.
template <bool kArePairs>
HWY_INLINE Float4 filterTexels(const CpuTexture& texture, const LevelPlaces& places) {
  const WordsOfLane<kArePairs> lanes{texture.texels.data(), places};
  Float4 texels[4];
  VI words[4];
  if (texture.kind != Texels::Premultiplied) {
    columnsOf([&](std::size_t lane) HWY_ATTR { return lanes.bytes(lane); }, words);
    for (std::size_t i = 0; i < 4; ++i) texels[i] = unpackBytes(words[i], texture.kind == Texels::Srgb);
    return bilinear(texels, places.right, places.down);
  }
  for (std::size_t i = 0; i < 4; i += 2) {
    columnsOf([&](std::size_t lane) HWY_ATTR { return lanes.premultiplied(i, lane); }, words);
    texels[i] = {lowerHalf(words[0]), upperHalf(words[0]), lowerHalf(words[1]), upperHalf(words[1])};
    texels[i + 1] = {lowerHalf(words[2]), upperHalf(words[2]), lowerHalf(words[3]), upperHalf(words[3])};
  }
  return bilinear(texels, places.right, places.down);
}

HWY_NOINLINE Float4 readLevel(const CpuTexture& texture, const LevelPlaces& places) {
  if (HWY_LIKELY(places.arePairs)) return filterTexels<true>(texture, places);
  return filterTexels<false>(texture, places);
}

// A share of the way from the texels of one level to those of the next.
HWY_INLINE Float4 readLevels(const CpuTexture& texture, const LevelPlaces* places, V share) {
  prefetchTexels(texture, places[0]);
  prefetchTexels(texture, places[1]);
  const Float4 finer = readLevel(texture, places[0]);
  return mix4(finer, readLevel(texture, places[1]), share);
}

// The logarithm to the base of 2 of numbers above 0, at most 0.000016 off: more than any GPU's levels are made of. The
// polynomial's ends are exact, so that levels grow without steps.
HWY_INLINE V log2Of(V x) {
  const Tag d;
  const IntTag di;
  const VI bits = hn::BitCast(di, x);
  const V exponent = hn::ConvertTo(d, hn::ShiftRight<23>(bits) - setInt(127));
  const V t = hn::BitCast(d, hn::Or(hn::And(bits, setInt(0x7fffff)), setInt(0x3f800000))) - one();
  V curve = mulAdd(set(-0.0451485455F), t, set(0.1484258775F));
  curve = mulAdd(curve, t, set(-0.2671790580F));
  curve = mulAdd(curve, t, set(0.4419169963F));
  return exponent + mulAdd(t * (one() - t), curve, t);
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
  return set(0.5F) * log2Of(clamp(span, 1e-30F, 1e30F));
}

// Whether nothing is there in all lanes that are wanted, as far as the grid tells. Large parts of sprites are empty,
// and to find nothing there takes a tenth of what it takes to sample it.
HWY_INLINE bool isEmptyAt(const CpuTexture& texture, const Coordinates& at, V detail, M wanted) {
  const Tag d;
  const IntTag di;
  const M inside = hn::And(hn::And(at.u >= zero(), at.u < one()), hn::And(at.v >= zero(), at.v < one()));
  const M known = hn::And(inside, detail <= set(static_cast<float>(CpuTexture::kEmptyLevels)));
  if (!hn::AllTrue(d, hn::Or(known, hn::Not(wanted)))) return false;
  const V cells = set(static_cast<float>(CpuTexture::kCells));
  const VI x = hn::ConvertTo(di, at.u * cells);
  const VI y = hn::ConvertTo(di, at.v * cells);
  const VI cell = hn::IfThenElseZero(hn::RebindMask(di, known), y * setInt(CpuTexture::kCells) + x);
  const M isEmpty = hn::RebindMask(d, hn::GatherIndex(di, texture.emptyCells.data(), cell) > hn::Zero(di));
  return hn::AllTrue(d, hn::Or(isEmpty, hn::Not(wanted)));
}

// What is asked for in lanes that are not wanted may be anything.
HWY_NOINLINE Float4 sample(const CpuSlot& slot, const Coordinates& at, M wanted) {
  const Tag d;
  const IntTag di;
  const Sampler& sampler = slot.sampler;
  const CpuTexture& texture = *slot.texture;
  const V detail = levelOfDetail(texture, at);
  if (!texture.emptyCells.empty() && isEmptyAt(texture, at, detail, wanted)) return {zero(), zero(), zero(), zero()};
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
