// The planes of a method: images that surfaces are blended into, each in a way of its own.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "composite.h"

namespace vitrail::tool {

// One plane.
struct PlaneInfo {
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::uint32_t bytes = 0; // of a pixel's sample
  VkPipelineColorBlendAttachmentState blend{};
  VkClearColorValue clear{}; // what it holds before surfaces are blended into it
};
PlaneInfo addingPlane(VkFormat format, std::uint32_t bytes);      // sums, from 0
PlaneInfo multiplyingPlane(VkFormat format, std::uint32_t bytes); // products, from 1

class Planes {
 public:
  Planes(std::vector<PlaneInfo> infos, std::uint32_t samples, std::string name);

  // The attachments of pipelines that draw into planes `first` to `first + count - 1`.
  std::vector<ColorOutput> outputs(std::size_t first, std::size_t count) const;

  // Makes the images of a picture's size and hands them to the composite. No frame is pending.
  void setTarget(Gpu& gpu, VkExtent2D extent, Composite& composite);
  void releaseTarget();
  std::uint64_t bytes() const;

  // Begins a scope over the whole picture, tested against the opaque depth, whose colours are those planes, cleared.
  void cmdBegin(Frame& frame, std::size_t first, std::size_t count);

  UsedImage& image(std::size_t plane) { return images_[plane]; }
  std::size_t size() const { return images_.size(); }
  // All of them.
  std::vector<UsedImage*> all();

 private:
  std::vector<PlaneInfo> infos_;
  std::uint32_t samples_;
  std::string name_;
  VkExtent2D extent_{};
  std::vector<UsedImage> images_;
};

} // namespace vitrail::tool
