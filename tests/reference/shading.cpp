// The formulas of docs/shading.md in double precision.
#include "shading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vitrail::tool::reference {

namespace {

constexpr double kPi = std::numbers::pi;

glm::dvec3 hemisphere(const glm::dvec3& direction) {
  return glm::mix(glm::dvec3(0.18, 0.17, 0.16), glm::dvec3(0.36, 0.38, 0.42), 0.5 + 0.5 * direction.y);
}

double power5(double x) { return x * x * x * x * x; }

// The texel index that a wrap mode gives for any integer coordinate.
std::int64_t wrapTexel(std::int64_t index, std::int64_t size, Wrap wrap) {
  const auto floorMod = [](std::int64_t a, std::int64_t b) { return (a % b + b) % b; };
  switch (wrap) {
    case Wrap::Repeat:
      return floorMod(index, size);
    case Wrap::MirroredRepeat: {
      const std::int64_t folded = floorMod(index, 2 * size);
      return folded < size ? folded : 2 * size - 1 - folded;
    }
    case Wrap::ClampToEdge:
      break;
  }
  return std::clamp<std::int64_t>(index, 0, size - 1);
}

glm::dvec4 texel(const Image& image, std::int64_t x, std::int64_t y) {
  static const std::array<double, 256> decoded = [] {
    std::array<double, 256> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = decodeSrgb(static_cast<double>(i) / 255.0);
    return all;
  }();
  const std::size_t offset = (static_cast<std::size_t>(y) * image.width + static_cast<std::size_t>(x)) * 4;
  const auto channel = [&](std::size_t i) { return decoded.at(image.rgba[offset + i]); };
  return {channel(0), channel(1), channel(2), static_cast<double>(image.rgba[offset + 3]) / 255.0};
}

double largestOf(const glm::dvec3& v) { return std::max({v.r, v.g, v.b}); }

double ggx(double nh, double a) {
  const double lobe = nh * nh * (a * a - 1.0) + 1.0;
  return a * a / (kPi * lobe * lobe);
}

double smith(double nl, double nv, double a) {
  return 0.5 / (nl * std::sqrt(nv * nv * (1.0 - a * a) + a * a) + nv * std::sqrt(nl * nl * (1.0 - a * a) + a * a));
}

// The table of the section "Sheen".
constexpr double kSheenAlbedo[8][8] = {
    {1.000, 0.316, 0.014, 0.000, 0.000, 0.000, 0.000, 0.000}, {1.000, 0.646, 0.170, 0.037, 0.006, 0.001, 0.000, 0.000},
    {1.000, 0.667, 0.353, 0.182, 0.086, 0.035, 0.010, 0.001}, {1.000, 0.598, 0.392, 0.257, 0.163, 0.095, 0.048, 0.016},
    {0.848, 0.543, 0.394, 0.289, 0.209, 0.144, 0.092, 0.049}, {0.741, 0.504, 0.388, 0.303, 0.236, 0.179, 0.129, 0.085},
    {0.675, 0.478, 0.381, 0.310, 0.252, 0.202, 0.158, 0.116}, {0.633, 0.460, 0.376, 0.314, 0.263, 0.219, 0.179, 0.141}};

double sheenAlbedo(double roughness, double cosine) {
  const double row = std::clamp(roughness, 0.0, 1.0) * 7.0;
  const double column = std::clamp(cosine, 0.0, 1.0) * 7.0;
  double sum = 0.0;
  for (int r = 0; r < 8; ++r) {
    for (int c = 0; c < 8; ++c) {
      const double weight = std::max(0.0, 1.0 - std::abs(row - r)) * std::max(0.0, 1.0 - std::abs(column - c));
      sum += weight * kSheenAlbedo[r][c];
    }
  }
  return sum;
}

// The section "Iridescence", one channel's phases at a time.
glm::dvec3 interference(double difference, const glm::dvec3& shift) {
  const double phase = 2.0 * kPi * difference * 1e-9;
  const auto gauss = [&](double height, double middle, double width, double turned) {
    return height * std::sqrt(2.0 * kPi * width) * std::cos(middle * phase + turned) * std::exp(-phase * phase * width);
  };
  const double x = gauss(5.4856e-13, 1.6810e6, 4.3278e9, shift.x) + gauss(9.7470e-14, 2.2399e6, 4.5282e9, shift.x);
  const double y = gauss(4.4201e-13, 1.7953e6, 9.3046e9, shift.y);
  const double z = gauss(5.2481e-13, 2.2084e6, 6.6121e9, shift.z);
  return glm::dvec3(3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                    0.0556434 * x - 0.2040259 * y + 1.0572252 * z) /
         1.0685e-7;
}

glm::dvec3 filmReflection(const glm::dvec3& f0, double cosine, double filmIor, double thickness) {
  const double edge = std::clamp(thickness / 0.03, 0.0, 1.0);
  const double index = 1.0 + (filmIor - 1.0) * edge * edge * (3.0 - 2.0 * edge);
  const double squared = 1.0 - (1.0 - cosine * cosine) / (index * index);
  if (squared < 0.0) return glm::dvec3(1.0);
  const double below = std::sqrt(squared);
  const double top0 = std::pow((index - 1.0) / (index + 1.0), 2.0);
  const double top = top0 + (1.0 - top0) * power5(1.0 - cosine);
  glm::dvec3 bottom(0.0);
  glm::dvec3 shift(0.0);
  for (int i = 0; i < 3; ++i) {
    const double root = std::sqrt(std::clamp(f0[i], 0.0, 0.9999));
    const double base = (1.0 + root) / (1.0 - root);
    const double bottom0 = std::pow((base - index) / (base + index), 2.0);
    bottom[i] = bottom0 + (1.0 - bottom0) * power5(1.0 - below);
    shift[i] = (index < 1.0 ? 0.0 : kPi) + (base < index ? kPi : 0.0);
  }
  const glm::dvec3 both = glm::clamp(top * bottom, 1e-5, 0.9999);
  const glm::dvec3 passed = (1.0 - top) * (1.0 - top) * bottom / (1.0 - both);
  glm::dvec3 sum = top + passed;
  for (int m = 1; m <= 2; ++m) {
    const glm::dvec3 order = (passed - (1.0 - top)) * glm::pow(glm::sqrt(both), glm::dvec3(m));
    sum += 2.0 * order * interference(m * 2.0 * index * thickness * below, double(m) * shift);
  }
  return glm::clamp(sum, 0.0, 1.0);
}

// What the sections up to "Iridescence" make of a material.
struct Reflecting {
  glm::dvec3 n, v;
  glm::dvec3 f0, f90, diffuse, through;
  double ambientShare = 1.0;
  double rough = 1.0;
  double nv = 1.0;
  glm::dvec3 film{0.0};
};

Reflecting reflectingOf(const Surface& surface) {
  Reflecting r;
  r.n = surface.normal;
  r.v = surface.toEye;
  r.nv = std::max(glm::dot(r.n, r.v), 0.0001);
  r.rough = std::clamp(surface.roughness, 0.045, 1.0);
  const double metal = surface.specularGlossiness ? 0.0 : std::clamp(surface.metallic, 0.0, 1.0);
  const double straight = std::pow((surface.ior - 1.0) / (surface.ior + 1.0), 2.0);
  const glm::dvec3 dielectric = surface.specular * glm::min(straight * surface.specularColor, 1.0);
  r.f0 = glm::mix(dielectric, surface.base, metal);
  r.f90 = glm::dvec3(surface.specular + (1.0 - surface.specular) * metal);
  r.ambientShare = std::min((1.0 - largestOf(dielectric)) / 0.96, 1.0);
  r.diffuse = (1.0 - surface.transmission) * (1.0 - metal) * surface.base;
  if (surface.specularGlossiness) {
    r.f0 = surface.specularColor;
    r.f90 = glm::dvec3(1.0);
    r.ambientShare = 1.0;
    r.diffuse = (1.0 - surface.transmission) * (1.0 - largestOf(r.f0)) * surface.base;
  }
  r.through =
      (1.0 - surface.transmission) * (1.0 - metal) * surface.diffuseTransmission * surface.diffuseTransmissionColor;
  r.diffuse *= 1.0 - surface.diffuseTransmission;
  // What a material has none of is not worked out.
  if (surface.iridescence != 0.0) {
    r.film = filmReflection(r.f0, r.nv, surface.iridescenceIor, surface.filmThickness);
  }
  return r;
}

// The lobe of the section "Anisotropy", which without grooves is that of "Colour".
double lobeOf(const Surface& surface, const Reflecting& r, const glm::dvec3& l, const glm::dvec3& h) {
  const double nl = glm::dot(r.n, l);
  const double a = r.rough * r.rough;
  if (surface.anisotropy == 0.0) return ggx(std::max(glm::dot(r.n, h), 0.0), a) * smith(nl, r.nv, a);
  const glm::dvec3 side =
      glm::normalize(glm::dvec3(surface.tangent) - r.n * glm::dot(r.n, glm::dvec3(surface.tangent)));
  const glm::dvec3 across = glm::cross(r.n, side) * surface.tangent.w;
  const glm::dvec3 t = std::cos(surface.anisotropyRotation) * side + std::sin(surface.anisotropyRotation) * across;
  const glm::dvec3 b = glm::cross(r.n, t);
  const double at = a + (1.0 - a) * surface.anisotropy * surface.anisotropy;
  const double th = glm::dot(t, h);
  const double bh = glm::dot(b, h);
  const double nh = glm::dot(r.n, h);
  const double shape = th * th / (at * at) + bh * bh / (a * a) + nh * nh;
  const double d = 1.0 / (kPi * at * a * shape * shape);
  const auto length = [&](const glm::dvec3& x, double nx) {
    return std::sqrt(std::pow(at * glm::dot(t, x), 2.0) + std::pow(a * glm::dot(b, x), 2.0) + nx * nx);
  };
  return d * 0.5 / (nl * length(r.v, r.nv) + r.nv * length(l, nl));
}

glm::dvec3 directLight(const Surface& surface, const Reflecting& r, const Shine& shine) {
  const double cosine = glm::dot(r.n, shine.toLight);
  if (cosine <= 0.0) return shine.strength * -cosine * (1.0 - r.f0) * r.through / kPi;
  const glm::dvec3 h = glm::normalize(shine.toLight + r.v);
  glm::dvec3 f = r.f0 + (r.f90 - r.f0) * power5(1.0 - std::max(glm::dot(r.v, h), 0.0));
  f = glm::mix(f, r.film, surface.iridescence);
  glm::dvec3 reflected = (1.0 - f) * r.diffuse / kPi + f * lobeOf(surface, r, shine.toLight, h);
  if (surface.sheenColor == glm::dvec3(0.0)) return shine.strength * cosine * reflected;
  const double rough = std::clamp(surface.sheenRoughness, 0.07, 1.0);
  const double most = std::min(largestOf(surface.sheenColor), 1.0);
  reflected *= 1.0 - most * sheenAlbedo(rough, r.nv);
  const double power = 1.0 / (rough * rough);
  const double nh = std::min(glm::dot(r.n, h), 1.0);
  const double fibres = (2.0 + power) * std::pow(std::sqrt(1.0 - nh * nh), power) / (2.0 * kPi);
  reflected += surface.sheenColor * fibres / (4.0 * (cosine + r.nv - cosine * r.nv));
  return shine.strength * cosine * reflected;
}

glm::dvec3 coatLight(const Surface& surface, const Reflecting& r, const Shine& shine) {
  const double nl = glm::dot(r.n, shine.toLight);
  if (nl <= 0.0) return glm::dvec3(0.0);
  const double rough = std::clamp(surface.clearcoatRoughness, 0.045, 1.0);
  const double nh = glm::dot(r.n, glm::normalize(shine.toLight + r.v));
  return shine.strength * nl * ggx(nh, rough * rough) * smith(nl, r.nv, rough * rough);
}

} // namespace

