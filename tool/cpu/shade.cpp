#include "shade.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu/shade.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade_plain-inl.h"
#include "shade_surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrail::tool {
namespace HWY_NAMESPACE {

// The function that is made for no more features than it must be.
VitrailCpuShade functionOf(std::uint32_t features) {
  using namespace shaders;
  constexpr std::uint32_t kUnlit =
      FEATURE_UNLIT | FEATURE_VERTEX_COLOR | FEATURE_MASK | FEATURE_PREMULTIPLIED | slotBit(SLOT_BASE_COLOR);
  constexpr std::uint32_t kLit = FEATURE_VERTEX_COLOR | FEATURE_TRANSMISSION | FEATURE_FLAT | FEATURE_LIGHTS;
  constexpr std::uint32_t kTextured = kLit | FEATURE_MASK | FEATURE_PREMULTIPLIED | slotBit(SLOT_BASE_COLOR) |
                                      slotBit(SLOT_METALLIC_ROUGHNESS) | slotBit(SLOT_NORMAL) |
                                      slotBit(SLOT_OCCLUSION) | slotBit(SLOT_EMISSIVE);
  // What the draw's blend mode, or its corners, say.
  const bool triangles = (features & (FEATURE_LINES | FEATURE_POINTS)) == 0;
  features &= ~(FEATURE_ADDITIVE | FEATURE_SOLID);
  if ((features & FEATURE_UNLIT) != 0 && (features & ~kUnlit) == 0) return shadeSurface<kUnlit>;
  if (features == 0 && triangles) return shadePlain;
  if ((features & ~kLit) == 0) return shadeSurface<kLit>;
  if ((features & ~kTextured) == 0) return shadeSurface<kTextured>;
  return shadeSurface<~0U>;
}

// Fills a row, 4 floats a pixel, with the sky.
void skyRow(const shaders::FrameData& frame, std::uint32_t row, float* rgba, std::size_t width) {
  const Tag d;
  const glm::vec4& ray = frame.ray;
  const glm::mat4& axes = frame.cameraToWorld;
  const float down = ray.w - (static_cast<float>(row) + 0.5F) * ray.y;
  alignas(64) float columns[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) columns[i] = static_cast<float>(i) + 0.5F;
  const Float3 horizon{set(0.70F), set(0.78F), set(0.88F)};
  const Float3 zenith{set(0.18F), set(0.36F), set(0.70F)};
  const Float3 ground{set(0.30F), set(0.28F), set(0.26F)};
  const Float3 toRow = mulAdd(set3(axes[1]), set(down), Float3{set(-axes[2].x), set(-axes[2].y), set(-axes[2].z)});
  for (std::size_t x = 0; x < width; x += kLanes) {
    const V column = set(static_cast<float>(x)) + load(columns);
    const Float3 along = mulAdd(set3(axes[0]), hn::MulSub(column, set(ray.x), set(ray.z)), toRow);
    const V y = along.y * inverseSqrt(dot(along, along));
    const Float3 color = mix(horizon, select(y >= zero(), zenith, ground), hn::Sqrt(hn::Abs(y)));
    if (x + kLanes <= width) {
      hn::StoreInterleaved4(color.x, color.y, color.z, one(), d, rgba + 4 * x);
      continue;
    }
    alignas(64) float last[4 * kLanes];
    hn::StoreInterleaved4(color.x, color.y, color.z, one(), d, last);
    std::copy_n(last, 4 * (width - x), rgba + 4 * x);
  }
}

} // namespace HWY_NAMESPACE
} // namespace vitrail::tool
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrail::tool {

namespace {

HWY_EXPORT(functionOf);
HWY_EXPORT(skyRow);

// The targets of Highway that stand for some instructions; 0: what every processor has.
std::int64_t targetsOf(VitrailCpuInstructions instructions) {
  switch (instructions) {
    case VITRAIL_CPU_SSE4:
      return HWY_SSE4;
    case VITRAIL_CPU_AVX2:
      return HWY_AVX2;
    case VITRAIL_CPU_AVX512:
      return HWY_AVX3;
    case VITRAIL_CPU_NEON:
      return HWY_NEON;
    case VITRAIL_CPU_BASELINE:
      return 0;
    default:
      return ~std::int64_t{0};
  }
}

std::size_t dispatchIndex(VitrailCpuInstructions instructions) {
  // Asked once: in a virtual machine every question to the processor takes microseconds.
  static const std::int64_t supported = hwy::SupportedTargets();
  hwy::ChosenTarget target;
  target.Update(supported & targetsOf(instructions));
  return target.GetIndex();
}

float constantAlpha(const shaders::MaterialData& material) {
  return material.opacity * glm::mix(1.0F, material.baseColor.a, material.alphaFromBase);
}

bool hasConstantColor(std::uint32_t features) {
  constexpr std::uint32_t kVaries =
      shaders::FEATURE_VERTEX_COLOR | ((1U << shaders::SLOT_COUNT) - 1U); // MASK cuts all of it or nothing
  return (features & shaders::FEATURE_UNLIT) != 0 && (features & kVaries) == 0;
}

} // namespace

ShadeFrame makeShadeFrame(const shaders::FrameData& data, std::vector<shaders::LightData> lights) {
  ShadeFrame frame;
  frame.data = data;
  const glm::dmat3 axes{glm::dmat4(data.cameraToWorld)};
  const glm::dvec4 ray(data.ray);
  frame.toEye = axes[0] * ray.z - axes[1] * ray.w + axes[2];
  frame.toEyeX = -axes[0] * ray.x;
  frame.toEyeY = axes[1] * ray.y;
  frame.lights = std::move(lights);
  return frame;
}

PlainSurface makePlainSurface(const shaders::MaterialData& material) {
  const glm::dvec3 low(0.18, 0.17, 0.16);
  const glm::dvec3 rise(0.18, 0.21, 0.26);
  const double metallic = std::clamp(double{material.metallic}, 0.0, 1.0);
  const double roughness = std::clamp(double{material.roughness}, 0.045, 1.0);
  const glm::dvec3 base{glm::vec3(material.baseColor)};
  const glm::dvec3 f0 = glm::mix(glm::dvec3(0.04), base, metallic);
  const glm::dvec3 diffuse = (1.0 - metallic) * base;
  PlainSurface plain;
  plain.a2 = static_cast<float>(std::pow(roughness, 4.0));
  plain.alpha = constantAlpha(material);
  for (int c = 0; c < 3; ++c) {
    const auto i = static_cast<std::size_t>(c);
    plain.diffuseOverPi.at(i) = static_cast<float>(diffuse[c] / std::numbers::pi);
    plain.f0.at(i) = static_cast<float>(f0[c]);
    plain.rest.at(i) = static_cast<float>(1.0 - f0[c]);
    plain.ambientRise.at(i) = static_cast<float>(std::max(1.0 - roughness, f0[c]) - f0[c]);
    plain.ambientAndOwn.at(i) = static_cast<float>(low[c] * diffuse[c] + double{material.emissive[c]});
    plain.ambientSky.at(i) = static_cast<float>(rise[c] * diffuse[c]);
  }
  return plain;
}

ShadeDraw makeShadeDraw(const ShadeFrame& frame, const ShadeSurface& surface, const glm::mat4& place, bool mirrored) {
  ShadeDraw draw;
  draw.frame = &frame;
  draw.surface = &surface;
  const glm::dmat3 matrix{glm::dmat4(place)};
  const glm::dmat4 transposed = glm::transpose(glm::dmat4(place));
  double size = 0.0;
  for (int i = 0; i < 3; ++i) {
    draw.rows.at(static_cast<std::size_t>(i)) = transposed[i];
    for (int k = 0; k < 3; ++k) size = std::max(size, std::abs(matrix[i][k]));
  }
  // Normals turn as planes do: by the cofactors, which exist even where the transform has no inverse, scaled so that
  // their squares stay in the range of a float. A mirror's cofactors point inwards, and it turns cross(normal, tangent)
  // round: the sign of both turns with it.
  const glm::dmat3 rows = glm::transpose(matrix) * (size > 0.0 ? 1.0 / size : 0.0);
  const glm::dmat3 cofactors(glm::cross(rows[1], rows[2]), glm::cross(rows[2], rows[0]), glm::cross(rows[0], rows[1]));
  const double determinant = glm::dot(rows[0], cofactors[0]);
  draw.mirrored = determinant < 0.0 ? -1.0F : 1.0F;
  draw.normals = cofactors * static_cast<double>(draw.mirrored);
  draw.tangents = rows;
  draw.keepsDirections = rows == glm::dmat3(rows[0][0]) && rows[0][0] > 0.0;
  draw.longer = static_cast<float>(size * std::cbrt(std::abs(determinant)));
  constexpr std::uint32_t kAll = 0xffffU;
  // A mirror turns the triangles round, and glTF means the side that was outside before. Lines and points have no back.
  if (mirrored) draw.flipped = kAll;
  if (surface.mesh.corners < 3) draw.front = kAll;
  return draw;
}

ShadeFunction shadeFunction(const ShadeSurface& surface, VitrailCpuInstructions instructions) {
  const std::uint32_t features = surface.features;
  if (hasConstantColor(features)) return {};
  ShadeFunction function;
  function.shade = HWY_DISPATCH_TABLE(functionOf)[dispatchIndex(instructions)](features);
  if ((features & ((1U << shaders::SLOT_COUNT) - 1U)) != 0) function.flags |= VITRAIL_CPU_SHADE_DERIVATIVES;
  if ((features & shaders::FEATURE_MASK) != 0) function.flags |= VITRAIL_CPU_SHADE_DISCARD;
  if ((features & shaders::FEATURE_TRANSMISSION) != 0) function.flags |= VITRAIL_CPU_SHADE_FILTER;
  return function;
}

float leastAlphaOf(const ShadeSurface& surface) {
  constexpr std::uint32_t kVaries = shaders::FEATURE_VERTEX_COLOR | 1U << shaders::SLOT_BASE_COLOR;
  constexpr std::uint32_t kHidesLess =
      shaders::FEATURE_MASK | shaders::FEATURE_TRANSMISSION | shaders::FEATURE_ADDITIVE;
  const shaders::MaterialData& material = surface.material;
  if ((surface.features & kHidesLess) != 0) return 0.0F;
  if ((surface.features & kVaries) != 0 && material.alphaFromBase > 0.0F) return 0.0F;
  return std::clamp(constantAlpha(material) * 0.999999F, 0.0F, 1.0F); // a little less, for what rounds
}

glm::vec4 constantColor(const ShadeSurface& surface) {
  const shaders::MaterialData& material = surface.material;
  return {glm::vec3(material.baseColor), constantAlpha(material)};
}

bool isMaskedAway(const ShadeSurface& surface) {
  return hasConstantColor(surface.features) && (surface.features & shaders::FEATURE_MASK) != 0 &&
         surface.material.baseColor.a < surface.material.alphaCutoff;
}

void shadeSky(const shaders::FrameData& frame, std::uint32_t row, std::span<float> rgba) {
  HWY_DISPATCH_TABLE(skyRow)[dispatchIndex(VITRAIL_CPU_BEST)](frame, row, rgba.data(), rgba.size() / 4);
}

} // namespace vitrail::tool

#endif
