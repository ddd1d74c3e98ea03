// Shades a surface as docs/shading.md states. Included by the fragment shaders of the opaque and the transparent pass.
#ifndef VITRAIL_TOOL_SURFACE_GLSL
#define VITRAIL_TOOL_SURFACE_GLSL

#include "surface_shared.h"

layout(constant_id = 0) const uint kFeatures = 0u;

layout(set = 0, binding = 0, std140) uniform FrameBlock { FrameData frame; };
layout(set = 0, binding = 1, std140) uniform MaterialBlock { MaterialData material; };
layout(set = 1, binding = 0) uniform sampler2D baseColorTexture;
layout(set = 1, binding = 1) uniform sampler2D metallicRoughnessTexture;
layout(set = 1, binding = 2) uniform sampler2D normalTexture;
layout(set = 1, binding = 3) uniform sampler2D occlusionTexture;
layout(set = 1, binding = 4) uniform sampler2D emissiveTexture;
layout(set = 1, binding = 5) uniform sampler2D transmissionTexture;
layout(set = 1, binding = 6) uniform sampler2D thicknessTexture;

// Where the surface is shaded: at the middle of the pixel, unless the including shader says otherwise.
#ifndef SURFACE_IN
#define SURFACE_IN in
#endif
layout(location = 0) SURFACE_IN vec3 inPosition;
layout(location = 1) SURFACE_IN vec3 inNormal;
layout(location = 2) SURFACE_IN vec4 inTangent;
layout(location = 3) SURFACE_IN vec4 inColor;
layout(location = 4) SURFACE_IN vec2 inTexCoords[SLOT_COUNT];

const float PI = 3.14159265358979;

bool has(uint feature) { return (kFeatures & feature) != 0u; }
bool hasTexture(uint slot) { return has(1u << slot); }

// Unit length; `fallback` for a vector without a direction.
vec3 direction(vec3 v, vec3 fallback) {
  float squared = dot(v, v);
  return squared > 0.0 ? v * inversesqrt(squared) : fallback;
}

vec3 viewDirection() {
  vec3 backward = frame.cameraToWorld[2].xyz;
  return frame.eye.w > 0.5 ? backward : direction(frame.eye.xyz - inPosition, backward);
}

// The normal of a flat triangle's plane, on one side or the other, not of unit length. Before any discard, which would
// leave the derivatives undefined.
vec3 planeNormal() { return has(FEATURE_FLAT) ? cross(dFdx(inPosition), dFdy(inPosition)) : vec3(0.0); }

