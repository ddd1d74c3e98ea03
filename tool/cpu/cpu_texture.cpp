#include "cpu_texture.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include <glm/gtc/packing.hpp>

#include "../scene/srgb.h"
#include "../scene/threads.h"
#include "../stage/material_data.h"

namespace vitrail::tool {

namespace {

// The sRGB curve on 8-bit codes, both ways.
class SrgbCodes {
 public:
  SrgbCodes() {
    for (std::size_t i = 0; i < 256; ++i) {
      linear_.at(i) = static_cast<float>(linearFromSrgb(static_cast<double>(i) / 255.0));
      // Where the code i + 1 begins: in the middle between them, on the curve.
      next_.at(i) = i < 255 ? static_cast<float>(linearFromSrgb((static_cast<double>(i) + 0.5) / 255.0))
                            : std::numeric_limits<float>::infinity();
    }
    std::uint8_t code = 0;
    for (std::size_t i = 0; i < first_.size(); ++i) {
      while (static_cast<float>(i) / kSteps >= next_.at(code)) ++code;
      first_.at(i) = code;
    }
  }

  float linear(std::uint32_t code) const { return linear_[code]; }

  std::uint32_t code(float linear) const {
    std::uint32_t result = first_[static_cast<std::size_t>(std::clamp(linear, 0.0F, 1.0F) * kSteps)];
    while (linear >= next_[result]) ++result;
    return result;
  }

 private:
  static constexpr float kSteps = 4096.0F; // finer than the codes: a step holds one or two

