// A host of the raster (vitrail/vulkan_raster.h): vertices in clip space, draws, and a picture of 32-bit floats.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <vitrail/vitrail.hpp>

#include "backend.h"
#include "objects.h"

namespace vitrail::tests::vulkan {

using Vec4 = std::array<float, 4>;

// Each combination of these has pipelines of its own, which take CPU drivers seconds to compile: tests leave them as
// they are but where they are about them.
struct RasterHostDesc {
  std::uint32_t width = 32;
  std::uint32_t height = 32;
  std::uint32_t samples = 1;
  VitrailDepthOrder depthOrder = VITRAIL_DEPTH_NEAREST_IS_ZERO;
  VkIndexType indexType = VK_INDEX_TYPE_UINT32;
  bool keepsPositions = true;
  std::uint32_t blendModes = 0;
  bool shadesTwice = false; // with one sample
  bool solids = false;
  VkDeviceSize memoryBudget = 0;
  VitrailVkRasterHints hints{};
  std::uint32_t framesInFlight = 2;
  const Context* context = nullptr; // default: one of the backend's
};

// What it draws. Indices are stored as indexType says.
struct RasterScene {
  std::vector<Vec4> vertices; // clip space
  std::vector<std::uint32_t> indices;
  std::vector<VitrailVkRasterDraw> draws;
  std::vector<Vec4> colors; // by the draws' words
  std::vector<Vec4> shifts; // of instances; at least one
  std::vector<std::uint32_t> orders;
  Vec4 behind{0.0F, 0.0F, 0.0F, 1.0F};
  std::optional<float> opaqueDepth; // of the whole picture; default: the farthest
};

class RasterHost {
 public:
  // Throws HostError where the raster cannot be made; the log has the reason.
  explicit RasterHost(const RasterHostDesc& desc);

  static VitrailVkRasterDesc descOf(const RasterHostDesc& desc, VkDescriptorSetLayout layout);

  void setScene(const RasterScene& scene);
  // Draws a frame and waits for it.
  const std::vector<float>& drawOnce();
  // Draws until the picture is exact, at most so many times, following what frames need.
  const std::vector<float>& draw(int most = 12);
  // The frame's commands, without what is before and behind them.
  void record(VkCommandBuffer commands);
  // The same in the images as the last part of the frame has left them.
  void recordMore(VkCommandBuffer commands);
  // What drawOnce() does, for tests that record and wait for themselves.
  void recordAll(VkCommandBuffer commands);
  void readPicture();

  [[nodiscard]] VitrailVkRasterStats stats();
  [[nodiscard]] Vec4 at(std::uint32_t x, std::uint32_t y) const;
  vitrail::vulkan::Raster& raster() { return raster_; }
  VitrailVkRasterInfo& info() { return info_; } // of the next frames
  Commands& commands() { return commands_; }
  [[nodiscard]] VkDescriptorSetLayout layout() const { return layout_.get(); }
  [[nodiscard]] const std::vector<float>& picture() const { return picture_; }

 private:
  void writeSet();
  void copyPicture(VkCommandBuffer commands);

  RasterHostDesc desc_;
  Device& device_;
  Commands commands_;
  Owned<VkDescriptorSetLayout> layout_;
  Owned<VkDescriptorPool> pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  Image color_;
  Image opaque_;
  Image depth_;
  Buffer readback_;
  Buffer vertices_;
  Buffer indices_;
  Buffer draws_;
  Buffer colors_;
  Buffer shifts_;
  Buffer orders_;
  RasterScene scene_;
  VitrailVkRasterInfo info_{};
  std::vector<float> picture_;
  vitrail::vulkan::Raster raster_; // last: it goes first
};

} // namespace vitrail::tests::vulkan
