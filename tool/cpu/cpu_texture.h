// Textures in memory as the shading on CPUs samples them: what MaterialTextures is on GPUs.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "../scene/scene.h"
#include "../stage/surface_shared.h"
#include "../stage/texels.h"

namespace vitrail::tool {

// An image with all its levels, each half as large as the one before, rounded down. They hold what vkCmdBlitImage's
// linear filter makes of them: sRGB texels are averaged in linear light and put back on the curve.
struct CpuTexture {
  static constexpr std::uint32_t kMostLevels = 16;

  Texels kind = Texels::Linear;
  std::int32_t levels = 0;
  // By level; `offset` is that of its first texel.
  alignas(64) std::array<std::int32_t, kMostLevels> width{};
  alignas(64) std::array<std::int32_t, kMostLevels> height{};
  alignas(64) std::array<std::int32_t, kMostLevels> offset{};
  // Texels of all levels: red in the lowest of four bytes; premultiplied ones take two words each, of 16-bit floats:
  // red and green, blue and alpha.
  std::vector<std::uint32_t> texels;

  // Premultiplied ones, where there are such places: a grid over the image, 1 where whatever is sampled there is
  // nothing, with coordinates from 0 to 1 and any wrap mode, in levels up to kEmptyLevels.
  static constexpr std::int32_t kCells = 64; // along each axis
  static constexpr std::int32_t kEmptyLevels = 2;
  std::vector<std::int32_t> emptyCells; // none: nowhere
};

// Throws std::length_error for an image that is too large.
CpuTexture makeCpuTexture(const Image& image, Texels kind);

// A texture slot of a material as it is sampled.
struct CpuSlot {
  const CpuTexture* texture = nullptr; // null: the slot is not sampled
  Sampler sampler;
};
using CpuSlots = std::array<CpuSlot, shaders::SLOT_COUNT>;

// The textures of a scene.
class CpuTextures {
 public:
  CpuTextures() = default;
  // Makes what the materials named in `used` (indices, each once) sample. `released`: the same scene, whose images are
  // let go of; or null.
  CpuTextures(const Scene& scene, const std::vector<std::uint32_t>& used, Scene* released);
  CpuTextures(const CpuTextures&) = delete;
  CpuTextures& operator=(const CpuTextures&) = delete;

  // Whether the base colour texture of a material that was named in `used` is premultiplied.
  bool isPremultiplied(std::uint32_t material) const { return premultiplied_.contains(material); }

  // The slots of such a material that are set in `features` (surface_shared.h). They last as long as this.
  CpuSlots slots(const Scene& scene, std::uint32_t material, std::uint32_t features) const;

 private:
  using Key = std::pair<std::int32_t, Texels>; // an image and how it is kept

  std::map<Key, CpuTexture> textures_;
  std::set<std::uint32_t> premultiplied_; // materials
};

} // namespace vitrail::tool
