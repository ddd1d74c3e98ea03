// A scene as draws of the library's rasteriser for CPUs (include/vitrail/cpu.h), shaded as docs/shading.md states it:
// what the stage's GpuScene and Surfaces are on GPUs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <vitrail/cpu.h>

#include "../scene/camera.h"
#include "../scene/scene.h"
#include "../stage/draw_order.h"

namespace vitrail::tool {

class CpuScene {
 public:
  // With `opacity` every material is transparent. `order` is that of the transparent draws, and of the triangles of
  // each. `instructions`: those that fragments are shaded with; what is not there, is replaced by less. Copies what it
  // needs: `scene` need not outlive it.
  CpuScene(const Scene& scene, std::optional<float> opacity, DrawOrder order,
           VitrailCpuInstructions instructions = VITRAIL_CPU_BEST);
  // The same, taking the meshes over: `scene` is left without their vertices and its images' texels.
  CpuScene(Scene&& scene, std::optional<float> opacity, DrawOrder order,
           VitrailCpuInstructions instructions = VITRAIL_CPU_BEST);
  ~CpuScene();
  CpuScene(CpuScene&& other) noexcept;
  CpuScene& operator=(CpuScene&& other) noexcept;

  // The draws of a picture, opaque ones first: of opaque surfaces in one plane the last one is to be seen. They are
  // for a frame with VITRAIL_CPU_CLIP_VULKAN and VITRAIL_DEPTH_NEAREST_IS_ONE, of that width and height; `word` is the
  // index of the scene's draw. What they point to lasts, as they do, until the next call or the end of the scene.
  std::span<const VitrailCpuDraw> draws(const View& view, std::uint32_t width, std::uint32_t height);

  // Whether any draw is transparent.
  bool hasTransparent() const;

  // What is drawn otherwise than the file says: lines as Scene::warnings has them.
  const std::vector<std::string>& warnings() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

// How many pixels the scene's points are across as the rasteriser draws them: it has a largest size.
float cpuPointSize(const Scene& scene);

// Fills `rows` rows, from `firstRow` on, of a picture's background: RGBA32F, linear, premultiplied; `rgba` is where the
// first of them begins, without gaps between them.
void drawBackground(const Background& background, const View& view, std::uint32_t width, std::uint32_t height,
                    std::uint32_t firstRow, std::uint32_t rows, float* rgba);

} // namespace vitrail::tool
