// Shades a surface as docs/shading.md states. Included by the fragment shaders of the opaque and the transparent pass.
#ifndef VITRAIL_TOOL_SURFACE_GLSL
#define VITRAIL_TOOL_SURFACE_GLSL

#include "surface_shared.h"

// The normal of the plane in which two directions lie, not of unit length. Each is made about 1 long first, so that no
// square of the normal overflows in a large model, or vanishes in a small one.
vec3 normalOfPlane(vec3 a, vec3 b) {
  float sizeA = max(max(abs(a.x), abs(a.y)), abs(a.z));
  float sizeB = max(max(abs(b.x), abs(b.y)), abs(b.z));
  return cross(a / max(sizeA, 1e-37), b / max(sizeB, 1e-37));
}

#ifndef SURFACE_OF_DRAWS
CONSTANT(0, uint kFeatures, 0u)

layout(BOUND(0, 0, 5), std140) uniform FrameBlock { FrameData frame; };
layout(BOUND(0, 1, 6), std140) uniform MaterialBlock { MaterialData material; };
layout(BOUND(0, 2, 7), std430) readonly buffer LightBlock { LightData lights[]; };
layout(BOUND(1, 0, 0)) uniform sampler2D baseColorTexture;
layout(BOUND(1, 1, 1)) uniform sampler2D metallicRoughnessTexture;
layout(BOUND(1, 2, 2)) uniform sampler2D normalTexture;
layout(BOUND(1, 3, 3)) uniform sampler2D occlusionTexture;
layout(BOUND(1, 4, 4)) uniform sampler2D emissiveTexture;
layout(BOUND(1, 5, 5)) uniform sampler2D transmissionTexture;
layout(BOUND(1, 6, 6)) uniform sampler2D specularTexture;
layout(BOUND(1, 7, 7)) uniform sampler2D specularColorTexture;
layout(BOUND(1, 8, 8)) uniform sampler2D clearcoatTexture;
layout(BOUND(1, 9, 9)) uniform sampler2D clearcoatRoughnessTexture;
layout(BOUND(1, 10, 10)) uniform sampler2D thicknessTexture;
layout(BOUND(1, 11, 11)) uniform sampler2D sheenColorTexture;
layout(BOUND(1, 12, 12)) uniform sampler2D sheenRoughnessTexture;
layout(BOUND(1, 13, 13)) uniform sampler2D anisotropyTexture;
layout(BOUND(1, 14, 14)) uniform sampler2D iridescenceTexture;
layout(BOUND(1, 15, 15)) uniform sampler2D iridescenceThicknessTexture;

// Where the surface is shaded: at the middle of the pixel, unless the including shader says otherwise.
#ifndef SURFACE_IN
#define SURFACE_IN in
#endif
layout(location = 0) SURFACE_IN vec3 inPosition;
layout(location = 1) SURFACE_IN vec3 inNormal;
layout(location = 2) SURFACE_IN vec4 inTangent;
layout(location = 3) SURFACE_IN vec4 inColor;
layout(location = 4) SURFACE_IN vec4 inTexCoords[SLOT_PAIRS];

bool has(uint feature) { return (kFeatures & feature) != 0u; }
vec2 texCoord(uint slot) {
  vec4 two = inTexCoords[slot / 2u];
  return slot % 2u == 0u ? two.xy : two.zw;
}

// The normal of a flat triangle's plane, on one side or the other, not of unit length. Before any discard, which would
// leave the derivatives undefined.
vec3 planeNormal() { return has(FEATURE_FLAT) ? normalOfPlane(dFdx(inPosition), dFdy(inPosition)) : vec3(0.0); }

// From the surface to the eye.
vec3 wayToEye() { return frame.eye.xyz - inPosition; }

#define SURFACE_FRONT gl_FrontFacing
#define SURFACE_DISCARD discard
#define TEXEL(slot, image) (hasTexture(slot) ? texture(image, texCoord(slot)) : vec4(1.0))
#else
#include "surface_of_draws.glsl"
#endif

const float PI = 3.14159265358979;

bool isSolid() { return has(FEATURE_LINES) && has(FEATURE_POINTS); }
bool hasTexture(uint slot) { return has(1u << slot); }

// Unit length; `fallback` for a vector without a direction.
vec3 direction(vec3 v, vec3 fallback) {
  float squared = dot(v, v);
  return squared > 0.0 ? v * inversesqrt(squared) : fallback;
}

vec3 viewDirection() {
  vec3 backward = frame.cameraToWorld[2].xyz;
  return frame.eye.w > 0.5 ? backward : direction(wayToEye(), backward);
}

