// The surfaces of a scene as pipelines draw them, and the view that they are seen with: descriptor sets 0 and 1 of
// surface.vert and surface.glsl.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "../gpu/descriptors.h"
#include "../gpu/pipeline.h"
#include "gpu_scene.h"
#include "surface_list.h"

namespace vitrail::tool {

class Surfaces;

// The fragment shader of surfaces, and what it writes. Sets 0 and 1 are those of surface.glsl, and constant 0
// is the features; the rest is the method's.
struct SurfaceProgram {
  VkDescriptorSetLayout set = VK_NULL_HANDLE; // set 2; null: there is none
  std::uint32_t constantBytes = 0;            // push constants of the fragment shader
  std::string name;
};

// Pipelines that surfaces are drawn with, one for each set of features (surface_shared.h) that some draws have.
class SurfacePipelines {
 public:
  // Fills in what draws with some features are drawn with: of `info`, which has the vertex shader and passes fragments
  // that are not behind the opaque scene, all but layout and constant 0 may be changed.
  using Describe = std::function<void(std::uint32_t features, GraphicsPipelineInfo& info)>;

  // Makes them all. Throws GpuError.
  SurfacePipelines(const Surfaces& surfaces, std::span<const GpuDraw> draws, const SurfaceProgram& program,
                   const Describe& describe);

  VkPipelineLayout layout() const { return layout_.get(); }
  VkPipeline get(std::uint32_t features) const { return pipelines_.at(features).get(); }

 private:
  Unique<VkPipelineLayout> layout_;
  std::map<std::uint32_t, Unique<VkPipeline>> pipelines_;
};

// What a device makes of the wanted size of points, in pixels: it has bounds of its own.
float drawnPointSize(const Gpu& gpu, float wanted);

class Surfaces {
 public:
  // As GpuScene. `framesInFlight`: how many frames, each with a view of its own, may be pending. Throws GpuError.
  Surfaces(Gpu& gpu, const Scene& scene, std::optional<float> opacity, DrawOrder order, Scene* released = nullptr,
           std::uint32_t framesInFlight = 1);

  Gpu& gpu() const { return gpu_; }
  const GpuScene& scene() const { return scene_; }
  float pointSize() const { return pointSize_; } // in pixels
  const SurfaceList& list() const { return list_; }
  const std::vector<SurfaceRun>& transparentRuns() const { return list_.transparentRuns(); }

  std::uint32_t framesInFlight() const { return static_cast<std::uint32_t>(views_.size()); }

  // As SurfaceList, for the frames to come. No frame that was recorded `framesInFlight` views ago is pending.
  void setView(const shaders::FrameData& view);
  const shaders::FrameData& view() const { return list_.view(); }

  void setClipPlanes(const Scene& scene) { list_.setClipPlanes(scene); } // as SurfaceList

  VkDescriptorSetLayout frameLayout() const { return views_[0].set.layout(); } // set 0
  VkDescriptorSet viewSet() const { return views_[view_].set.set(); } // with one dynamic offset: 0 is of no draw
  // Binds set 0 for shaders that read the view and the lights alone.
  void cmdBindView(VkCommandBuffer commands, VkPipelineLayout layout,
                   VkPipelineBindPoint point = VK_PIPELINE_BIND_POINT_GRAPHICS) const;

  // Draws runs of `draws` in their order in the present rendering scope. `set` is set 2 of the pipelines, null where
  // they have none. `indices` null: the scene's own.
  void cmdDraw(VkCommandBuffer commands, std::span<const GpuDraw> draws, std::span<const SurfaceRun> runs,
               const SurfacePipelines& pipelines, VkDescriptorSet set = VK_NULL_HANDLE,
               VkBuffer indices = VK_NULL_HANDLE) const;

 private:
  void cmdBind(VkCommandBuffer commands, VkPipelineLayout layout, const GpuDraw& draw, const GpuDraw* before) const;

  Gpu& gpu_;
  GpuScene scene_;
  float pointSize_;
  SurfaceList list_;
  struct ViewSlot {
    GpuBuffer buffer; // shaders::FrameData
    SingleSet set;    // set 0
  };
  std::vector<ViewSlot> views_;
  std::size_t view_ = 0; // of the frames to come
};

} // namespace vitrail::tool
