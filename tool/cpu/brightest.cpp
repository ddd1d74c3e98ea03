// Upper bounds of the formulas of docs/shading.md. With VH the cosine between the half vector H and V, and d the angle
// between N and H:
//
// F <= F0 + (F90 - F0) (1 - VH)^5, and VH is at least the cosine of half the angle between L and V, which a distant
// light and a picture's field of view bound: `halfAngle`.
//
// NL Vis = 0.5 / (s(NV) + NV s(NL) / NL) <= 0.5 / (s(NV) + NV), where s(c) = sqrt(c^2 (1 - a^2) + a^2) >= c. That falls
// with NV, and NV >= cos(halfAngle + d).
//
// D falls with d. So between d0 and d1, D NL Vis <= D(d0) 0.5 / (s(c) + c) with c = max(cos(halfAngle + d1), 0), and
// the largest of that over the intervals of a partition of [0, pi / 2] bounds it everywhere. Where a texture makes the
// roughness anything from r0 to r1, s is taken with the smaller a, and D with the a in between for which it is largest:
// D = a^2 / (pi (cos(d)^2 a^2 + sin(d)^2)^2) has one maximum in a^2, at tan(d)^2.
#include "brightest.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vitrail::tool {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHemisphere[3] = {0.36, 0.38, 0.42}; // its largest value
constexpr double kMargin = 1.001;                     // for rounding, of premultiplied texels as 16-bit floats, too

bool hasFeature(const ShadeSurface& surface, std::uint32_t feature) { return (surface.features & feature) != 0; }
bool samples(const ShadeSurface& surface, std::uint32_t slot) { return hasFeature(surface, 1U << slot); }

struct Roughness {
  double least = 0.045;
  double most = 1.0;
};

double distributionAt(double angle, const Roughness& r) {
  const double low = std::pow(r.least, 4.0); // of a^2
  const double high = std::pow(r.most, 4.0);
  const double sine = std::sin(angle) * std::sin(angle);
  const double cosine = 1.0 - sine;
  const double a2 = cosine > 0.0 ? std::clamp(sine / cosine, low, high) : high;
  const double f = cosine * a2 + sine;
  return a2 / (kPi * f * f);
}

// Of NL D Vis.
double largestLobe(const Roughness& r, double halfAngle) {
  const double a2 = std::pow(r.least, 4.0);
  double most = 0.0;
  double angle = 0.0;
  // Angles grow by an eighth, from well within the narrowest highlight on.
  for (double next = 0.0002; angle < 0.5 * kPi; next *= 1.125) {
    const double nv = std::max(std::cos(std::min(halfAngle + next, 0.5 * kPi)), 0.0);
    const double masked = std::sqrt(nv * nv * (1.0 - a2) + a2);
    most = std::max(most, distributionAt(angle, r) * 0.5 / (masked + nv));
    angle = next;
  }
  return most;
}

double largestLobe(LightBounds& lights, const Roughness& r, double halfAngle) {
  const auto [known, isNew] = lights.highlights.try_emplace({r.least, r.most, halfAngle}, 0.0);
  if (isNew) known->second = largestLobe(r, halfAngle);
  return known->second;
}

Roughness roughnessOf(const ShadeSurface& surface) {
  const double factor = surface.material.roughness;
  const double low = std::clamp(factor, 0.045, 1.0);
  if (!samples(surface, shaders::SLOT_METALLIC_ROUGHNESS)) return {low, low};
  return hasFeature(surface, shaders::FEATURE_SPECULAR_GLOSSINESS) ? Roughness{low, 1.0} : Roughness{0.045, low};
}

// What one channel of a surface is made of.
struct Reflects {
  double diffuse = 0.0;
  double f0 = 0.0;
  double f90 = 1.0;
  double emissive = 0.0;
  double sheen = 0.0;
};

Reflects reflectsOf(const ShadeSurface& surface, const glm::vec4& largestVertex, int c) {
  const shaders::MaterialData& material = surface.material;
  Reflects r;
  const double base = double{material.baseColor[c]} * double{largestVertex[c]};
  const double metallic = std::clamp(double{material.metallic}, 0.0, 1.0);
  r.diffuse = base;
  r.emissive = material.emissive[c];
  if (hasFeature(surface, shaders::FEATURE_SHEEN)) r.sheen = material.sheen[c];
  if (hasFeature(surface, shaders::FEATURE_SPECULAR_GLOSSINESS)) {
    r.f0 = std::min(double{material.specularColor[c]}, 1.0);
    return r;
  }
  double dielectric = 0.04;
  double dielectric90 = 1.0;
  if (hasFeature(surface, shaders::FEATURE_SPECULAR)) {
    dielectric90 = material.specularColor.a;
    dielectric = std::min(double{material.reflectance} * double{material.specularColor[c]}, 1.0) * dielectric90;
  }
  // A texture makes metallic anything between 0 and its factor.
  const bool varies = samples(surface, shaders::SLOT_METALLIC_ROUGHNESS);
  const double mixed = dielectric + (base - dielectric) * metallic;
  r.f0 = varies ? std::max(dielectric, mixed) : mixed;
  r.f90 = std::max(dielectric90, dielectric90 + (1.0 - dielectric90) * metallic);
  if (!varies) r.diffuse *= 1.0 - metallic;
  return r;
}