// The normal without the normal map, on the side that is seen. `v` points to the eye.
vec3 smoothNormal(vec3 plane, vec3 v) {
  if (has(FEATURE_FLAT)) return direction(dot(plane, v) < 0.0 ? -plane : plane, v);
  vec3 normal = direction(inNormal, v);
  return SURFACE_FRONT ? normal : -normal;
}

// The tangent that goes with a normal. Its bitangent is w times their cross product.
vec4 tangentOf(vec3 normal) {
  vec3 axis = abs(normal.x) < 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  vec3 tangent = direction(inTangent.xyz - normal * dot(normal, inTangent.xyz), normalize(cross(axis, normal)));
  return vec4(tangent, inTangent.w < 0.0 ? -1.0 : 1.0);
}

// The normal map's normal on the side that is seen, as the other one is. `sampled` is its texel.
vec3 mappedNormal(vec3 smoothly, vec3 sampled) {
  float side = SURFACE_FRONT ? 1.0 : -1.0;
  vec3 normal = side * smoothly;
  vec4 tangent = tangentOf(normal);
  vec3 bitangent = cross(normal, tangent.xyz) * tangent.w;
  vec3 n = sampled * 2.0 - 1.0;
  n.xy *= material.normalScale;
  return side * direction(tangent.xyz * n.x + bitangent * n.y + normal * n.z, normal);
}

vec3 hemisphere(vec3 d) { return mix(vec3(0.18, 0.17, 0.16), vec3(0.36, 0.38, 0.42), 0.5 + 0.5 * d.y); }

// GGX distribution. 1 - NH^2 is taken from the cross product: near the highlight's centre the difference cancels.
float distribution(vec3 n, vec3 h, float a2) {
  float nh = dot(n, h);
  vec3 side = cross(n, h);
  float f = nh > 0.0 ? nh * nh * a2 + dot(side, side) : 1.0;
  return a2 / (PI * f * f);
}

// Height-correlated Smith visibility.
float visibility(float nl, float nv, float a2) {
  return 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
}

// Schlick's weight, (1 - c)^5.
float grazing(float c) {
  float x = max(1.0 - c, 0.0);
  return x * x * x * x * x;
}

#include "surface_layers.glsl"

// A lit surface: what its light is reflected by.
struct Lit {
  vec3 normal;
  vec3 view;
  vec3 diffuse; // scattered back
  vec3 f0;      // reflected straight on
  vec3 f90;     // at grazing angles
  float roughness;
  float occlusion;
  float ambientShare; // of the diffuse ambient light: what a strong reflection leaves
  Sheen sheen;
  Coat coat;
  Grooves grooves;
  vec4 film;    // FEATURE_RARE: what a thin film reflects, and its share
  vec3 through; // FEATURE_RARE: scattered to the other side
};

// Adds a light that shines from `l` with the strength `light`.
void addLight(Lit s, vec3 l, vec3 light, inout vec3 color, inout vec3 coat) {
  float nl = max(dot(s.normal, l), 0.0);
  if (has(FEATURE_CLEARCOAT)) coat += light * coatLobe(s.coat, s.view, l);
  if (has(FEATURE_RARE)) color += light * max(-dot(s.normal, l), 0.0) * (1.0 - s.f0) * s.through / PI;
  if (nl <= 0.0) return;
  vec3 h = direction(l + s.view, s.normal);
  float nv = max(dot(s.normal, s.view), 0.0001);
  float a2 = s.roughness * s.roughness * s.roughness * s.roughness;
  vec3 fresnel = s.f0 + (s.f90 - s.f0) * grazing(max(dot(s.view, h), 0.0));
  float lobe = 0.0;
  if (has(FEATURE_RARE)) {
    fresnel = mix(fresnel, s.film.rgb, s.film.a);
    lobe = groovesLobe(s.grooves, s.normal, s.view, l, h);
  } else {
    lobe = distribution(s.normal, h, a2) * visibility(nl, nv, a2);
  }
  vec3 reflected = (1.0 - fresnel) * s.diffuse / PI + fresnel * lobe;
  if (has(FEATURE_SHEEN)) {
    reflected = reflected * s.sheen.leaves + s.sheen.color * sheenLobe(s.sheen, s.normal, h, nl, nv);
  }
  color += light * nl * reflected;
}

