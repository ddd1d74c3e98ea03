// What is under a pixel, from lists of the library for Vulkan: the surfaces of that pixel alone are collected, opaque
// ones too, and one invocation of a shader walks their list (vitrail/list.glsl).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "../stage/surfaces.h"
#include "pick.h"

namespace vitrail::tool {

class GpuPicker {
 public:
  // The facts are those of the scene that the surfaces show, which outlive it. Throws GpuError.
  GpuPicker(const Surfaces& surfaces, std::vector<DrawFacts> facts);
  ~GpuPicker();
  GpuPicker(const GpuPicker&) = delete;
  GpuPicker& operator=(const GpuPicker&) = delete;

  // As Picker::at(), of surfaces that are seen with that view; waits for it. What is stored rounds colours and alphas
  // (VITRAIL_NODE_HDR). None: the pixel has more surfaces than one shader lists here, and Picker does. Throws GpuError.
  std::optional<std::vector<PickedLayer>> at(const View& view, std::uint32_t width, std::uint32_t height,
                                             std::uint32_t x, std::uint32_t y);
  // The GPU's time for the last one; 0 on devices without timestamps.
  [[nodiscard]] double milliseconds() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vitrail::tool