// What a light adds at the most, of its strength.
double reflectedOf(const ShadeSurface& surface, const Reflects& r, double lobe, double halfAngle) {
  const double grazing = std::pow(1.0 - std::cos(halfAngle), 5.0);
  const double fresnel = r.f0 + std::max(r.f90 - r.f0, 0.0) * grazing;
  double reflected = r.diffuse / kPi + fresnel * lobe;
  if (r.sheen > 0.0) {
    // NL / (4 (NL + NV - NL NV)) <= 1 / 4, and the sine is at most 1.
    const bool varies = samples(surface, shaders::SLOT_SHEEN_ROUGHNESS);
    const double rough = varies ? 0.07 : std::clamp(double{surface.material.sheen.a}, 0.07, 1.0);
    reflected += r.sheen * (2.0 + 1.0 / (rough * rough)) / (8.0 * kPi);
  }
  return reflected;
}

double brightestChannel(const ShadeSurface& surface, const glm::vec4& largestVertex, LightBounds& lights, int c) {
  const Reflects r = reflectsOf(surface, largestVertex, c);
  const Roughness roughness = roughnessOf(surface);
  // 1 + strength * (texture - 1), textures being between 0 and 1
  const double strength = surface.material.occlusionStrength;
  const double occlusion = samples(surface, shaders::SLOT_OCCLUSION) ? std::max(1.0, 1.0 - strength) : 1.0;
  const double mirror = std::max(r.f0, r.f90 * (1.0 - roughness.least));
  double color = r.emissive + occlusion * kHemisphere[c] * (r.diffuse + mirror + r.sheen);
  double coat = occlusion * kHemisphere[c];
  const double rough = samples(surface, shaders::SLOT_CLEARCOAT_ROUGHNESS)
                           ? 0.045
                           : std::clamp(double{surface.material.clearcoatRoughness}, 0.045, 1.0);
  const double most = samples(surface, shaders::SLOT_CLEARCOAT_ROUGHNESS)
                          ? std::clamp(double{surface.material.clearcoatRoughness}, 0.045, 1.0)
                          : rough;
  for (const DistantLight& light : lights.lights) {
    const double angle =
        surface.mesh.corners == 3 ? light.halfAngle : 0.5 * kPi; // lines may be seen from beyond the edge
    color += double{light.strength[c]} * reflectedOf(surface, r, largestLobe(lights, roughness, angle), angle);
    if (!hasFeature(surface, shaders::FEATURE_CLEARCOAT)) continue;
    coat += double{light.strength[c]} * largestLobe(lights, {rough, most}, angle);
  }
  // The coat is mixed in.
  return hasFeature(surface, shaders::FEATURE_CLEARCOAT) ? std::max(color, coat) : color;
}

} // namespace

LightBounds lightBoundsOf(const ShadeFrame& frame) {
  LightBounds bounds;
  const shaders::FrameData& data = frame.data;
  const bool orthographic = data.eye.w > 0.5F;
  // The ways to the eye are no further from backward than the picture's corners, and a pixel.
  const double corner =
      orthographic ? 0.0 : std::atan(std::hypot(double{data.ray.z + data.ray.x}, double{data.ray.w + data.ray.y}));
  const glm::dvec3 backward(data.cameraToWorld[2]);
  const auto add = [&](const glm::vec3& toLight, const glm::vec3& strength) {
    const double cosine = glm::dot(glm::normalize(glm::dvec3(toLight)), glm::normalize(backward));
    const double angle = std::min(std::acos(std::clamp(cosine, -1.0, 1.0)) + corner, kPi);
    bounds.lights.push_back({strength, 0.5 * angle});
  };
  if (data.toLight.w < 0.5F) add(glm::vec3(data.toLight), glm::vec3(2.0F));
  for (const shaders::LightData& light : frame.lights) {
    if (static_cast<std::uint32_t>(light.direction.w) != shaders::LIGHT_DIRECTIONAL) bounds.bounded = false;
    add(-glm::vec3(light.direction), glm::vec3(light.intensity));
  }
  return bounds;
}

float brightestOf(const ShadeSurface& surface, const glm::vec4& largestVertex, LightBounds& lights) {
  double most = 0.0;
  const bool unlit = hasFeature(surface, shaders::FEATURE_UNLIT);
  // Grooves stretch a highlight, and light that comes through adds to it: no bound is derived for these.
  if (!unlit && (!lights.bounded || hasFeature(surface, shaders::FEATURE_RARE))) return shaders::LARGEST_HALF;
  for (int c = 0; c < 3; ++c) {
    const double channel = unlit ? double{surface.material.baseColor[c]} * double{largestVertex[c]}
                                 : brightestChannel(surface, largestVertex, lights, c);
    most = std::max(most, channel * kMargin);
  }
  return static_cast<float>(std::min(most, double{shaders::LARGEST_HALF}));
}

float largestAlphaOf(const ShadeSurface& surface, const glm::vec4& largestVertex) {
  const shaders::MaterialData& material = surface.material;
  const float alpha = glm::mix(1.0F, material.baseColor.a * largestVertex.a, material.alphaFromBase);
  return std::clamp(material.opacity * alpha, 0.0F, 1.0F);
}

} // namespace vitrail::tool
