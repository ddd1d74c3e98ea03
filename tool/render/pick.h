// What is under a pixel: all surfaces of it, front to back, from the sorted lists of the library's rasteriser for CPUs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include <vitrail/cpu.h>

#include "../scene/camera.h"
#include "../scene/scene.h"

namespace vitrail::tool {

struct PickedLayer {
  std::uint32_t draw = 0; // of the scene
  std::uint32_t object = ObjectTree::none;
  std::uint32_t material = 0;
  double distance = 0.0;  // from the camera's plane, in the scene's units
  glm::dvec3 point{0.0};  // of the surface at the pixel's middle, in the scene
  glm::vec3 color{0.0F};  // linear, not multiplied by alpha, but of premultiplied layers
  float alpha = 1.0F;     // of opaque surfaces 1
  std::string blend;      // "over", "premultiplied", "additive", "multiply", "opaque"
  glm::vec3 filter{1.0F}; // what passes through is multiplied by it
};

// Of a draw of a scene.
struct DrawFacts {
  std::uint32_t object = ObjectTree::none;
  std::uint32_t material = 0;
};
std::vector<DrawFacts> drawFactsOf(const Scene& scene);

struct PickedPixel {
  const View& view;
  std::uint32_t width;
  std::uint32_t height;
  std::uint32_t x;
  std::uint32_t y;
};

// What a sorted list of a pixel says, whose layers' words are draws, with reversed depths: to the nearest opaque one.
std::vector<PickedLayer> pickedOf(std::span<const VitrailLayer> layers, const std::vector<bool>& isOpaque,
                                  const std::vector<DrawFacts>& facts, const PickedPixel& pixel);

// Holds a scene. Not for several threads at once.
class Picker {
 public:
  // As CpuStillRenderer has it; the scene need not outlive it. Throws GpuError.
  Picker(const Scene& scene, std::optional<float> opacity);
  ~Picker();
  Picker(const Picker&) = delete;
  Picker& operator=(const Picker&) = delete;

  // The layers of the pixel's middle, nearest first, to the nearest opaque one. x and y are below width and height.
  std::vector<PickedLayer> at(const View& view, std::uint32_t width, std::uint32_t height, std::uint32_t x,
                              std::uint32_t y);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vitrail::tool
