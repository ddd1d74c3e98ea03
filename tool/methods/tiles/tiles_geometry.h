// The scene as the compute shaders of the method tiles reach it: sets 1 and 2, textures and geometry.
#pragma once

#include <cstdint>
#include <vector>

#include "../../gpu/descriptors.h"
#include "../../gpu/resources.h"
#include "../method.h"
#include "tiles_shared.h"

namespace vitrail::tool {

class TilesGeometry {
 public:
  // Throws GpuError where a shader of the device cannot reach all of it.
  explicit TilesGeometry(const MethodHost& host);

  VkDescriptorSetLayout textureLayout() const { return textureLayout_.get(); }
  VkDescriptorSet textures() const { return textureSet_; }
  VkDescriptorSetLayout layout() const { return set_.layout(); }
  VkDescriptorSet set() const { return set_.set(); }

  std::uint32_t groups() const { return groups_; } // work groups that set up all triangles
  std::uint64_t triangles() const { return triangles_; }
  // Work groups that bring the vertices into clip space. 0: there is no room for that, and shaders do without.
  std::uint32_t cornerGroups() const { return cornerGroups_; }
  // Of the buffers that the scene does not have without this method, the corners' above all.
  std::uint64_t bytes() const;
  std::uint32_t anyFeatures() const { return anyFeatures_; }
  std::uint32_t allFeatures() const { return allFeatures_; }
  std::uint32_t textureCount() const { return textureCount_; }
  // Whether only constants choose of the shaders' table of textures, which then has TILES_CONSTANT_TEXTURES places.
  bool constantTextures() const { return constantTextures_; }

 private:
  void listDraws(const Surfaces& surfaces);
  void listTextures(const Surfaces& surfaces);
  void planCorners();
  void makeTextureLayout();
  void makeTextureSet();
  std::uint32_t texturePlaces() const { return constantTextures_ ? shaders::TILES_CONSTANT_TEXTURES : textureCount_; }
  void writeSet(const Surfaces& surfaces);

  Gpu& gpu_;
  std::vector<shaders::TilesDraw> list_;
  std::vector<std::pair<VkImageView, VkSampler>> table_;
  SingleSet set_;
  GpuBuffer drawBuffer_;
  GpuBuffer instanceDraws_;
  GpuBuffer groupDraws_;
  GpuBuffer cornerPlaces_;
  GpuBuffer cornerNormals_;
  GpuBuffer cornerGroupDraws_;
  Unique<VkDescriptorSetLayout> textureLayout_;
  Unique<VkDescriptorPool> texturePool_;
  VkDescriptorSet textureSet_ = VK_NULL_HANDLE;
  bool constantTextures_ = false;
  std::uint32_t draws_ = 0;
  std::uint32_t groups_ = 0;
  std::uint32_t cornerGroups_ = 0;
  std::uint64_t corners_ = 0;
  std::uint64_t triangles_ = 0;
  std::uint32_t anyFeatures_ = 0;
  std::uint32_t allFeatures_ = 0xffffffffU;
  std::uint32_t textureCount_ = 0;
};

} // namespace vitrail::tool