Shine shineOf(const Light& light, double exposure, const glm::dvec3& point) {
  Shine shine;
  const glm::dvec3 axis(light.direction);
  double share = 1.0;
  shine.toLight = -axis;
  if (light.kind != Light::Kind::Directional) {
    const glm::dvec3 way = glm::dvec3(light.position) - point;
    const double distance = glm::length(way);
    shine.toLight = way / distance;
    share = 1.0 / (distance * distance);
    if (light.range > 0.0F) share *= std::clamp(1.0 - std::pow(distance / double{light.range}, 4.0), 0.0, 1.0);
  }
  if (light.kind == Light::Kind::Spot) {
    const double inner = std::cos(double{light.innerConeAngle});
    const double outer = std::cos(double{light.outerConeAngle});
    const double along = glm::dot(axis, -shine.toLight);
    share *= std::pow(std::clamp((along - outer) / std::max(inner - outer, 0.001), 0.0, 1.0), 2.0);
  }
  shine.strength = share * exposure * glm::dvec3(light.intensity);
  return shine;
}

glm::dvec3 shade(const Surface& surface) {
  const Reflecting r = reflectingOf(surface);
  std::vector<Shine> lights = surface.lights;
  if (surface.ownLight) lights = {{surface.toLight, glm::dvec3(2.0)}};
  const glm::dvec3 mirrored = 2.0 * glm::dot(r.n, r.v) * r.n - r.v;
  const glm::dvec3 grazing = glm::max(r.f90 * (1.0 - r.rough), r.f0);
  glm::dvec3 mirror = r.f0 + (grazing - r.f0) * power5(1.0 - r.nv);
  mirror = glm::mix(mirror, r.film, surface.iridescence);
  glm::dvec3 color =
      r.ambientShare * hemisphere(r.n) * r.diffuse + hemisphere(mirrored) * mirror + hemisphere(-r.n) * r.through;
  if (surface.sheenColor != glm::dvec3(0.0)) {
    const double albedo = sheenAlbedo(std::clamp(surface.sheenRoughness, 0.07, 1.0), r.nv);
    color *= 1.0 - std::min(largestOf(surface.sheenColor), 1.0) * albedo;
    color += hemisphere(r.n) * surface.sheenColor * albedo;
  }
  glm::dvec3 coat = hemisphere(mirrored);
  for (const Shine& shine : lights) {
    color += directLight(surface, r, shine);
    coat += coatLight(surface, r, shine);
  }
  return glm::mix(color + surface.emissive, coat, surface.clearcoat * (0.04 + 0.96 * power5(1.0 - r.nv)));
}