// The shading normal on the side that is seen. `sampled` is the normal map's texel, `v` points to the eye.
vec3 surfaceNormal(vec3 plane, vec3 sampled, vec3 v) {
  if (has(FEATURE_FLAT)) return direction(dot(plane, v) < 0.0 ? -plane : plane, v);
  vec3 normal = direction(inNormal, v);
  if (hasTexture(SLOT_NORMAL)) {
    vec3 axis = abs(normal.x) < 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 tangent = direction(inTangent.xyz - normal * dot(normal, inTangent.xyz), normalize(cross(axis, normal)));
    vec3 bitangent = cross(normal, tangent) * (inTangent.w < 0.0 ? -1.0 : 1.0);
    vec3 n = sampled * 2.0 - 1.0;
    n.xy *= material.normalScale;
    normal = direction(tangent * n.x + bitangent * n.y + normal * n.z, normal);
  }
  return gl_FrontFacing ? normal : -normal;
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

// What a surface reflects. `scattered` is the share of the diffuse light that does not pass through it.
vec3 lit(vec3 base, float metallic, float scattered, float roughness, float occlusion, vec3 n, vec3 v) {
  vec3 l = frame.toLight.xyz;
  vec3 h = direction(l + v, n);
  float nv = max(dot(n, v), 0.0001);
  float nl = max(dot(n, l), 0.0);
  float a2 = roughness * roughness * roughness * roughness;
  vec3 f0 = mix(vec3(0.04), base, metallic);
  vec3 diffuse = scattered * (1.0 - metallic) * base;

  vec3 direct = vec3(0.0);
  if (nl > 0.0) {
    vec3 fresnel = f0 + (1.0 - f0) * grazing(max(dot(v, h), 0.0));
    vec3 specular = fresnel * distribution(n, h, a2) * visibility(nl, nv, a2);
    direct = 2.0 * nl * ((1.0 - fresnel) * diffuse / PI + specular);
  }
  vec3 reflected = 2.0 * dot(n, v) * n - v;
  vec3 ambientFresnel = f0 + (max(vec3(1.0 - roughness), f0) - f0) * grazing(nv);
  return direct + occlusion * (hemisphere(n) * diffuse + hemisphere(reflected) * ambientFresnel);
}

// Whether the volume behind the surface is taken to be as thick as the file says, and to tint what passes through the
// surface. A method that follows light through what surfaces enclose defines SURFACE_TRUE_PATH.
bool thickAsStated() {
#ifdef SURFACE_TRUE_PATH
  if (has(FEATURE_SOLID)) return false;
#endif
  return has(FEATURE_VOLUME) && gl_FrontFacing;
}

// A surface at one pixel, as docs/shading.md states it.
struct Surface {
  vec3 color;  // linear
  float alpha; // how much of the surface is there
  vec3 tint;   // of what passes through
  float passes; // the share of the light behind that passes; 0 without FEATURE_TRANSMISSION
};

// Discards what the mask cuts away, after every texture has been sampled: what kFeatures decides is uniform, so the
// derivatives are defined.
Surface shadeSurface() {
  vec4 base = material.baseColor;
  vec3 metallicRoughness = vec3(1.0);
  vec3 normalSample = vec3(0.5, 0.5, 1.0);
  float occlusionSample = 1.0;
  float transmission = has(FEATURE_TRANSMISSION) ? material.transmission : 0.0;
  vec3 emissive = material.emissive.rgb;
  if (has(FEATURE_VERTEX_COLOR)) base *= inColor;
  if (hasTexture(SLOT_BASE_COLOR)) base *= texture(baseColorTexture, inTexCoords[SLOT_BASE_COLOR]);
  if (hasTexture(SLOT_METALLIC_ROUGHNESS)) {
    metallicRoughness = texture(metallicRoughnessTexture, inTexCoords[SLOT_METALLIC_ROUGHNESS]).rgb;
  }
  if (hasTexture(SLOT_NORMAL)) normalSample = texture(normalTexture, inTexCoords[SLOT_NORMAL]).rgb;
  if (hasTexture(SLOT_OCCLUSION)) occlusionSample = texture(occlusionTexture, inTexCoords[SLOT_OCCLUSION]).r;
  if (hasTexture(SLOT_EMISSIVE)) emissive *= texture(emissiveTexture, inTexCoords[SLOT_EMISSIVE]).rgb;
  if (hasTexture(SLOT_TRANSMISSION)) {
    transmission *= texture(transmissionTexture, inTexCoords[SLOT_TRANSMISSION]).r;
  }

  float thickness = 1.0;
  if (hasTexture(SLOT_THICKNESS)) thickness = texture(thicknessTexture, inTexCoords[SLOT_THICKNESS]).g;

  vec3 plane = planeNormal();
  if (has(FEATURE_MASK) && base.a < material.alphaCutoff) discard;
  float alpha = material.opacity * mix(1.0, base.a, material.alphaFromBase);
  if (has(FEATURE_UNLIT)) return Surface(base.rgb, alpha, vec3(1.0), 0.0);

  vec3 v = viewDirection();
  vec3 n = surfaceNormal(plane, normalSample, v);
  float roughness = clamp(material.roughness * metallicRoughness.g, 0.045, 1.0);
  float metallic = clamp(material.metallic * metallicRoughness.b, 0.0, 1.0);
  float occlusion = 1.0 + material.occlusionStrength * (occlusionSample - 1.0);
  transmission = clamp(transmission, 0.0, 1.0);
  vec3 color = lit(base.rgb, metallic, 1.0 - transmission, roughness, occlusion, n, v) + emissive;
  vec3 tint = base.rgb;
  if (thickAsStated()) tint *= exp(-material.attenuation.rgb * (thickness * abs(inTangent.w)));
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
