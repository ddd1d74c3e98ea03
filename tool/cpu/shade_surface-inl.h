// Shades any surface: surface.vert and surface.glsl in vectors of fragments, to be read beside them. Included once a
// target.
#if defined(VITRAIL_TOOL_CPU_SHADE_SURFACE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRAIL_TOOL_CPU_SHADE_SURFACE_INL_H
#undef VITRAIL_TOOL_CPU_SHADE_SURFACE_INL_H
#else
#define VITRAIL_TOOL_CPU_SHADE_SURFACE_INL_H
#endif

#include "corners-inl.h"
#include "surface_layers-inl.h"
#include "texture_sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::tool {
namespace HWY_NAMESPACE {

constexpr std::uint32_t slotBit(std::uint32_t slot) { return 1U << slot; }

// The features that a surface has of those that a function is made for: what a function is not made for costs it
// nothing.
template <std::uint32_t kPossible>
struct Features {
  std::uint32_t bits;
  bool has(std::uint32_t feature) const { return (kPossible & feature) != 0 && (bits & feature) != 0; }
  bool hasTexture(std::uint32_t slot) const { return has(slotBit(slot)); }
};

constexpr std::uint32_t kTextureFeatures = (1U << shaders::SLOT_COUNT) - 1U;

// What the corners of a call's triangles have, of what its surface asks for.
struct CornerAttributes {
  CornerValues position[3];
  CornerValues normal[3];
  CornerValues tangent[4];
  CornerValues texCoord[2][2];
  CornerValues color[4];
};

// Which attributes that are.
struct Asked {
  bool position = false;
  bool normal = false;
  bool tangent = false;
  bool texCoord[2] = {false, false};
  bool color = false;
};

template <std::uint32_t kPossible>
HWY_INLINE Asked askedOf(const ShadeSurface& surface, Features<kPossible> features) {
  Asked asked;
  const bool isLit = !features.has(shaders::FEATURE_UNLIT);
  const bool flat = features.has(shaders::FEATURE_FLAT);
  const bool triangles = surface.mesh.corners == 3;
  asked.position = isLit && (flat || !triangles || features.has(shaders::FEATURE_LIGHTS));
  asked.normal = isLit && !flat && surface.mesh.normals != nullptr;
  asked.tangent = isLit && surface.mesh.tangents != nullptr &&
                  (features.hasTexture(shaders::SLOT_NORMAL) || features.has(shaders::FEATURE_RARE));
  asked.color = features.has(shaders::FEATURE_VERTEX_COLOR);
  for (std::uint32_t textures = features.bits & kPossible & kTextureFeatures; textures != 0; textures &= textures - 1) {
    const std::uint32_t slot = static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(textures));
    asked.texCoord[surface.material.slots[slot].row0.w > 0.5F ? 1 : 0] = true;
  }
  return asked;
}

HWY_INLINE void fetchAttributes(const ShadeMesh& mesh, const Asked& asked, const Corners& corners,
                                CornerAttributes& to) {
  if (asked.position) {
    for (int i = 0; i < 3; ++i) fetch(corners, &mesh.positions->x + i, 3, to.position[i]);
  }
  if (asked.normal) fetchDirections(corners, mesh.normals, to.normal);
  if (asked.tangent) fetchTangents(corners, mesh.tangents, to.tangent);
  if (asked.color) fetchColors(corners, mesh.colors, to.color);
  const glm::vec2* const texCoords[2] = {mesh.texCoords0, mesh.texCoords1};
  for (int set = 0; set < 2; ++set) {
    if (!asked.texCoord[set] || texCoords[set] == nullptr) continue;
    for (int i = 0; i < 2; ++i) fetch(corners, &texCoords[set]->x + i, 2, to.texCoord[set][i]);
  }
}

// A surface at some fragments: what surface.glsl has as inputs and as Texels.
struct Point {
  Float3 position;
  Float3 view;
  Float3 plane; // of a flat triangle: its normal, on one side or the other
  Float3 inNormal;
  Float4 inTangent;
  M front;
};

