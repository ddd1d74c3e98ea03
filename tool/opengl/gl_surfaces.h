// The surfaces of a scene as programs draw them, and the view that they are seen with. What Surfaces are with Vulkan.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "../stage/surface_list.h"
#include "gl_scene.h"
#include "program.h"

namespace vitrail::tool {

class GlSurfaces;

// Programs that surfaces are drawn with, one for each set of features (surface_shared.h) that some draws have.
class GlSurfacePrograms {
 public:
  // The fragment shader of draws with some features; its constants have those of surface.glsl already.
  using Describe = std::function<ShaderText(std::uint32_t features)>;

  // Makes them all. `objects`: the vertex shader says which instance it is (SURFACE_OBJECT). Throws GpuError.
  GlSurfacePrograms(const GlSurfaces& surfaces, std::span<const GpuDraw> draws, const std::string& name,
                    const Describe& fragment, bool objects = false);

  GLuint get(std::uint32_t features) const { return programs_.at(features).get(); }
  bool hasObjects() const { return objects_; }

 private:
  bool objects_;
  std::map<std::uint32_t, GlObject> programs_;
};

class GlSurfaces {
 public:
  // As GlScene. Throws GpuError.
  GlSurfaces(Gl& gl, const Scene& scene, std::optional<float> opacity, DrawOrder order, Scene* released = nullptr);

  Gl& gl() const { return gl_; }
  const GlScene& scene() const { return scene_; }
  const SurfaceList& list() const { return list_; }
  const std::vector<SurfaceRun>& transparentRuns() const { return list_.transparentRuns(); }
  float pointSize() const { return pointSize_; } // in pixels

  // As SurfaceList.
  void setView(const shaders::FrameData& view);
  const shaders::FrameData& view() const { return list_.view(); }
  void bindView() const;

  // Draws runs of `draws` in their order. Told before each run, where that is given.
  using BeforeRun = std::function<void(const SurfaceRun& run)>;
  void draw(std::span<const GpuDraw> draws, std::span<const SurfaceRun> runs, const GlSurfacePrograms& programs,
            const BeforeRun& before = {}) const;

 private:
  Gl& gl_;
  GlScene scene_;
  SurfaceList list_;
  float pointSize_;
  GlBuffer view_; // shaders::FrameData
};

} // namespace vitrail::tool
