// Samples textures as the Vulkan specification states it ("Image Sample Operations"). Included once a target.
#if defined(VITRAIL_TOOL_CPU_TEXTURE_SAMPLING_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_TOOL_CPU_TEXTURE_SAMPLING_INL_H
#undef VITRAIL_TOOL_CPU_TEXTURE_SAMPLING_INL_H
#else
#define VITRAIL_TOOL_CPU_TEXTURE_SAMPLING_INL_H
#endif

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

// Red, green, blue and alpha of some texels.
HWY_INLINE Float4 texelsAt(const CpuTexture& texture, VI index) {
  const Tag d;
  const IntTag di;
  const VI word = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(texture.texels.data()), index);
  if (texture.kind == Texels::Premultiplied) {
    const VI other = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(texture.blueAlpha.data()), index);
    return {fromHalf(word), fromHalf(hn::ShiftRight<16>(word)), fromHalf(other), fromHalf(hn::ShiftRight<16>(other))};
  }
  const VI byte = setInt(255);
  const VI r = hn::And(word, byte);
  const VI g = hn::And(hn::ShiftRight<8>(word), byte);
  const VI b = hn::And(hn::ShiftRight<16>(word), byte);
  const V scale = set(1.0F / 255.0F);
  const V alpha = hn::ConvertTo(d, hn::And(hn::ShiftRight<24>(word), byte)) * scale;
  if (texture.kind == Texels::Srgb) {
    return {fromSrgbCode(r), fromSrgbCode(g), fromSrgbCode(b), alpha};
  }
  return {hn::ConvertTo(d, r) * scale, hn::ConvertTo(d, g) * scale, hn::ConvertTo(d, b) * scale, alpha};
}

HWY_INLINE Float4 mix4(const Float4& a, const Float4& b, V share) {
  return {mix(a.x, b.x, share), mix(a.y, b.y, share), mix(a.z, b.z, share), mix(a.w, b.w, share)};
}

HWY_NOINLINE Float4 sampleLevel(const CpuSlot& slot, VI level, V u, V v, M linear) {
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
  if (hn::AllFalse(Tag(), linear)) return texelsAt(texture, upper + x.first);
  const VI lower = offset + y.second * width;
  const Float4 above = mix4(texelsAt(texture, upper + x.first), texelsAt(texture, upper + x.second), x.weight);
  const Float4 below = mix4(texelsAt(texture, lower + x.first), texelsAt(texture, lower + x.second), x.weight);
  return mix4(above, below, y.weight);
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
  const V detail = levelOfDetail(*slot.texture, at);
  const M minified = detail > zero();
  const M linear = hn::Or(hn::And(minified, maskOf(sampler.minLinear ? 0xffffU : 0U, 0)),
                          hn::AndNot(minified, maskOf(sampler.magLinear ? 0xffffU : 0U, 0)));
  const std::int32_t last = sampler.mipmaps ? slot.texture->levels - 1 : 0;
  const V level = clamp(detail, 0.0F, static_cast<float>(last));
  if (!sampler.mipLinear || last == 0) {
    // Nearest level: ceil(level + 0.5) - 1.
    const VI nearest = hn::ConvertTo(di, hn::Ceil(level - set(0.5F)));
    return sampleLevel(slot, hn::Max(nearest, hn::Zero(di)), at.u, at.v, linear);
  }
  const V floored = hn::Floor(level);
  const V share = level - floored;
  const VI fine = hn::ConvertTo(di, floored);
  const Float4 finer = sampleLevel(slot, fine, at.u, at.v, linear);
  if (hn::AllFalse(d, share > zero())) return finer;
  const VI coarse = hn::Min(fine + setInt(1), setInt(last));
  return mix4(finer, sampleLevel(slot, coarse, at.u, at.v, linear), share);
}

} // namespace HWY_NAMESPACE
} // namespace vitrail::tool
HWY_AFTER_NAMESPACE();

#endif
