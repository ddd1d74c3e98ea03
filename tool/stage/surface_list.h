// The transparent surfaces of a scene in the order of submission, and the view that they are seen with. No graphics
// API.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene_draws.h"
#include "surface_shared.h"

namespace vitrail::tool {

// A part of a draw: indices and instances of it that are drawn together.
struct SurfaceRun {
  std::uint32_t draw = 0; // index into SceneDraws' opaque or transparent draws
  std::uint32_t firstIndex = 0;
  std::uint32_t indexCount = 0;
  std::uint32_t firstInstance = 0; // among all instances, as GpuDraw's
  std::uint32_t instanceCount = 1;
};

// What draws all of a list of draws, in its order.
std::vector<SurfaceRun> runsOf(std::span<const GpuDraw> draws);

class SurfaceList {
 public:
  // `draws` are those of `scene` and outlive the list; `lights` is how many lights it has of its own.
  SurfaceList(const SceneDraws& draws, const Scene& scene, std::size_t lights);

  const SceneDraws& scene() const { return draws_; }
  const std::vector<SurfaceRun>& transparentRuns() const { return transparentRuns_; }
  // Whether planes cut some of the scene away.
  bool isClipped() const { return isClipped_; }

  // Other planes for the views to come, of the same scene, where some cut it already.
  void setClipPlanes(const Scene& scene);

  // Its clip planes and lights are the scene's, whatever `view` says.
  void setView(const shaders::FrameData& view);
  const shaders::FrameData& view() const { return view_; }

 private:
  const SceneDraws& draws_;
  std::vector<SurfaceRun> transparentRuns_;
  bool isClipped_;
  shaders::FrameData view_{};
};

} // namespace vitrail::tool