// What comes from a surface: the light that it reflects, and its own.
vec3 lit(Lit s, vec3 emissive) {
  vec3 color = vec3(0.0);
  vec3 coat = vec3(0.0);
  if (has(FEATURE_LIGHTS)) {
    uint count = uint(frame.toLight.w);
    for (uint i = 0u; i < count; ++i) {
      vec3 l;
      vec3 light = lightAt(lights[i], l);
      addLight(s, l, light, color, coat);
    }
  } else {
    addLight(s, frame.toLight.xyz, vec3(2.0), color, coat);
  }
  float nv = max(dot(s.normal, s.view), 0.0001);
  vec3 mirrored = 2.0 * dot(s.normal, s.view) * s.normal - s.view;
  vec3 fresnel = s.f0 + (max(s.f90 * (1.0 - s.roughness), s.f0) - s.f0) * grazing(nv);
  if (has(FEATURE_RARE)) fresnel = mix(fresnel, s.film.rgb, s.film.a);
  vec3 ambient = hemisphere(s.normal) * s.diffuse;
  if (has(FEATURE_SPECULAR)) ambient *= s.ambientShare;
  ambient += hemisphere(mirrored) * fresnel;
  if (has(FEATURE_RARE)) ambient += hemisphere(-s.normal) * s.through;
  if (has(FEATURE_SHEEN)) {
    ambient = ambient * s.sheen.leaves + hemisphere(s.normal) * s.sheen.color * s.sheen.albedo;
  }
  color += s.occlusion * ambient + emissive;
  if (has(FEATURE_CLEARCOAT)) {
    vec3 above = coat + s.occlusion * hemisphere(2.0 * dot(s.coat.normal, s.view) * s.coat.normal - s.view);
    color = mix(color, above, s.coat.share);
  }
  return color;
}

// Whether the volume behind the surface is taken to be as thick as the file says, and to tint what passes through the
// surface. A method that follows light through what surfaces enclose defines SURFACE_TRUE_PATH.
bool thickAsStated() {
#ifdef SURFACE_TRUE_PATH
  if (isSolid()) return false;
#endif
  return has(FEATURE_VOLUME) && SURFACE_FRONT;
}

// A surface at one pixel, as docs/shading.md states it.
struct Surface {
  vec3 color;  // linear
  float alpha; // how much of the surface is there
  vec3 tint;   // of what passes through
  float passes; // the share of the light behind that passes; 0 without FEATURE_TRANSMISSION
};

// What a surface's textures hold, of those that it has.
struct Texels {
  vec4 base;
  vec4 metallicRoughness; // or specular colour and glossiness
  vec3 normal;
  float occlusion;
  vec3 emissive;
  float transmission;
  float specular;
  vec3 specularColor;
  float clearcoat;
  float clearcoatRoughness;
  vec3 sheenColor;
  float sheenRoughness;
  vec3 anisotropy;
  float iridescence;
  float iridescenceThickness;
  float thickness;
};

Texels sampleTextures() {
  Texels t;
  t.base = TEXEL(SLOT_BASE_COLOR, baseColorTexture);
  // Colours times alpha were filtered, so that those of texels that are not there do not show.
  if (has(FEATURE_PREMULTIPLIED)) t.base.rgb = t.base.a > 0.0 ? t.base.rgb / t.base.a : vec3(0.0);
  t.metallicRoughness = TEXEL(SLOT_METALLIC_ROUGHNESS, metallicRoughnessTexture);
  t.normal = TEXEL(SLOT_NORMAL, normalTexture).rgb;
  t.occlusion = TEXEL(SLOT_OCCLUSION, occlusionTexture).r;
  t.emissive = TEXEL(SLOT_EMISSIVE, emissiveTexture).rgb;
  t.transmission = TEXEL(SLOT_TRANSMISSION, transmissionTexture).r;
  t.specular = TEXEL(SLOT_SPECULAR, specularTexture).a;
  t.specularColor = TEXEL(SLOT_SPECULAR_COLOR, specularColorTexture).rgb;
  t.clearcoat = TEXEL(SLOT_CLEARCOAT, clearcoatTexture).r;
  t.clearcoatRoughness = TEXEL(SLOT_CLEARCOAT_ROUGHNESS, clearcoatRoughnessTexture).g;
  t.sheenColor = TEXEL(SLOT_SHEEN_COLOR, sheenColorTexture).rgb;
  t.sheenRoughness = TEXEL(SLOT_SHEEN_ROUGHNESS, sheenRoughnessTexture).a;
  t.anisotropy = hasTexture(SLOT_ANISOTROPY) ? TEXEL(SLOT_ANISOTROPY, anisotropyTexture).rgb : vec3(1.0, 0.5, 1.0);
  t.iridescence = TEXEL(SLOT_IRIDESCENCE, iridescenceTexture).r;
  t.iridescenceThickness = TEXEL(SLOT_IRIDESCENCE_THICKNESS, iridescenceThicknessTexture).g;
  t.thickness = TEXEL(SLOT_THICKNESS, thicknessTexture).g;
  return t;
}

