// The textures and samplers of a scene, and one descriptor set for each combination that its materials use.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "../gpu/resources.h"
#include "../gpu/unique.h"
#include "../gpu/upload.h"
#include "../scene/scene.h"
#include "surface_shared.h"

namespace vitrail::tool {

class MaterialTextures {
 public:
  // Uploads what the materials named in `used` (indices, each once) sample.
  MaterialTextures(Gpu& gpu, Uploader& uploader, const Scene& scene, const std::vector<std::uint32_t>& used);

  // A combined image sampler for each slot; the slots that a material leaves empty hold a white texel.
  VkDescriptorSetLayout layout() const { return layout_.get(); }

  // The set of a material that was named in `used`.
  VkDescriptorSet set(std::uint32_t material) const { return sets_.at(setOfMaterial_.at(material)); }

  // One bit a slot, as in surface_shared.h: which slots a material fills.
  static std::uint32_t filledSlots(const Scene& scene, const Material& material);

 private:
  using Combination = std::array<std::pair<VkImageView, VkSampler>, shaders::SLOT_COUNT>;

  void createLayout();
  void createSets(const std::vector<Combination>& combinations);
  std::pair<VkImageView, VkSampler> slotTexture(Uploader& uploader, const Scene& scene, const TextureSlot& slot,
                                                bool srgb);
  VkImageView view(Uploader& uploader, const Scene& scene, std::uint32_t image, bool srgb);
  VkSampler sampler(const Sampler& sampler);

  Gpu& gpu_;
  std::map<std::pair<std::uint32_t, bool>, GpuImage> images_; // by image and whether it is read as sRGB
  GpuImage white_;
  std::vector<std::pair<Sampler, Unique<VkSampler>>> samplers_;
  Unique<VkDescriptorSetLayout> layout_;
  Unique<VkDescriptorPool> pool_;
  std::vector<VkDescriptorSet> sets_;
  std::map<std::uint32_t, std::size_t> setOfMaterial_;
};

} // namespace vitrail::tool
