// Gathers the colours of a PLY element.
#include "ply_colors.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "../scene.h"
#include "../srgb.h"

namespace vitrail::tool {
namespace {

// What each byte becomes, as a 16-bit float.
struct ByteTables {
  std::array<std::uint64_t, 256> color{};
  std::array<std::uint64_t, 256> alpha{};

  ByteTables() {
    for (std::size_t i = 0; i < color.size(); ++i) {
      const float value = static_cast<float>(i) / 255.0F;
      color[i] = packColor(glm::vec4(linearFromSrgb(glm::vec3(value)).r, 0.0F, 0.0F, 0.0F));
      alpha[i] = packColor(glm::vec4(value, 0.0F, 0.0F, 0.0F));
    }
  }
};

std::size_t asByte(double value) { return value >= 0.0 ? static_cast<std::size_t>(std::min(value, 255.0) + 0.5) : 0; }

// What stands for all of a colour's channels `first` to `last`. Integers that never exceed 255 are bytes in a wider
// type, which many programs write; others run to 65535 or to their type's largest value. Floats run to 1, and to 255
// where any is above 2.
float fullValue(std::span<const glm::vec4> colors, int first, int last, PlyType type) {
  float largest = 0.0F;
  for (const glm::vec4& color : colors)
    for (int c = first; c <= last; ++c) largest = std::max(largest, color[c]); // passes a NaN over
  if (!isInteger(type)) return largest > 2.0F ? 255.0F : 1.0F;
  if (largest <= 255.0F) return 255.0F;
  return largest <= 65535.0F ? 65535.0F : largest <= 2147483648.0F ? 2147483648.0F : 4294967296.0F;
}

} // namespace

std::uint64_t packedFromSrgb(const glm::vec4& srgb) {
  glm::vec4 linear(linearFromSrgb(glm::vec3(srgb)), 1.0F);
  if (srgb.a < 1.0F) linear.a = std::max(srgb.a, 0.0F);
  return packColor(linear);
}

PlyColors::PlyColors(const PlyLayout& layout, std::vector<std::uint64_t>& packed)
    : hasHue_(layout.has(PlySlot::Red) && layout.has(PlySlot::Green) && layout.has(PlySlot::Blue)),
      type_(hasHue_ ? layout.typeOf(PlySlot::Red) : PlyType::Uint8),
      alphaType_(layout.typeOf(PlySlot::Alpha)),
      hasAlpha_(layout.has(PlySlot::Alpha)),
      packed_(packed) {}

void PlyColors::add(const PlyRow& row) {
  static const ByteTables tables;
  constexpr double plain = 231.0; // the byte whose light is nearest to plainMaterial()'s
  const double red = hasHue_ ? row[PlySlot::Red] : plain;
  const double green = hasHue_ ? row[PlySlot::Green] : plain;
  const double blue = hasHue_ ? row[PlySlot::Blue] : plain;
  if (type_ == PlyType::Uint8 && (!hasAlpha_ || alphaType_ == PlyType::Uint8)) {
    packed_.push_back(tables.color[asByte(red)] | tables.color[asByte(green)] << 16U |
                      tables.color[asByte(blue)] << 32U |
                      tables.alpha[hasAlpha_ ? asByte(row[PlySlot::Alpha]) : 255] << 48U);
    return;
  }
  glm::vec4 color(1.0F);
  color.r = narrowed(red);
  color.g = narrowed(green);
  color.b = narrowed(blue);
  if (hasAlpha_) color.a = narrowed(row[PlySlot::Alpha]);
  // Bytes with a sign are those of writers who meant them without.
  for (int c = 0; c < 4; ++c)
    if ((c < 3 ? type_ : alphaType_) == PlyType::Int8 && color[c] < 0.0F) color[c] += 256.0F;
  stated_.push_back(color);
}

void PlyColors::finish() {
  const float full = fullValue(stated_, 0, 2, type_);
  const float opaque = hasAlpha_ ? fullValue(stated_, 3, 3, alphaType_) : 1.0F;
  for (const glm::vec4& color : stated_) packed_.push_back(packedFromSrgb(color / glm::vec4(full, full, full, opaque)));
  stated_.clear();
}

} // namespace vitrail::tool
