// What glTF's extensions lay over a surface, and the scene's own lights: surface_layers.glsl in vectors of fragments,
// to be read beside it. docs/shading.md states each. Included once a target.
#if defined(VITRAIL_TOOL_CPU_SURFACE_LAYERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_TOOL_CPU_SURFACE_LAYERS_INL_H
#undef VITRAIL_TOOL_CPU_SURFACE_LAYERS_INL_H
#else
#define VITRAIL_TOOL_CPU_SURFACE_LAYERS_INL_H
#endif

#include <hwy/contrib/math/math-inl.h>

#include "lanes-inl.h"
#include "shade.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::tool {
namespace HWY_NAMESPACE {

constexpr float kPi = 3.14159265358979F;

HWY_INLINE Float3 hemisphere(V y) {
  const V share = mulAdd(set(0.5F), y, set(0.5F));
  return {mulAdd(set(0.18F), share, set(0.18F)), mulAdd(set(0.21F), share, set(0.17F)),
          mulAdd(set(0.26F), share, set(0.16F))};
}

// The y of what mirrors `view` about `normal`.
HWY_INLINE V mirroredY(const Float3& normal, const Float3& view) {
  return hn::MulSub(set(2.0F) * dot(normal, view), normal.y, view.y);
}

// GGX distribution. 1 - NH^2 is taken from the cross product: near the highlight's centre the difference cancels.
HWY_INLINE V distribution(const Float3& n, const Float3& h, V a2) {
  const V nh = dot(n, h);
  const Float3 side = cross(n, h);
  const V f = select(nh > zero(), mulAdd(nh * nh, a2, dot(side, side)), one());
  return a2 / (set(kPi) * f * f);
}

// Height-correlated Smith visibility.
HWY_INLINE V visibility(V nl, V nv, V a2) {
  const V rest = one() - a2;
  const V masked = hn::Sqrt(mulAdd(nv * nv, rest, a2));
  const V shadowed = hn::Sqrt(mulAdd(nl * nl, rest, a2));
  return set(0.5F) / mulAdd(nl, masked, nv * shadowed);
}

// Schlick's weight, (1 - c)^5.
HWY_INLINE V grazing(V c) {
  const V x = max(one() - c, zero());
  const V squared = x * x;
  return squared * squared * x;
}

// How strongly a light shines at a point, and from where.
HWY_INLINE Float3 lightAt(const shaders::LightData& light, const Float3& position, Float3& l) {
  const auto kind = static_cast<std::uint32_t>(light.direction.w);
  const Float3 along = set3(light.direction);
  l = Float3{hn::Neg(along.x), hn::Neg(along.y), hn::Neg(along.z)};
  if (kind == shaders::LIGHT_DIRECTIONAL) return set3(light.intensity);
  const Float3 way = set3(light.position) - position;
  const V squared = dot(way, way);
  l = direction(way, l);
  const V relative = squared * set(light.position.w) * set(light.position.w);
  const V window = clamp(hn::NegMulAdd(relative, relative, one()), 0.0F, 1.0F);
  V share = hn::IfThenElseZero(squared > zero(), window / squared);
  if (kind == shaders::LIGHT_SPOT) {
    const V cone = clamp(mulAdd(hn::Neg(dot(l, along)), set(light.cone.x), set(light.cone.y)), 0.0F, 1.0F);
    share = share * cone * cone;
  }
  return set3(light.intensity) * share;
}

// KHR_materials_clearcoat: a layer of varnish with an index of 1.5.
struct Coat {
  Float3 normal;
  V a2;
  V share; // of the light that it reflects, straight from the surface to the eye
};

HWY_INLINE Coat coatOf(const shaders::MaterialData& material, const Float3& normal, const Float3& view, V factor,
                       V roughness) {
  const V r = clamp(set(material.clearcoatRoughness) * roughness, 0.045F, 1.0F);
  const V fresnel = mulAdd(set(0.96F), grazing(max(dot(normal, view), set(0.0001F))), set(0.04F));
  const V a = r * r;
  return {normal, a * a, clamp(set(material.clearcoat) * factor, 0.0F, 1.0F) * fresnel};
}

HWY_INLINE V coatLobe(const Coat& coat, const Float3& view, const Float3& l) {
  const V nl = max(dot(coat.normal, l), zero());
  const Float3 h = direction(l + view, coat.normal);
  const V nv = max(dot(coat.normal, view), set(0.0001F));
  const V lobe = nl * distribution(coat.normal, h, coat.a2) * visibility(nl, nv, coat.a2);
  return hn::IfThenElseZero(nl > zero(), lobe);
}

// KHR_materials_sheen: fibres that stand up.
struct Sheen {
  Float3 color;
  V roughness;
  V albedo; // what a white sheen reflects of light from everywhere
  V leaves; // the share of the light that is left to what is below
};

HWY_INLINE V sheenLobe(const Sheen& sheen, const Float3& n, const Float3& h, V nl, V nv) {
  const Tag d;
  const V power = one() / (sheen.roughness * sheen.roughness);
  const Float3 across = cross(n, h);
  // The power of the sine is half that of its square. Below 1e-30 it is 0 with any power that there is.
  const V squared = clamp(dot(across, across), 1e-30F, 1.0F);
  const V exponent = max(set(0.5F) * power * hn::Log(d, squared), set(-87.0F));
  const V raised = hn::IfThenElseZero(exponent > set(-86.0F), hn::Exp(d, exponent));
  const V spread = set(4.0F) * (nl + hn::NegMulAdd(nl, nv, nv));
  return (set(2.0F) + power) * raised / (set(2.0F * kPi) * spread);
}

// What a white sheen reflects of light from everywhere: the table of docs/shading.md. Columns are the cosine from the
// normal, rows the roughness, both 0, 1/7, ... 1.
HWY_INLINE V sheenAlbedo(V roughness, V cosine) {
  static constexpr float kAlbedo[64] = {
      1.000F, 0.316F, 0.014F, 0.000F, 0.000F, 0.000F, 0.000F, 0.000F, 1.000F, 0.646F, 0.170F, 0.037F, 0.006F,
      0.001F, 0.000F, 0.000F, 1.000F, 0.667F, 0.353F, 0.182F, 0.086F, 0.035F, 0.010F, 0.001F, 1.000F, 0.598F,
      0.392F, 0.257F, 0.163F, 0.095F, 0.048F, 0.016F, 0.848F, 0.543F, 0.394F, 0.289F, 0.209F, 0.144F, 0.092F,
      0.049F, 0.741F, 0.504F, 0.388F, 0.303F, 0.236F, 0.179F, 0.129F, 0.085F, 0.675F, 0.478F, 0.381F, 0.310F,
      0.252F, 0.202F, 0.158F, 0.116F, 0.633F, 0.460F, 0.376F, 0.314F, 0.263F, 0.219F, 0.179F, 0.141F};
  const Tag d;
  const IntTag di;
  const V row = set(7.0F) * roughness;
  const V column = set(7.0F) * clamp(cosine, 0.0F, 1.0F);
  const VI r = hn::Min(hn::ConvertTo(di, row), setInt(6));
  const VI c = hn::Min(hn::ConvertTo(di, column), setInt(6));
  const V down = row - hn::ConvertTo(d, r);
  const V right = column - hn::ConvertTo(d, c);
  const VI at = hn::ShiftLeft<3>(r) + c;
  const V upper = mix(hn::GatherIndex(d, kAlbedo, at), hn::GatherIndex(d, kAlbedo, at + setInt(1)), right);
  const V lower = mix(hn::GatherIndex(d, kAlbedo, at + setInt(8)), hn::GatherIndex(d, kAlbedo, at + setInt(9)), right);
  return mix(upper, lower, down);
}

HWY_INLINE Sheen sheenOf(const shaders::MaterialData& material, const Float3& color, V roughness, V nv) {
  Sheen sheen;
  sheen.color = set3(material.sheen) * color;
  sheen.roughness = clamp(set(material.sheen.a) * roughness, 0.07F, 1.0F);
  sheen.albedo = sheenAlbedo(sheen.roughness, nv);
  sheen.leaves = hn::NegMulAdd(min(largest(sheen.color), one()), sheen.albedo, one());
  return sheen;
}

// KHR_materials_anisotropy: fine grooves, which stretch the highlight across them.
struct Grooves {
  Float3 tangent;
  Float3 bitangent;
  V along; // the roughness a along the tangent and across it
  V across;
};

// A tangent of unit length, and which way the bitangent goes: w times the cross product of normal and tangent.
struct Tangent {
  Float3 along;
  V w;
};

// `texel`: the direction in red and green, the strength in blue.
HWY_INLINE Grooves groovesOf(const shaders::MaterialData& material, const Tangent& tangent, const Float3& normal,
                             V roughness, const Float3& texel) {
  const V x = hn::MulSub(texel.x, set(2.0F), one());
  const V y = hn::MulSub(texel.y, set(2.0F), one());
  const V c = set(material.anisotropy.y);
  const V s = set(material.anisotropy.z);
  const V turnedX = x * c - y * s;
  const V turnedY = x * s + y * c;
  const Float3 bitangent = cross(normal, tangent.along) * tangent.w;
  const Float3 t = direction(tangent.along * turnedX + bitangent * turnedY, tangent.along);
  const V a = roughness * roughness;
  const V strength = clamp(set(material.anisotropy.x) * texel.z, 0.0F, 1.0F);
  return {t, cross(normal, t), mix(a, one(), strength * strength), a};
}

HWY_INLINE V groovesLobe(const Grooves& g, const Float3& n, const Float3& v, const Float3& l, const Float3& h) {
  const V nl = max(dot(n, l), zero());
  const V nv = max(dot(n, v), set(0.0001F));
  const V both = g.along * g.across;
  // As distribution() does, without the difference that cancels near the highlight's centre.
  const Float3 f{g.across * dot(g.tangent, h), g.along * dot(g.bitangent, h), both * dot(n, h)};
  const V w = both / dot(f, f);
  const Float3 eye{g.along * dot(g.tangent, v), g.across * dot(g.bitangent, v), nv};
  const Float3 light{g.along * dot(g.tangent, l), g.across * dot(g.bitangent, l), nl};
  const V spread = nl * hn::Sqrt(dot(eye, eye)) + nv * hn::Sqrt(dot(light, light));
  return both * w * w * set(0.5F / kPi) / spread;
}

// One wave of what the eye makes of light that a path difference leaves.
HWY_INLINE V interferenceWave(float height, float middle, float width, V phase, V shift) {
  const Tag d;
  const float scale = height * __builtin_sqrtf(2.0F * kPi * width);
  const V fading = hn::Exp(d, max(hn::Neg(phase * phase) * set(width), set(-87.0F)));
  return set(scale) * hn::Cos(d, mulAdd(set(middle), phase, shift)) * fading;
}

// What the eye makes of light that a path difference (nanometres) and a shift of its phase leave.
HWY_INLINE Float3 interference(V difference, const Float3& shift) {
  const V phase = set(2.0F * kPi * 1.0e-9F) * difference;
  const V x = interferenceWave(5.4856e-13F, 1.6810e+06F, 4.3278e+09F, phase, shift.x) +
              interferenceWave(9.7470e-14F, 2.2399e+06F, 4.5282e+09F, phase, shift.x);
  const V y = interferenceWave(4.4201e-13F, 1.7953e+06F, 9.3046e+09F, phase, shift.y);
  const V z = interferenceWave(5.2481e-13F, 2.2084e+06F, 6.6121e+09F, phase, shift.z);
  const auto row = [&](float a, float b, float c)
                       HWY_ATTR { return (set(a) * x + set(b) * y + set(c) * z) * set(1.0F / 1.0685e-7F); };
  return {row(3.2404542F, -1.5371385F, -0.4985314F), row(-0.9692660F, 1.8760108F, 0.0415560F),
          row(0.0556434F, -0.2040259F, 1.0572252F)};
}

// KHR_materials_iridescence: what a film of some nanometres reflects, over a surface that reflects `f0`, seen at a
// cosine from its normal.
HWY_NOINLINE Float3 filmReflection(const Float3& f0, V cosine, float filmIndex, V thickness) {
  const V edge = clamp(thickness * set(1.0F / 0.03F), 0.0F, 1.0F);
  const V smooth = edge * edge * (set(3.0F) - set(2.0F) * edge);
  const V index = mix(one(), set(filmIndex), smooth);
  const V squared = one() - (one() - cosine * cosine) / (index * index);
  const V below = hn::Sqrt(max(squared, zero()));
  V top0 = (index - one()) / (index + one());
  top0 = top0 * top0;
  const V top = mulAdd(one() - top0, grazing(cosine), top0);
  const V left = one() - top;
  const V turned = hn::IfThenElseZero(index >= one(), set(kPi));
  const V difference = set(2.0F) * index * thickness * below;
  Float3 bottom;
  Float3 shift;
  const auto perChannel = [&](V straight, V& reflected, V& phase) HWY_ATTR {
    const V root = hn::Sqrt(clamp(straight, 0.0F, 0.9999F));
    const V base = (one() + root) / (one() - root); // its index
    V bottom0 = (base - index) / (base + index);
    bottom0 = bottom0 * bottom0;
    reflected = mulAdd(one() - bottom0, grazing(below), bottom0);
    phase = turned + hn::IfThenElseZero(base < index, set(kPi));
  };
  perChannel(f0.x, bottom.x, shift.x);
  perChannel(f0.y, bottom.y, shift.y);
  perChannel(f0.z, bottom.z, shift.z);
  const auto reflects = [&](V reflected, V& both) HWY_ATTR {
    both = clamp(top * reflected, 1.0e-5F, 0.9999F);
    return left * left * reflected / (one() - both);
  };
  Float3 both;
  const Float3 passed{reflects(bottom.x, both.x), reflects(bottom.y, both.y), reflects(bottom.z, both.z)};
  Float3 sum = all(top) + passed;
  Float3 order = passed - all(left);
  const Float3 less{hn::Sqrt(both.x), hn::Sqrt(both.y), hn::Sqrt(both.z)};
  for (int m = 1; m <= 2; ++m) {
    const V times = set(static_cast<float>(m));
    order = order * less;
    sum = sum + order * interference(times * difference, shift * times) * set(2.0F);
  }
  sum = {clamp(sum.x, 0.0F, 1.0F), clamp(sum.y, 0.0F, 1.0F), clamp(sum.z, 0.0F, 1.0F)};
  return select(squared < zero(), all(one()), sum);
}

} // namespace HWY_NAMESPACE
} // namespace vitrail::tool
HWY_AFTER_NAMESPACE();

#endif
