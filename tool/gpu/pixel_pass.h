// A compute shader that runs once for every pixel of a picture, in work groups of PIXEL_GROUP_SIDE squared
// (pixel_pass_shared.h). Groups at the picture's edges reach beyond it: the shader leaves those pixels out.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "descriptors.h"
#include "pipeline.h"

namespace vitrail::tool {

struct PixelPassInfo {
  std::span<const std::uint32_t> shader;
  std::string name;
  std::uint32_t constantBytes = 0; // push constants
  PipelineConstants constants{};   // specialization constants
};

class PixelPass {
 public:
  // `set` is the shader's set 0 and outlives the pass. Throws GpuError.
  PixelPass(Gpu& gpu, const SingleSet& set, const PixelPassInfo& info);

  // Runs the shader over `extent`. `constants` are its push constants, null where it has none. What it reads and writes
  // is there for it: barriers are the caller's. Outside a rendering scope.
  void cmdRun(VkCommandBuffer commands, VkExtent2D extent, const void* constants = nullptr) const;

 private:
  VkDescriptorSet set_;
  std::uint32_t constantBytes_;
  Unique<VkPipelineLayout> layout_;
  Unique<VkPipeline> pipeline_;
};

} // namespace vitrail::tool