struct TexelSet {
  Float4 base;
  Float4 metallicRoughness; // or specular colour and glossiness
  Float3 normal;
  V occlusion;
  Float3 emissive;
  V transmission;
  V specular;
  Float3 specularColor;
  V clearcoat;
  V clearcoatRoughness;
  Float3 sheenColor;
  V sheenRoughness;
  Float3 anisotropy;
  V iridescence;
  V iridescenceThickness;
  V thickness;
};

HWY_INLINE Float3 columns(const glm::mat3& matrix, const Float3& v) {
  return {dot(v, set3(matrix[0])), dot(v, set3(matrix[1])), dot(v, set3(matrix[2]))};
}

// Two numbers times a row of a texture's transform, without what it adds.
HWY_INLINE V turned(const glm::vec4& row, const V* v) { return mulAdd(set(row.x), v[0], set(row.y) * v[1]); }

// Where a slot is sampled.
HWY_INLINE Coordinates coordinatesOf(const VitrailCpuFragments& fragments, const ShadeSurface& surface,
                                     const Corners& corners, const CornerAttributes& attributes, const Places& places,
                                     std::uint32_t slot, std::size_t lane) {
  const Tag d;
  const shaders::SlotData& rows = surface.material.slots[slot];
  const int which = rows.row0.w > 0.5F ? 1 : 0;
  const bool there = (which == 0 ? surface.mesh.texCoords0 : surface.mesh.texCoords1) != nullptr;
  V value[2] = {zero(), zero()};
  V dx[2] = {zero(), zero()};
  V dy[2] = {zero(), zero()};
  for (int i = 0; i < 2 && there; ++i) {
    const CornerValues& values = attributes.texCoord[which][i];
    const V a = valueAt(corners, values, places.first, 0);
    const V b = valueAt(corners, values, places.first, 1);
    const V c = valueAt(corners, values, places.first, 2);
    value[i] = mulAdd(c, places.third, mulAdd(b, places.second, a * places.weight));
    if (surface.mesh.corners < 2) continue;
    dx[i] = (b - a) * hn::LoadU(d, fragments.secondDx + lane);
    dy[i] = (b - a) * hn::LoadU(d, fragments.secondDy + lane);
    if (surface.mesh.corners < 3) continue;
    dx[i] = mulAdd(c - a, hn::LoadU(d, fragments.thirdDx + lane), dx[i]);
    dy[i] = mulAdd(c - a, hn::LoadU(d, fragments.thirdDy + lane), dy[i]);
  }
  return {turned(rows.row0, value) + set(rows.row0.z),
          turned(rows.row1, value) + set(rows.row1.z),
          turned(rows.row0, dx),
          turned(rows.row1, dx),
          turned(rows.row0, dy),
          turned(rows.row1, dy)};
}

