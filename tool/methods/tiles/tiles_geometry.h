// The scene as the compute shaders of the method tiles reach it: sets 1 and 2, textures and geometry.
#pragma once

#include <cstdint>
#include <vector>

#include "../../gpu/descriptors.h"
#include "../../gpu/resources.h"
#include "../method.h"
#include "tiles_shared.h"

#include <vitrail/vulkan_raster.h>

namespace vitrail::tool {

class TilesGeometry {
 public:
  // Throws GpuError where a shader of the device cannot reach all of it.
  explicit TilesGeometry(const MethodHost& host);

  VkDescriptorSetLayout textureLayout() const { return textureLayout_.get(); }
  VkDescriptorSet textures() const { return textureSet_; }
  VkDescriptorSetLayout layout() const { return set_.layout(); }
  VkDescriptorSet set() const { return set_.set(); }

  // The draws for the raster, the order of each instance at one depth, and how much there is of all.
  std::uint32_t drawCount() const { return drawCount_; }
  const GpuBuffer& draws() const { return rasterDraws_; }
  const GpuBuffer& orders() const { return orders_; }
  VitrailVkRasterHints hints() const;
  // Whether there is room for the positions of all vertices of all instances; else shaders do without.
  bool keepsPositions() const { return keepsPositions_; }
  // Of the buffers that the scene does not have without this method.
  std::uint64_t bytes() const;
  std::uint32_t anyFeatures() const { return anyFeatures_; }
  std::uint32_t allFeatures() const { return allFeatures_; }
  std::uint32_t textureCount() const { return textureCount_; }
  // Whether only constants choose of the shaders' table of textures, which then has TILES_CONSTANT_TEXTURES places.
  bool constantTextures() const { return constantTextures_; }

 private:
  void listDraws(const Surfaces& surfaces);
  void listTextures(const Surfaces& surfaces);
  void planPositions();
  void makeTextureLayout();
  void makeTextureSet();
  std::uint32_t texturePlaces() const { return constantTextures_ ? shaders::TILES_CONSTANT_TEXTURES : textureCount_; }
  void writeSet(const Surfaces& surfaces);

  Gpu& gpu_;
  std::vector<shaders::TilesDraw> list_;
  std::vector<VitrailVkRasterDraw> rasterList_; // the same draws
  std::vector<std::pair<VkImageView, VkSampler>> table_;
  SingleSet set_;
  GpuBuffer drawBuffer_;
  GpuBuffer rasterDraws_;
  GpuBuffer orders_;
  GpuBuffer normals_; // in the world, where positions are kept
  Unique<VkDescriptorSetLayout> textureLayout_;
  Unique<VkDescriptorPool> texturePool_;
  VkDescriptorSet textureSet_ = VK_NULL_HANDLE;
  bool constantTextures_ = false;
  std::uint32_t drawCount_ = 0;
  std::uint64_t vertices_ = 0; // of all instances, and so on
  std::uint64_t triangles_ = 0;
  std::uint32_t instances_ = 0;
  bool keepsPositions_ = false;
  std::uint32_t anyFeatures_ = 0;
  std::uint32_t allFeatures_ = 0xffffffffU;
  std::uint32_t textureCount_ = 0;
};

} // namespace vitrail::tool
