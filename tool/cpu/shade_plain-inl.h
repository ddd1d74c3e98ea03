// Shades the plainest of lit surfaces, which large models and the transparent ones of most scenes are made of: smooth
// triangles with one material, lit by the tool's own light. The same formulas as in shade_surface-inl.h, with all that
// is the same for a surface worked out beforehand. Included once a target.
#if defined(VITRAIL_TOOL_CPU_SHADE_PLAIN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_TOOL_CPU_SHADE_PLAIN_INL_H
#undef VITRAIL_TOOL_CPU_SHADE_PLAIN_INL_H
#else
#define VITRAIL_TOOL_CPU_SHADE_PLAIN_INL_H
#endif

#include "corners-inl.h"
#include "surface_layers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::tool {
namespace HWY_NAMESPACE {

// Of unit length, turned to the side that is seen, and on the eye's side where it is no vector at all.
HWY_INLINE Float3 plainNormal(const ShadeDraw& draw, const Corners& corners, const CornerValues* normals,
                              const Places& places, M front, const Float3& view) {
  Float3 n = interpolate3(corners, normals, places);
  if (!draw.keepsDirections) {
    n = {dot(n, set3(draw.normals[0])), dot(n, set3(draw.normals[1])), dot(n, set3(draw.normals[2]))};
  }
  const V squared = dot(n, n);
  const V scale = inverseSqrt(squared);
  return select(squared > zero(), n * select(front, scale, hn::Neg(scale)), view);
}

// What the tool's own light, of strength 2, and the ambient light make of one channel: `k` is 2 NL, `lobe` D Vis,
// `schlick` and `grazed` are Schlick's weights for the light and the eye, `up` and `mirroredUp` how far the
// hemisphere's share of the sky goes.
HWY_INLINE V plainChannel(const PlainSurface& plain, int c, V k, V lobe, V schlick, V grazed, V up, V mirroredUp) {
  constexpr float kLow[3] = {0.18F, 0.17F, 0.16F};
  constexpr float kRise[3] = {0.18F, 0.21F, 0.26F};
  const V scattered = set(plain.diffuseOverPi[c]);
  const V fresnel = mulAdd(set(plain.rest[c]), schlick, set(plain.f0[c]));
  const V direct = mulAdd(fresnel, lobe - scattered, scattered);
  const V mirror = mulAdd(set(plain.ambientRise[c]), grazed, set(plain.f0[c]));
  const V around = mulAdd(set(kRise[c]), mirroredUp, set(kLow[c]));
  const V ambient = mulAdd(mirror, around, mulAdd(set(plain.ambientSky[c]), up, set(plain.ambientAndOwn[c])));
  return mulAdd(k, direct, ambient);
}

HWY_INLINE void shadePlainLanes(const ShadeDraw& draw, const Corners& corners, const CornerValues* normals,
                                VitrailCpuFragments& fragments, std::size_t lane) {
  const Tag d;
  const ShadeFrame& frame = *draw.frame;
  const PlainSurface& plain = draw.surface->plain;
  const Places places = placesOf(fragments, corners, draw.surface->mesh, lane);
  Float3 v = set3(frame.data.cameraToWorld[2]);
  if (frame.data.eye.w < 0.5F) v = direction(toEye(frame, fragments, lane), v);
  const M front = maskOf(fragments.front ^ draw.flipped, lane);
  const Float3 n = plainNormal(draw, corners, normals, places, front, v);
  const Float3 l = set3(frame.data.toLight);
  const V nlSigned = dot(n, l);
  const V nvSigned = dot(n, v);
  const V nl = max(nlSigned, zero());
  const V nv = max(nvSigned, set(0.0001F));
  const Float3 half = l + v; // times what makes it unit length
  const V halfSquared = max(dot(half, half), set(1e-12F));
  const V scale = inverseSqrt(halfSquared);
  const V nh = (nlSigned + nvSigned) * scale;
  const V vh = set(0.5F) * halfSquared * scale;
  const Float3 side = cross(n, half) * scale;
  const V a2 = set(plain.a2);
  const V rest = set(1.0F - plain.a2);
  const V f = select(nh > zero(), mulAdd(nh * nh, a2, dot(side, side)), one());
  const V masked = nl * hn::Sqrt(mulAdd(nv * nv, rest, a2));
  const V shadowed = nv * hn::Sqrt(mulAdd(nl * nl, rest, a2));
  const V lobe = set(plain.a2 * (0.5F / kPi)) / (f * f * (masked + shadowed));
  const V half1 = set(0.5F);
  const V up = mulAdd(half1, n.y, half1);
  const V mirroredUp = mulAdd(half1, hn::MulSub(nvSigned + nvSigned, n.y, v.y), half1);
  const V schlick = grazing(vh);
  const V grazed = grazing(nv);
  const V k = nl + nl;
  for (int c = 0; c < 3; ++c) {
    const V color = plainChannel(plain, c, k, lobe, schlick, grazed, up, mirroredUp);
    hn::StoreU(color, d, fragments.color[c] + lane);
  }
  hn::StoreU(set(plain.alpha), d, fragments.color[3] + lane);
}

void shadePlain(void* user, VitrailCpuFragments* fragments) {
  const ShadeDraw& draw = *static_cast<const ShadeDraw*>(user);
  const ShadeMesh& mesh = draw.surface->mesh;
  Corners corners;
  findCorners(*fragments, mesh, corners);
  CornerValues normals[3];
  fetchDirections(corners, mesh.normals, normals);
  for (std::size_t lane = 0; lane < VITRAIL_CPU_LANES; lane += kLanes) {
    if ((fragments->mask >> lane & ((1U << kLanes) - 1U)) == 0) continue;
    shadePlainLanes(draw, corners, normals, *fragments, lane);
  }
}

} // namespace HWY_NAMESPACE
} // namespace vitrail::tool
HWY_AFTER_NAMESPACE();

#endif