// What a surface's textures hold, of those that it has.
template <std::uint32_t kPossible>
HWY_INLINE TexelSet sampleTextures(const VitrailCpuFragments& fragments, const ShadeSurface& surface,
                                   Features<kPossible> features, const Corners& corners,
                                   const CornerAttributes& attributes, const Places& places, std::size_t lane) {
  const auto texel = [&](std::uint32_t slot) HWY_ATTR {
    if (!features.hasTexture(slot)) return Float4{one(), one(), one(), one()};
    return sample(surface.slots[slot], coordinatesOf(fragments, surface, corners, attributes, places, slot, lane),
                  maskOf(fragments.mask, lane));
  };
  const auto rgb = [&](std::uint32_t slot) HWY_ATTR {
    const Float4 t = texel(slot);
    return Float3{t.x, t.y, t.z};
  };
  TexelSet t;
  t.base = texel(shaders::SLOT_BASE_COLOR);
  if (features.has(shaders::FEATURE_PREMULTIPLIED)) {
    // Colours times alpha were filtered, so that those of texels that are not there do not show.
    const M there = t.base.w > zero();
    const V scale = hn::IfThenElseZero(there, one() / t.base.w);
    t.base = {t.base.x * scale, t.base.y * scale, t.base.z * scale, t.base.w};
  }
  t.metallicRoughness = texel(shaders::SLOT_METALLIC_ROUGHNESS);
  t.normal = rgb(shaders::SLOT_NORMAL);
  t.occlusion = texel(shaders::SLOT_OCCLUSION).x;
  t.emissive = rgb(shaders::SLOT_EMISSIVE);
  t.transmission = texel(shaders::SLOT_TRANSMISSION).x;
  t.specular = texel(shaders::SLOT_SPECULAR).w;
  t.specularColor = rgb(shaders::SLOT_SPECULAR_COLOR);
  t.clearcoat = texel(shaders::SLOT_CLEARCOAT).x;
  t.clearcoatRoughness = texel(shaders::SLOT_CLEARCOAT_ROUGHNESS).y;
  t.sheenColor = rgb(shaders::SLOT_SHEEN_COLOR);
  t.sheenRoughness = texel(shaders::SLOT_SHEEN_ROUGHNESS).w;
  t.anisotropy =
      features.hasTexture(shaders::SLOT_ANISOTROPY) ? rgb(shaders::SLOT_ANISOTROPY) : Float3{one(), set(0.5F), one()};
  t.iridescence = texel(shaders::SLOT_IRIDESCENCE).x;
  t.iridescenceThickness = texel(shaders::SLOT_IRIDESCENCE_THICKNESS).y;
  t.thickness = texel(shaders::SLOT_THICKNESS).y;
  return t;
}

// Where on a lit surface fragments are, as surface.vert and the rasteriser of a GPU give it.
template <std::uint32_t kPossible>
HWY_INLINE Point pointOf(const VitrailCpuFragments& fragments, const ShadeDraw& draw, Features<kPossible> features,
                         const Asked& asked, const Corners& corners, const CornerAttributes& attributes,
                         const Places& places, std::size_t lane) {
  const ShadeFrame& frame = *draw.frame;
  Point point;
  point.front = maskOf((fragments.front ^ draw.flipped) | draw.front, lane);
  point.position = all(zero());
  point.plane = all(zero());
  if (asked.position) {
    const Float3 local = interpolate3(corners, attributes.position, places);
    const auto row = [&](const glm::vec4& r) HWY_ATTR { return dot(local, set3(r)) + set(r.w); };
    point.position = {row(draw.rows[0]), row(draw.rows[1]), row(draw.rows[2])};
  }
  const Float3 backward = set3(frame.data.cameraToWorld[2]);
  if (frame.data.eye.w > 0.5F) {
    point.view = backward;
  } else if (draw.surface->mesh.corners == 3) {
    point.view = direction(toEye(frame, fragments, lane), backward);
  } else {
    point.view = direction(set3(frame.data.eye) - point.position, backward);
  }
  if (features.has(shaders::FEATURE_FLAT)) {
    Float3 corner[3];
    for (int i = 0; i < 3; ++i) {
      corner[i] = {valueAt(corners, attributes.position[0], places.first, i),
                   valueAt(corners, attributes.position[1], places.first, i),
                   valueAt(corners, attributes.position[2], places.first, i)};
    }
    // Differences in the mesh's own space: there they are exact, however far away the draw is.
    point.plane = columns(draw.normals, normalOfPlane(corner[1] - corner[0], corner[2] - corner[0]));
  }
  const Float3 normal = asked.normal ? interpolate3(corners, attributes.normal, places) : Float3{zero(), zero(), one()};
  point.inNormal = columns(draw.normals, normal);
  const V sign = asked.tangent ? interpolate(corners, attributes.tangent[3], places) : one();
  const Float3 tangent =
      asked.tangent ? interpolate3(corners, attributes.tangent, places) : Float3{one(), zero(), zero()};
  const Float3 turnedTangent = columns(draw.tangents, tangent);
  point.inTangent = {turnedTangent.x, turnedTangent.y, turnedTangent.z, sign * set(draw.mirrored)};
  return point;
}

