// The point host of Vulkan: dynamic rendering, one command buffer, one frame after the other.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <vitrail/vitrail.hpp>

#include "../host.h"
#include "backend.h"
#include "list_walker.h"
#include "objects.h"
#include "point_images.h"
#include "point_pipelines.h"

namespace vitrail::tests::vulkan {

// What hosts of Vulkan may do in another way.
struct VulkanOptions {
  bool update = true; // vitrailVkUpdateTarget() before each frame
  std::uint32_t framesInFlight = 0;
  // The barriers between the calls are this host's. It makes all but this one.
  bool hostBarriers = false;
  std::optional<VitrailVkBarrierPoint> omitted;
};

class VulkanHost : public PointHost {
 public:
  VulkanHost(VulkanBackend& backend, const HostDesc& desc, const VulkanOptions& options = {});

  std::vector<PointResult> drawTogether(const std::vector<std::vector<Point>>& frames) override;
  std::array<PointResult, 2> drawAcrossResize(std::span<const Point> first, Extent extent,
                                              std::span<const Point> second, std::uint32_t capacity) override;
  PointResult drawAreas(std::span<const Point> points, const NextArea& next) override;
  PointResult drawScattered(std::span<const Point> points) override;
  ListsRead drawAndRead(std::span<const Point> points, const VitrailRect& area, ReadBy by, bool afterResolve) override;
  CallsResult drawCalls(const std::function<void(FrameCalls&)>& make) override;
  void drop(std::span<const Point> points) override;
  [[nodiscard]] bool guardsUntouched() override;
  [[nodiscard]] std::vector<std::uint32_t> words(StoragePart StorageLayout::*part) override;
  [[nodiscard]] VitrailMemory memory() const override { return target_.memory(); }
  [[nodiscard]] std::uint64_t newestFrame() const override { return target_.frame(); }
  [[nodiscard]] std::optional<VitrailStats> stats(std::uint64_t frame) const override;

  // Gives the target another size. The frames before have finished.
  void resize(Extent extent, std::uint32_t capacity = 0);

  // How long the library's calls and the points take to execute, and no more than those.
  double seconds(std::span<const Point> points);

  [[nodiscard]] Target& target() { return target_; }
  [[nodiscard]] const Context& context() const { return *context_; }
  [[nodiscard]] VitrailVkTargetDesc targetDesc(); // what the target is made with

 private:
  class Calls;
  // Points in memory that the device reads.
  struct Vertices {
    std::span<const Point> points;
    Buffer buffer;
  };

  void makeImages();
  void update(std::uint64_t frame);
  [[nodiscard]] VitrailVkViews views();
  void guard(VitrailVkTargetDesc& desc);
  PointPipelines& pipelinesFor(VitrailVkTargetDesc target, bool specialized);
  [[nodiscard]] Vertices upload(std::span<const Point> points) const;
  PointImages& imagesOf(std::uint64_t frame) { return images_[frame % kFramesTogether]; }

  void cmdHostBarrier(VkCommandBuffer commands, VitrailVkBarrierPoint point) const;
  void recordBegin(VkCommandBuffer commands, std::uint64_t frame, const VkRect2D& area);
  void recordCollected(VkCommandBuffer commands);
  void recordEnd(VkCommandBuffer commands);
  void recordPoints(VkCommandBuffer commands, PointImages& images, const Vertices& vertices);
  void recordRequests(VkCommandBuffer commands);
  void recordResolve(VkCommandBuffer commands, PointImages& images, std::uint64_t view);
  void recordFrame(VkCommandBuffer commands, std::uint64_t frame, PointImages& images, const VkRect2D& area,
                   const Vertices& vertices);
  void recordRead(VkCommandBuffer commands, const VitrailRect& area, ListWalker* walker, const Buffer& copy);
  void scatter();
  [[nodiscard]] std::vector<std::uint32_t> wordsAt(VkDeviceSize offset, VkDeviceSize size); // of memory_
  [[nodiscard]] PointResult read(const PointImages& images, std::uint64_t frame) const;
  [[nodiscard]] VkRect2D wholeArea() const { return {{0, 0}, {desc_.width, desc_.height}}; }

  VulkanBackend& backend_;
  const Device& device_;
  HostDesc desc_;
  VulkanOptions options_;
  bool postDepthCoverage_ = false;
  std::uint64_t frame_ = 0;
  Context* context_ = nullptr;
  std::array<PointImages, kFramesTogether> images_; // of frame n: n % kFramesTogether
  // What views() points to.
  std::array<VkImageView, kFramesTogether> colorViews_{};
  std::array<VkImageView, kFramesTogether> opaqueViews_{};
  std::array<VkImageView, kFramesTogether> depthViews_{};
  VkDeviceSize guardBytes_ = 0;
  StorageLayout storage_; // of the memory between the guards
  Buffer memory_;         // guards, the library's memory, guards
  Target target_;
  PointPipelines* pipelines_ = nullptr; // shared
  PointPipelines* strangers_ = nullptr; // of strangers; shared
  Commands commands_;
};

} // namespace vitrail::tests::vulkan