  std::array<float, 256> linear_{};
  std::array<float, 256> next_{};
  std::array<std::uint8_t, 4097> first_{}; // the code at which a step begins
};

const SrgbCodes& srgbCodes() {
  static const SrgbCodes codes;
  return codes;
}

glm::vec4 unpack(const CpuTexture& texture, std::size_t i) {
  if (texture.kind == Texels::Premultiplied) {
    return {glm::unpackHalf2x16(texture.texels[2 * i]), glm::unpackHalf2x16(texture.texels[2 * i + 1])};
  }
  const std::uint32_t texel = texture.texels[i];
  const glm::uvec4 codes(texel & 255U, texel >> 8U & 255U, texel >> 16U & 255U, texel >> 24U);
  if (texture.kind == Texels::Linear) return glm::vec4(codes) / 255.0F;
  const SrgbCodes& srgb = srgbCodes();
  return {srgb.linear(codes.r), srgb.linear(codes.g), srgb.linear(codes.b), static_cast<float>(codes.a) / 255.0F};
}

std::uint32_t step8(float value) { return static_cast<std::uint32_t>(value * 255.0F + 0.5F); }

void pack(CpuTexture& texture, std::size_t i, const glm::vec4& value) {
  if (texture.kind == Texels::Premultiplied) {
    texture.texels[2 * i] = glm::packHalf2x16(glm::vec2(value));
    texture.texels[2 * i + 1] = glm::packHalf2x16(glm::vec2(value.b, value.a));
    return;
  }
  glm::uvec4 codes(step8(value.r), step8(value.g), step8(value.b), step8(value.a));
  if (texture.kind == Texels::Srgb) {
    const SrgbCodes& srgb = srgbCodes();
    codes = {srgb.code(value.r), srgb.code(value.g), srgb.code(value.b), codes.a};
  }
  texture.texels[i] = codes.r | codes.g << 8U | codes.b << 16U | codes.a << 24U;
}

// The two texels between which a blit's filter reads along an axis, and the second one's weight.
struct Tap {
  std::int32_t first = 0;
  std::int32_t second = 0;
  float weight = 0.0F;
};

std::vector<Tap> tapsOf(std::int32_t from, std::int32_t to) {
  std::vector<Tap> taps(static_cast<std::size_t>(to));
  for (std::int32_t i = 0; i < to; ++i) {
    const double place = (i + 0.5) * from / to - 0.5;
    const auto first = static_cast<std::int32_t>(std::floor(place));
    taps[static_cast<std::size_t>(i)] = {std::clamp(first, 0, from - 1), std::clamp(first + 1, 0, from - 1),
                                         static_cast<float>(place - first)};
  }
  return taps;
}

// Fills a level with what the one before holds.
void shrink(CpuTexture& texture, std::size_t level) {
  const std::size_t before = level - 1;
  const std::vector<Tap> columns = tapsOf(texture.width.at(before), texture.width.at(level));
  const std::vector<Tap> rows = tapsOf(texture.height.at(before), texture.height.at(level));
  const auto row = [&](std::int32_t y) {
    return static_cast<std::size_t>(texture.offset.at(before) + y * texture.width.at(before));
  };
  auto to = static_cast<std::size_t>(texture.offset.at(level));
  for (const Tap& y : rows) {
    const std::size_t upper = row(y.first);
    const std::size_t lower = row(y.second);
    for (const Tap& x : columns) {
      const auto across = [&](std::size_t line) {
        return glm::mix(unpack(texture, line + static_cast<std::size_t>(x.first)),
                        unpack(texture, line + static_cast<std::size_t>(x.second)), x.weight);
      };
      pack(texture, to++, glm::mix(across(upper), across(lower), y.weight));
    }
  }
}

// Fills the base level.
void copyBase(CpuTexture& texture, const Image& image) {
  const std::size_t count = std::size_t{image.width} * image.height;
  if (texture.kind == Texels::Premultiplied) {
    const std::vector<std::uint16_t> halves = premultiply(image);
    for (std::size_t i = 0; i < 2 * count; ++i) {
      texture.texels[i] = halves[2 * i] | static_cast<std::uint32_t>(halves[2 * i + 1]) << 16U;
    }
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* texel = &image.rgba[4 * i];
    texture.texels[i] = texel[0] | static_cast<std::uint32_t>(texel[1]) << 8U |
                        static_cast<std::uint32_t>(texel[2]) << 16U | static_cast<std::uint32_t>(texel[3]) << 24U;
  }
}

// Whether all texels of a level are nothing that are read anywhere in a cell of the grid.
bool isEmptyCell(const CpuTexture& texture, std::size_t level, std::int32_t column, std::int32_t row) {
  const std::int32_t width = texture.width.at(level);
  const std::int32_t height = texture.height.at(level);
  const auto isNothing = [&](std::int32_t x, std::int32_t y) {
    const auto i = 2 * static_cast<std::size_t>(texture.offset.at(level) + y * width + x);
    return texture.texels[i] == 0 && texture.texels[i + 1] == 0;
  };
  // The left neighbour of a cell's first place, and one more for what rounds.
  const auto firstOf = [](std::int32_t cell, std::int32_t size) {
    return static_cast<std::int32_t>(std::floor(static_cast<double>(cell) * size / CpuTexture::kCells - 0.5)) - 1;
  };
  const std::int32_t right = firstOf(column + 1, width) + 3;
  const std::int32_t bottom = firstOf(row + 1, height) + 3;
  for (std::int32_t y = firstOf(row, height); y <= bottom; ++y) {
    const std::int32_t inY = std::clamp(y, 0, height - 1);
    for (std::int32_t x = firstOf(column, width); x <= right; ++x) {
      const std::int32_t inX = std::clamp(x, 0, width - 1);
      if (!isNothing(inX, inY)) return false;
      if (inX == x && inY == y) continue;
      // Beyond the border may be the texel at it or, where the image repeats, those at the other one.
      const std::int32_t otherX = (x + 4 * width) % width;
      const std::int32_t otherY = (y + 4 * height) % height;
      if (!isNothing(otherX, otherY) || !isNothing(inX, otherY) || !isNothing(otherX, inY)) return false;
    }
  }
  return true;
}

void findEmptyCells(CpuTexture& texture) {
  constexpr std::int32_t kCells = CpuTexture::kCells;
  const std::int32_t levels = std::min(texture.levels, CpuTexture::kEmptyLevels + 1);
  std::vector<std::int32_t> cells(std::size_t{kCells} * kCells);
  bool isAny = false;
  for (std::int32_t i = 0; i < kCells * kCells; ++i) {
    bool isEmpty = true;
    for (std::int32_t level = levels - 1; isEmpty && level >= 0; --level) {
      isEmpty = isEmptyCell(texture, static_cast<std::size_t>(level), i % kCells, i / kCells);
    }
    cells[static_cast<std::size_t>(i)] = isEmpty ? 1 : 0;
    isAny = isAny || isEmpty;
  }
  if (isAny) texture.emptyCells = std::move(cells);
}

} // namespace

CpuTexture makeCpuTexture(const Image& image, Texels kind) {
  CpuTexture texture;
  texture.kind = kind;
  texture.levels = std::bit_width(std::max(image.width, image.height));
  if (texture.levels > static_cast<std::int32_t>(CpuTexture::kMostLevels)) {
    throw std::length_error("a texture is more than 65535 texels wide or high");
  }
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(texture.levels); ++i) {
    texture.width.at(i) = static_cast<std::int32_t>(std::max(image.width >> i, 1U));
    texture.height.at(i) = static_cast<std::int32_t>(std::max(image.height >> i, 1U));
    texture.offset.at(i) = static_cast<std::int32_t>(count);
    count += static_cast<std::uint64_t>(texture.width.at(i)) * static_cast<std::uint64_t>(texture.height.at(i));
    if (count > std::uint64_t{std::numeric_limits<std::int32_t>::max()}) {
      throw std::length_error("a texture has more than 2^31 texels");
    }
  }
  texture.texels.resize(kind == Texels::Premultiplied ? 2 * count : count);
  copyBase(texture, image);
  for (std::size_t i = 1; i < static_cast<std::size_t>(texture.levels); ++i) shrink(texture, i);
  if (kind == Texels::Premultiplied) findEmptyCells(texture);
  return texture;
}