// The normal without the normal map, on the side that is seen.
template <std::uint32_t kPossible>
HWY_INLINE Float3 smoothNormal(const Point& point, Features<kPossible> features) {
  if (features.has(shaders::FEATURE_FLAT)) {
    const V side = hn::CopySign(one(), dot(point.plane, point.view));
    return direction(point.plane * side, point.view);
  }
  const Float3 normal = direction(point.inNormal, point.view);
  return normal * select(point.front, one(), set(-1.0F));
}

// The tangent that goes with a normal.
HWY_INLINE Tangent tangentOf(const Point& point, const Float3& normal) {
  const M steep = hn::Abs(normal.x) < set(0.9F);
  const Float3 axis{hn::IfThenElseZero(steep, one()), hn::IfThenZeroElse(steep, one()), zero()};
  const Float3 other = cross(axis, normal);
  const Float3 along{point.inTangent.x, point.inTangent.y, point.inTangent.z};
  const Float3 tangent = direction(along - normal * dot(normal, along), other * inverseSqrt(dot(other, other)));
  return {tangent, select(point.inTangent.w < zero(), set(-1.0F), one())};
}

// The normal map's normal on the side that is seen, as the other one is. `sampled` is its texel.
HWY_INLINE Float3 mappedNormal(const Point& point, const Float3& smoothly, const Float3& sampled, float scale) {
  const V side = select(point.front, one(), set(-1.0F));
  const Float3 normal = smoothly * side;
  const Tangent tangent = tangentOf(point, normal);
  const Float3 bitangent = cross(normal, tangent.along) * tangent.w;
  const V x = hn::MulSub(sampled.x, set(2.0F), one()) * set(scale);
  const V y = hn::MulSub(sampled.y, set(2.0F), one()) * set(scale);
  const V z = hn::MulSub(sampled.z, set(2.0F), one());
  return direction(tangent.along * x + bitangent * y + normal * z, normal) * side;
}

// A lit surface: what its light is reflected by.
struct Lit {
  Float3 normal;
  Float3 view;
  Float3 diffuse; // scattered back
  Float3 f0;      // reflected straight on
  Float3 f90;     // at grazing angles
  V roughness;
  V occlusion;
  V ambientShare; // of the diffuse ambient light: what a strong reflection leaves
  Sheen sheen;
  Coat coat;
  Grooves grooves;
  Float3 film; // FEATURE_RARE: what a thin film reflects, and its share
  V filmShare;
  Float3 through; // FEATURE_RARE: scattered to the other side
};

// Adds a light that shines from `l` with the strength `light`.
template <std::uint32_t kPossible>
HWY_INLINE void addLight(const Lit& s, Features<kPossible> features, const Float3& l, const Float3& light,
                         Float3& color, Float3& coat) {
  const V cosine = dot(s.normal, l);
  const V nl = max(cosine, zero());
  if (features.has(shaders::FEATURE_CLEARCOAT)) coat = mulAdd(light, coatLobe(s.coat, s.view, l), coat);
  if (features.has(shaders::FEATURE_RARE)) {
    const V behind = max(hn::Neg(cosine), zero()) * set(1.0F / kPi);
    color = color + light * (all(one()) - s.f0) * s.through * behind;
  }
  const Float3 h = direction(l + s.view, s.normal);
  const V nv = max(dot(s.normal, s.view), set(0.0001F));
  Float3 fresnel = mulAdd(s.f90 - s.f0, grazing(max(dot(s.view, h), zero())), s.f0);
  V lobe;
  if (features.has(shaders::FEATURE_RARE)) {
    fresnel = mix(fresnel, s.film, s.filmShare);
    lobe = groovesLobe(s.grooves, s.normal, s.view, l, h);
  } else {
    const V a = s.roughness * s.roughness;
    const V a2 = a * a;
    lobe = distribution(s.normal, h, a2) * visibility(nl, nv, a2);
  }
  Float3 reflected = (all(one()) - fresnel) * s.diffuse * set(1.0F / kPi) + fresnel * lobe;
  if (features.has(shaders::FEATURE_SHEEN)) {
    reflected = reflected * s.sheen.leaves + s.sheen.color * sheenLobe(s.sheen, s.normal, h, nl, nv);
  }
  const Float3 added = light * reflected * nl;
  const M lights = nl > zero();
  color = color + Float3{hn::IfThenElseZero(lights, added.x), hn::IfThenElseZero(lights, added.y),
                         hn::IfThenElseZero(lights, added.z)};
}