// Fills in what a surface is made of. `base` is its base or diffuse colour, `scattered` the share of its diffuse light
// that does not pass through it.
void setReflection(inout Lit s, Texels t, vec3 base, float metallic, float scattered) {
  s.roughness = material.roughness * t.metallicRoughness.g;
  s.ambientShare = 1.0;
  if (has(FEATURE_SPECULAR_GLOSSINESS)) {
    s.roughness = 1.0 - (1.0 - material.roughness) * t.metallicRoughness.a;
    s.f0 = min(material.specularColor.rgb * t.metallicRoughness.rgb, 1.0);
    s.f90 = vec3(1.0);
    s.diffuse = scattered * (1.0 - max(s.f0.r, max(s.f0.g, s.f0.b))) * base;
  } else {
    vec3 dielectric = vec3(0.04);
    float dielectric90 = 1.0;
    if (has(FEATURE_SPECULAR)) {
      dielectric90 = material.specularColor.a * t.specular;
      dielectric = min(material.reflectance * material.specularColor.rgb * t.specularColor, 1.0) * dielectric90;
      s.ambientShare = min((1.0 - max(dielectric.r, max(dielectric.g, dielectric.b))) / 0.96, 1.0);
    }
    s.f0 = mix(dielectric, base, metallic);
    s.f90 = mix(vec3(dielectric90), vec3(1.0), metallic);
    s.diffuse = scattered * (1.0 - metallic) * base;
  }
  s.roughness = clamp(s.roughness, 0.045, 1.0);
  if (has(FEATURE_RARE)) {
    float share = material.diffuseTransmission.a;
    s.through = scattered * (1.0 - metallic) * share * material.diffuseTransmission.rgb;
    s.diffuse *= 1.0 - share;
    float thickness = mix(material.iridescence.z, material.iridescence.w, t.iridescenceThickness);
    float nv = max(dot(s.normal, s.view), 0.0001);
    s.film = vec4(filmReflection(s.f0, nv, material.iridescence.y, thickness),
                  clamp(material.iridescence.x * t.iridescence, 0.0, 1.0));
  }
}

// Discards what the mask cuts away, after every texture has been sampled: what kFeatures decides is uniform, so the
// derivatives are defined.
Surface shadeSurface() {
  Texels t = sampleTextures();
  vec4 base = material.baseColor;
  if (has(FEATURE_VERTEX_COLOR)) base *= inColor;
  base *= t.base;
  vec3 plane = planeNormal();
  if (has(FEATURE_MASK) && base.a < material.alphaCutoff) SURFACE_DISCARD;
  float alpha = material.opacity * mix(1.0, base.a, material.alphaFromBase);
  if (has(FEATURE_UNLIT)) return Surface(base.rgb, alpha, vec3(1.0), 0.0);

  float metallic = clamp(material.metallic * t.metallicRoughness.b, 0.0, 1.0);
  if (has(FEATURE_SPECULAR_GLOSSINESS)) metallic = 0.0;
  float transmission = has(FEATURE_TRANSMISSION) ? clamp(material.transmission * t.transmission, 0.0, 1.0) : 0.0;
  Lit s;
  s.view = viewDirection();
  vec3 smoothly = smoothNormal(plane, s.view);
  s.normal = hasTexture(SLOT_NORMAL) && !has(FEATURE_FLAT) ? mappedNormal(smoothly, t.normal) : smoothly;
  s.occlusion = 1.0 + material.occlusionStrength * (t.occlusion - 1.0);
  setReflection(s, t, base.rgb, metallic, 1.0 - transmission);
  float nv = max(dot(s.normal, s.view), 0.0001);
  if (has(FEATURE_SHEEN)) s.sheen = sheenOf(t.sheenColor, t.sheenRoughness, nv);
  if (has(FEATURE_CLEARCOAT)) s.coat = coatOf(smoothly, s.view, t.clearcoat, t.clearcoatRoughness);
  if (has(FEATURE_RARE)) s.grooves = groovesOf(tangentOf(s.normal), s.normal, s.roughness, t.anisotropy);
  vec3 color = lit(s, material.emissive.rgb * t.emissive);
  vec3 tint = base.rgb;
  if (thickAsStated()) tint *= exp(-material.attenuation.rgb * (t.thickness * abs(inTangent.w)));
  return Surface(color, alpha, tint, transmission * (1.0 - metallic));
}

// The two fragments of a transmissive surface, the first in front of the second: what it reflects, premultiplied, and
// the filter for what is behind.
vec4 reflectionOf(Surface surface) {
  return vec4(surface.alpha * surface.color, surface.alpha * (1.0 - surface.passes));
}
vec4 filterOf(Surface surface) {
  float through = surface.alpha * surface.passes;
  float all = 1.0 - surface.alpha + through;
  return vec4(surface.tint, all > 0.0 ? through / all : 0.0);
}

#endif
