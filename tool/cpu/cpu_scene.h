#pragma once
#include <vitrail/cpu.h>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "../scene/camera.h"
#include "../scene/scene.h"
#include "../stage/draw_order.h"
namespace vitrail::tool {
class CpuScene {
 public:
  CpuScene(const Scene&, std::optional<float>, DrawOrder) {}
  CpuScene(Scene&&, std::optional<float>, DrawOrder) {}
  std::span<const VitrailCpuDraw> draws(const View&, std::uint32_t, std::uint32_t) { return {}; }
  bool hasTransparent() const { return false; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::vector<std::string> warnings_;
};
inline void drawBackground(const Background&, const View&, std::uint32_t width, std::uint32_t, std::uint32_t,
                           std::uint32_t rows, float* rgba) {
  for (std::size_t i = 0; i < std::size_t{width} * rows * 4; ++i) rgba[i] = 1.0F;
}
} // namespace vitrail::tool
