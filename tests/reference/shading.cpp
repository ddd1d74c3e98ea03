// The formulas of docs/shading.md in double precision.
#include "shading.h"

#include <algorithm>
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
  const std::size_t offset = (static_cast<std::size_t>(y) * image.width + static_cast<std::size_t>(x)) * 4;
  const auto channel = [&](std::size_t i) { return static_cast<double>(image.rgba[offset + i]) / 255.0; };
  return {decodeSrgb(channel(0)), decodeSrgb(channel(1)), decodeSrgb(channel(2)), channel(3)};
}

} // namespace

glm::dvec3 shade(const Surface& surface) {
  const glm::dvec3& n = surface.normal;
  const glm::dvec3& v = surface.toEye;
  const glm::dvec3& l = surface.toLight;
  const glm::dvec3 h = glm::normalize(l + v);
  const glm::dvec3 r = 2.0 * glm::dot(n, v) * n - v;
  const double nl = std::max(glm::dot(n, l), 0.0);
  const double nv = std::max(glm::dot(n, v), 0.0001);
  const double nh = std::max(glm::dot(n, h), 0.0);
  const double vh = std::max(glm::dot(v, h), 0.0);

  const double rough = std::clamp(surface.roughness, 0.045, 1.0);
  const double metal = std::clamp(surface.metallic, 0.0, 1.0);
  const glm::dvec3 f0 = glm::mix(glm::dvec3(0.04), surface.base, metal);
  const glm::dvec3 diffuse = (1.0 - surface.transmission) * (1.0 - metal) * surface.base;
  const double a = rough * rough;

  glm::dvec3 direct(0.0);
  if (nl > 0.0) {
    const glm::dvec3 f = f0 + (1.0 - f0) * power5(1.0 - vh);
    const double lobe = nh * nh * (a * a - 1.0) + 1.0;
    const double d = a * a / (kPi * lobe * lobe);
    const double vis =
        0.5 / (nl * std::sqrt(nv * nv * (1.0 - a * a) + a * a) + nv * std::sqrt(nl * nl * (1.0 - a * a) + a * a));
    direct = 2.0 * nl * ((1.0 - f) * diffuse / kPi + f * d * vis);
  }
  const glm::dvec3 grazing = glm::max(glm::dvec3(1.0 - rough), f0);
  const glm::dvec3 mirror = f0 + (grazing - f0) * power5(1.0 - nv);
  const glm::dvec3 ambient = hemisphere(n) * diffuse + hemisphere(r) * mirror;
  return direct + ambient + surface.emissive;
}

glm::dvec3 skyColor(const glm::dvec3& direction) {
  const glm::dvec3 horizon(0.70, 0.78, 0.88);
  const glm::dvec3 end = direction.y >= 0.0 ? glm::dvec3(0.18, 0.36, 0.70) : glm::dvec3(0.30, 0.28, 0.26);
  return glm::mix(horizon, end, std::sqrt(std::abs(direction.y)));
}

glm::dvec4 sampleColorTexture(const Image& image, const TextureSlot& slot, const glm::dvec2& uv) {
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
  const auto row = [&](std::int64_t line) {
    return glm::mix(texel(image, wrapX(left), line), texel(image, wrapX(left + 1.0), line), x - left);
  };
  return glm::mix(row(wrapY(top)), row(wrapY(top + 1.0)), y - top);
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