// What comes from a surface: the light that it reflects, and its own.
template <std::uint32_t kPossible>
HWY_INLINE Float3 lit(const Lit& s, Features<kPossible> features, const ShadeFrame& frame, const Float3& position,
                      const Float3& emissive) {
  Float3 color = all(zero());
  Float3 coat = all(zero());
  if (features.has(shaders::FEATURE_LIGHTS)) {
    for (const shaders::LightData& each : frame.lights) {
      Float3 l;
      const Float3 light = lightAt(each, position, l);
      addLight(s, features, l, light, color, coat);
    }
  } else {
    addLight(s, features, set3(frame.data.toLight), all(set(2.0F)), color, coat);
  }
  const V nv = max(dot(s.normal, s.view), set(0.0001F));
  const V rest = one() - s.roughness;
  const Float3 most{max(s.f90.x * rest, s.f0.x), max(s.f90.y * rest, s.f0.y), max(s.f90.z * rest, s.f0.z)};
  Float3 fresnel = mulAdd(most - s.f0, grazing(nv), s.f0);
  if (features.has(shaders::FEATURE_RARE)) fresnel = mix(fresnel, s.film, s.filmShare);
  const Float3 around = hemisphere(s.normal.y);
  Float3 ambient = around * s.diffuse;
  if (features.has(shaders::FEATURE_SPECULAR)) ambient = ambient * s.ambientShare;
  ambient = ambient + hemisphere(mirroredY(s.normal, s.view)) * fresnel;
  if (features.has(shaders::FEATURE_RARE)) ambient = ambient + hemisphere(hn::Neg(s.normal.y)) * s.through;
  if (features.has(shaders::FEATURE_SHEEN)) {
    ambient = ambient * s.sheen.leaves + around * s.sheen.color * s.sheen.albedo;
  }
  color = color + ambient * s.occlusion + emissive;
  if (features.has(shaders::FEATURE_CLEARCOAT)) {
    const Float3 above = coat + hemisphere(mirroredY(s.coat.normal, s.view)) * s.occlusion;
    color = mix(color, above, s.coat.share);
  }
  return color;
}

