// The point host of Vulkan: dynamic rendering, one command buffer, one frame after the other.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <vitrail/vitrail.hpp>

#include "../host.h"
#include "backend.h"
#include "objects.h"
#include "point_images.h"
#include "point_pipelines.h"

namespace vitrail::tests::vulkan {

class VulkanHost : public PointHost {
 public:
  VulkanHost(VulkanBackend& backend, const HostDesc& desc);

  std::vector<PointResult> drawTogether(const std::vector<std::vector<Point>>& frames) override;
  std::array<PointResult, 2> drawAcrossResize(std::span<const Point> first, Extent extent,
                                              std::span<const Point> second) override;
  PointResult drawAreas(std::span<const Point> points, const NextArea& next) override;
  PointResult drawScattered(std::span<const Point> points) override;
  void drop(std::span<const Point> points) override;
  [[nodiscard]] bool guardsUntouched() override;
  [[nodiscard]] std::vector<std::uint32_t> words(StoragePart StorageLayout::*part) override;
  [[nodiscard]] VitrailMemory memory() const override { return target_.memory(); }
  [[nodiscard]] std::optional<VitrailStats> stats(std::uint64_t frame) const override;

  [[nodiscard]] vitrail::vulkan::Target& target() { return target_; }
  [[nodiscard]] const vitrail::vulkan::Context& context() const { return *context_; }
  [[nodiscard]] VitrailVkTargetDesc targetDesc(); // what the target is made with

 private:
  // Points in memory that the device reads.
  struct Vertices {
    std::span<const Point> points;
    Buffer buffer;
  };

  void makeImages();
  [[nodiscard]] VitrailVkViews views();
  void guard(VitrailVkTargetDesc& desc);
  PointPipelines& pipelinesFor(VitrailVkTargetDesc target, bool specialized);
  [[nodiscard]] Vertices upload(std::span<const Point> points) const;
  PointImages& imagesOf(std::uint64_t frame) { return images_[frame % kFramesTogether]; }

  void recordPoints(VkCommandBuffer commands, PointImages& images, const Vertices& vertices);
  void recordRequests(VkCommandBuffer commands);
  void recordResolve(VkCommandBuffer commands, PointImages& images, std::uint64_t view);
  void recordFrame(VkCommandBuffer commands, std::uint64_t frame, PointImages& images, const VkRect2D& area,
                   const Vertices& vertices);
  void scatter();
  [[nodiscard]] std::vector<std::uint32_t> wordsAt(VkDeviceSize offset, VkDeviceSize size); // of memory_
  [[nodiscard]] PointResult read(const PointImages& images, std::uint64_t frame) const;
  [[nodiscard]] VkRect2D wholeArea() const { return {{0, 0}, {desc_.width, desc_.height}}; }

  VulkanBackend& backend_;
  const Device& device_;
  HostDesc desc_;
  bool postDepthCoverage_ = false;
  std::uint64_t frame_ = 0;
  vitrail::vulkan::Context* context_ = nullptr;
  std::array<PointImages, kFramesTogether> images_; // of frame n: n % kFramesTogether
  // What views() points to.
  std::array<VkImageView, kFramesTogether> colorViews_{};
  std::array<VkImageView, kFramesTogether> opaqueViews_{};
  std::array<VkImageView, kFramesTogether> depthViews_{};
  VkDeviceSize guardBytes_ = 0;
  StorageLayout storage_; // of the memory between the guards
  Buffer memory_;         // guards, the library's memory, guards
  vitrail::vulkan::Target target_;
  PointPipelines* pipelines_ = nullptr; // shared
  PointPipelines* strangers_ = nullptr; // of strangers; shared
  Commands commands_;
};

} // namespace vitrail::tests::vulkan
