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
#include "scene_draws.h"
#include "surface_shared.h"
#include "texels.h"

namespace vitrail::tool {

// The textures of a material's slots.
using TextureSet = std::array<std::pair<VkImageView, VkSampler>, shaders::SLOT_COUNT>;

class MaterialTextures {
 public:
  // Uploads what the materials of a scene's draws sample.
  MaterialTextures(Gpu& gpu, Uploader& uploader, const Scene& scene, const SceneDraws& draws);

  // A combined image sampler for each slot; the slots that a material leaves empty hold a white texel.
  VkDescriptorSetLayout layout() const { return layout_.get(); }

  // The set of a material that the draws have.
  VkDescriptorSet set(std::uint32_t material) const { return sets_.at(setOfMaterial_.at(material)); }
  const TextureSet& sampled(std::uint32_t material) const { return combinations_.at(setOfMaterial_.at(material)); }

 private:
  void createLayout();
  void createSets(const std::vector<TextureSet>& combinations);
  std::pair<VkImageView, VkSampler> slotTexture(Uploader& uploader, const Scene& scene, const TextureSlot& slot,
                                                Texels texels);
  VkImageView view(Uploader& uploader, const Scene& scene, std::uint32_t image, Texels texels);
  VkSampler sampler(const Sampler& sampler);

  Gpu& gpu_;
  std::map<std::pair<std::uint32_t, Texels>, GpuImage> images_; // by number
  GpuImage white_;
  std::vector<std::pair<Sampler, Unique<VkSampler>>> samplers_;
  Unique<VkDescriptorSetLayout> layout_;
  Unique<VkDescriptorPool> pool_;
  std::vector<TextureSet> combinations_;
  std::vector<VkDescriptorSet> sets_; // of each
  std::map<std::uint32_t, std::size_t> setOfMaterial_;
};

} // namespace vitrail::tool
