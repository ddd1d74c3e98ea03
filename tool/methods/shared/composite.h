// The last pass of methods that draw surfaces into planes, images of their own as large as the picture: a compute
// shader (composite.glsl) puts the planes over the opaque scene, sample by sample.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "../../gpu/descriptors.h"
#include "../../gpu/pixel_pass.h"
#include "../../gpu/used_image.h"
#include "../method.h"

namespace vitrail::tool {

// Whether some transparent surfaces add light or tint what is behind them, so that the light that they let through
// differs between channels and from what their own colour hides.
bool hasFilters(const MethodHost& host);

// A plane: a colour attachment that shaders sample.
GpuImageInfo planeInfo(VkExtent2D extent, VkFormat format, std::uint32_t samples);

struct CompositeInfo {
  std::span<const std::uint32_t> one;     // the shader for one sample a pixel
  std::span<const std::uint32_t> several; // the same, compiled with SEVERAL_SAMPLES
  std::uint32_t planes = 0;
  std::uint32_t samples = 1;
  bool filters = false;
  std::string name;
};

class Composite {
 public:
  // Throws GpuError.
  Composite(Gpu& gpu, const CompositeInfo& info);

  // No frame is pending, for both.
  void setTarget(const MethodTarget& target);
  void setPlane(std::uint32_t plane, const UsedImage& image);

  // Puts `planes` over the picture. Outside a rendering scope.
  void cmdComposite(Frame& frame, std::span<UsedImage* const> planes) const;

 private:
  bool severalSamples_;
  SingleSet set_;
  PixelPass pass_;
};

} // namespace vitrail::tool