// Fills in what a surface is made of. `base` is its base or diffuse colour, `scattered` the share of its diffuse light
// that does not pass through it.
template <std::uint32_t kPossible>
HWY_INLINE void setReflection(Lit& s, Features<kPossible> features, const shaders::MaterialData& material,
                              const TexelSet& t, const Float3& base, V metallic, V scattered) {
  s.roughness = set(material.roughness) * t.metallicRoughness.y;
  s.ambientShare = one();
  if (features.has(shaders::FEATURE_SPECULAR_GLOSSINESS)) {
    s.roughness = hn::NegMulAdd(set(1.0F - material.roughness), t.metallicRoughness.w, one());
    const Float3 straight =
        set3(material.specularColor) * Float3{t.metallicRoughness.x, t.metallicRoughness.y, t.metallicRoughness.z};
    s.f0 = {min(straight.x, one()), min(straight.y, one()), min(straight.z, one())};
    s.f90 = all(one());
    s.diffuse = base * (scattered * (one() - largest(s.f0)));
  } else {
    Float3 dielectric = all(set(0.04F));
    V dielectric90 = one();
    if (features.has(shaders::FEATURE_SPECULAR)) {
      dielectric90 = set(material.specularColor.a) * t.specular;
      const Float3 reflected = set3(material.reflectance * glm::vec3(material.specularColor)) * t.specularColor;
      dielectric = Float3{min(reflected.x, one()), min(reflected.y, one()), min(reflected.z, one())} * dielectric90;
      s.ambientShare = min((one() - largest(dielectric)) * set(1.0F / 0.96F), one());
    }
    s.f0 = mix(dielectric, base, metallic);
    s.f90 = all(mix(dielectric90, one(), metallic));
    s.diffuse = base * (scattered * (one() - metallic));
  }
  s.roughness = clamp(s.roughness, 0.045F, 1.0F);
  if (features.has(shaders::FEATURE_RARE)) {
    const float share = material.diffuseTransmission.a;
    s.through = set3(share * glm::vec3(material.diffuseTransmission)) * (scattered * (one() - metallic));
    s.diffuse = s.diffuse * set(1.0F - share);
    const V thickness = mix(set(material.iridescence.z), set(material.iridescence.w), t.iridescenceThickness);
    const V nv = max(dot(s.normal, s.view), set(0.0001F));
    s.film = filmReflection(s.f0, min(nv, one()), material.iridescence.y, thickness);
    s.filmShare = clamp(set(material.iridescence.x) * t.iridescence, 0.0F, 1.0F);
  }
}

// A surface at some fragments, as docs/shading.md states it.
struct Shaded {
  Float3 color;
  V alpha;     // how much of the surface is there
  Float3 tint; // of what passes through
  V passes;    // the share of the light behind that passes; 0 without FEATURE_TRANSMISSION
};

template <std::uint32_t kPossible>
HWY_INLINE Shaded shadeLit(const ShadeDraw& draw, Features<kPossible> features, const Point& point, const TexelSet& t,
                           const Float3& base, V alpha) {
  const shaders::MaterialData& material = draw.surface->material;
  V metallic = clamp(set(material.metallic) * t.metallicRoughness.z, 0.0F, 1.0F);
  if (features.has(shaders::FEATURE_SPECULAR_GLOSSINESS)) metallic = zero();
  const V transmission = features.has(shaders::FEATURE_TRANSMISSION)
                             ? clamp(set(material.transmission) * t.transmission, 0.0F, 1.0F)
                             : zero();
  Lit s;
  s.view = point.view;
  const Float3 smoothly = smoothNormal(point, features);
  s.normal = features.hasTexture(shaders::SLOT_NORMAL) && !features.has(shaders::FEATURE_FLAT)
                 ? mappedNormal(point, smoothly, t.normal, material.normalScale)
                 : smoothly;
  s.occlusion = mulAdd(set(material.occlusionStrength), t.occlusion - one(), one());
  setReflection(s, features, material, t, base, metallic, one() - transmission);
  const V nv = max(dot(s.normal, s.view), set(0.0001F));
  if (features.has(shaders::FEATURE_SHEEN)) s.sheen = sheenOf(material, t.sheenColor, t.sheenRoughness, nv);
  if (features.has(shaders::FEATURE_CLEARCOAT)) {
    s.coat = coatOf(material, smoothly, s.view, t.clearcoat, t.clearcoatRoughness);
  }
  if (features.has(shaders::FEATURE_RARE)) {
    s.grooves = groovesOf(material, tangentOf(point, s.normal), s.normal, s.roughness, t.anisotropy);
  }
  const Float3 color = lit(s, features, *draw.frame, point.position, set3(material.emissive) * t.emissive);
  Float3 tint = base;
  if (features.has(shaders::FEATURE_VOLUME)) {
    // As thick as the file says: no light is followed through what surfaces enclose.
    const V length = hn::IfThenElseZero(point.front, t.thickness * set(draw.longer));
    const auto passed = [&](float absorbed)
                            HWY_ATTR { return hn::Exp(Tag(), max(set(-absorbed) * length, set(-87.0F))); };
    tint =
        tint * Float3{passed(material.attenuation.x), passed(material.attenuation.y), passed(material.attenuation.z)};
  }
  return {color, alpha, tint, transmission * (one() - metallic)};
}