glm::dvec3 skyColor(const glm::dvec3& direction) {
  const glm::dvec3 horizon(0.70, 0.78, 0.88);
  const glm::dvec3 end = direction.y >= 0.0 ? glm::dvec3(0.18, 0.36, 0.70) : glm::dvec3(0.30, 0.28, 0.26);
  return glm::mix(horizon, end, std::sqrt(std::abs(direction.y)));
}

glm::dvec4 sampleColorTexture(const Image& image, const TextureSlot& slot, const glm::dvec2& uv, bool premultiplied) {
  const glm::dvec3 placed = glm::dmat3(slot.transform) * glm::dvec3(uv, 1.0);
  const double x = placed.x * image.width - 0.5;
  const double y = placed.y * image.height - 0.5;
  const double left = std::floor(x);
  const double top = std::floor(y);
  const auto wrapX = [&](double at) {
    return wrapTexel(static_cast<std::int64_t>(at), image.width, slot.sampler.wrapU);
  };
  const auto wrapY = [&](double at) {
    return wrapTexel(static_cast<std::int64_t>(at), image.height, slot.sampler.wrapV);
  };
  const auto filtered = [&](std::int64_t column, std::int64_t line) {
    const glm::dvec4 color = texel(image, column, line);
    return premultiplied ? glm::dvec4(glm::dvec3(color) * color.a, color.a) : color;
  };
  const auto row = [&](std::int64_t line) {
    return glm::mix(filtered(wrapX(left), line), filtered(wrapX(left + 1.0), line), x - left);
  };
  const glm::dvec4 sum = glm::mix(row(wrapY(top)), row(wrapY(top + 1.0)), y - top);
  return premultiplied && sum.a > 0.0 ? glm::dvec4(glm::dvec3(sum) / sum.a, sum.a) : sum;
}

double decodeSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double encodeSrgb(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

std::uint8_t quantize8(double value) {
  if (!(value > 0.0)) return 0; // a NaN too
  return static_cast<std::uint8_t>(std::floor(std::min(value, 1.0) * 255.0 + 0.5));
}

} // namespace vitrail::tool::reference