CpuTextures::CpuTextures(const Scene& scene, const std::vector<std::uint32_t>& used, Scene* released)
    : premultiplied_(premultipliedMaterials(scene, used)) {
  for (const std::uint32_t material : used) {
    const Material& source = scene.materials.at(material);
    const auto slots = slotsOf(source);
    for (std::uint32_t i = 0; i < shaders::SLOT_COUNT; ++i) {
      if (isFilled(scene, *slots.at(i)))
        textures_[{slots.at(i)->image, texelsOf(source, i, isPremultiplied(material))}];
    }
  }
  std::vector<std::pair<const Key, CpuTexture>*> todo;
  for (auto& entry : textures_) todo.push_back(&entry);
  std::atomic<std::size_t> next = 0;
  inParts(partsFor(todo.size(), 1), [&](std::size_t /*part*/) {
    for (std::size_t i = next++; i < todo.size(); i = next++) {
      const auto& [image, kind] = todo[i]->first;
      todo[i]->second = makeCpuTexture(scene.images.at(static_cast<std::size_t>(image)), kind);
    }
  });
  if (released == nullptr) return;
  for (Image& image : released->images) image.rgba = std::vector<std::uint8_t>();
}

CpuSlots CpuTextures::slots(const Scene& scene, std::uint32_t material, std::uint32_t features) const {
  const Material& source = scene.materials.at(material);
  const auto slots = slotsOf(source);
  CpuSlots result;
  for (std::uint32_t i = 0; i < shaders::SLOT_COUNT; ++i) {
    if ((features & 1U << i) == 0) continue;
    const TextureSlot& slot = *slots.at(i);
    result.at(i) = {&textures_.at({slot.image, texelsOf(source, i, isPremultiplied(material))}), slot.sampler};
  }
  return result;
}

} // namespace vitrail::tool