HWY_INLINE void store3(const Float3& v, float (*to)[VITRAIL_CPU_LANES], std::size_t lane) {
  const Tag d;
  hn::StoreU(v.x, d, to[0] + lane);
  hn::StoreU(v.y, d, to[1] + lane);
  hn::StoreU(v.z, d, to[2] + lane);
}

// Hands over the one or two fragments of collect.frag, the two of a transmissive surface in one.
template <std::uint32_t kPossible>
HWY_INLINE void storeFragments(const Shaded& surface, Features<kPossible> features, VitrailCpuFragments& fragments,
                               std::size_t lane) {
  const Tag d;
  if (!features.has(shaders::FEATURE_TRANSMISSION)) {
    store3(surface.color, fragments.color, lane);
    hn::StoreU(surface.alpha, d, fragments.color[3] + lane);
    return;
  }
  store3(surface.color * surface.alpha, fragments.color, lane);
  const V through = surface.alpha * surface.passes;
  hn::StoreU(surface.alpha - through, d, fragments.color[3] + lane);
  const V every = one() - surface.alpha + through;
  const V share = hn::IfThenElseZero(every > zero(), through / every);
  store3(mix(all(one()), surface.tint, share), fragments.filter, lane);
}

// Shades fragments of a ShadeDraw whose features are among those that are possible.
template <std::uint32_t kPossible>
void shadeSurface(void* user, VitrailCpuFragments* fragments) {
  const ShadeDraw& draw = *static_cast<const ShadeDraw*>(user);
  const ShadeSurface& surface = *draw.surface;
  const shaders::MaterialData& material = surface.material;
  const Features<kPossible> features{surface.features};
  const Asked asked = askedOf(surface, features);
  Corners corners;
  findCorners(*fragments, surface.mesh, corners);
  CornerAttributes attributes;
  fetchAttributes(surface.mesh, asked, corners, attributes);
  for (std::size_t lane = 0; lane < VITRAIL_CPU_LANES; lane += kLanes) {
    if ((fragments->mask >> lane & ((1U << kLanes) - 1U)) == 0) continue;
    const Places places = placesOf(*fragments, corners, surface.mesh, lane);
    const TexelSet t = sampleTextures(*fragments, surface, features, corners, attributes, places, lane);
    Float3 base = set3(material.baseColor);
    V baseAlpha = set(material.baseColor.a);
    if (features.has(shaders::FEATURE_VERTEX_COLOR)) {
      base = base * interpolate3(corners, attributes.color, places);
      baseAlpha = baseAlpha * interpolate(corners, attributes.color[3], places);
    }
    base = base * Float3{t.base.x, t.base.y, t.base.z};
    baseAlpha = baseAlpha * t.base.w;
    if (features.has(shaders::FEATURE_MASK)) {
      fragments->discarded |= bitsOf(Tag(), baseAlpha < set(material.alphaCutoff), lane);
    }
    const V alpha = set(material.opacity) * mix(one(), baseAlpha, set(material.alphaFromBase));
    Shaded shaded{base, alpha, all(one()), zero()};
    if (!features.has(shaders::FEATURE_UNLIT)) {
      const Point point = pointOf(*fragments, draw, features, asked, corners, attributes, places, lane);
      shaded = shadeLit(draw, features, point, t, base, alpha);
    }
    storeFragments(shaded, features, *fragments, lane);
  }
}

} // namespace HWY_NAMESPACE
} // namespace vitrail::tool
HWY_AFTER_NAMESPACE();

#endif
