#include "gl_surfaces.h"

#include <algorithm>

#include <fmt/format.h>

#include "bindings.h"
#include "files/gl_surface.vert.h"
#include "files/gl_surface_clipped.vert.h"
#include "files/gl_surface_object.vert.h"

namespace vitrail::tool {

namespace {

GLenum glTopologyOf(std::uint32_t features) {
  if ((features & shaders::FEATURE_SOLID) == shaders::FEATURE_LINES) return GL_LINES;
  if ((features & shaders::FEATURE_SOLID) == shaders::FEATURE_POINTS) return GL_POINTS;
  return GL_TRIANGLES;
}

std::span<const unsigned char> vertexText(const GlSurfaces& surfaces, bool objects) {
  if (objects) return files::gl_surface_object_vert; // of scenes that no plane cuts
  if (surfaces.list().isClipped()) return files::gl_surface_clipped_vert;
  return files::gl_surface_vert;
}

} // namespace

GlSurfacePrograms::GlSurfacePrograms(const GlSurfaces& surfaces, std::span<const GpuDraw> draws,
                                     const std::string& name, const Describe& fragment, bool objects)
    : objects_(objects) {
  for (const GpuDraw& draw : draws) {
    if (programs_.contains(draw.features)) continue;
    const std::string features = constantLine("uint kFeatures", draw.features);
    const ShaderText vertex{vertexText(surfaces, objects), "",
                            features + constantLine("float kPointSize", surfaces.pointSize())};
    ShaderText text = fragment(draw.features);
    text.constants += features;
    programs_.emplace(draw.features,
                      makeDrawProgram(vertex, text, fmt::format("{} (features {:#x})", name, draw.features)));
  }
}

GlSurfaces::GlSurfaces(Gl& gl, const Scene& scene, std::optional<float> opacity, DrawOrder order, Scene* released)
    : gl_(gl),
      scene_(gl, scene, opacity, order, released),
      list_(scene_, scene, scene_.lightCount()),
      pointSize_(std::clamp(scene.pointSize, gl.limits().pointSizes[0], gl.limits().pointSizes[1])),
      view_(gl, sizeof(shaders::FrameData), "frame data") {}

void GlSurfaces::setView(const shaders::FrameData& view) {
  list_.setView(view);
  glNamedBufferSubData(view_.get(), 0, sizeof(view), &list_.view());
}

void GlSurfaces::bindView() const { glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBlock, view_.get()); }

void GlSurfaces::draw(std::span<const GpuDraw> draws, std::span<const SurfaceRun> runs,
                      const GlSurfacePrograms& programs, const BeforeRun& before) const {
  if (runs.empty()) return;
  bindView();
  scene_.bind();
  for (GLuint i = 0; i < shaders::CLIP_PLANE_COUNT; ++i) {
    list_.isClipped() ? glEnable(GL_CLIP_DISTANCE0 + i) : glDisable(GL_CLIP_DISTANCE0 + i);
  }
  GLuint program = 0;
  const GpuDraw* bound = nullptr;
  for (const SurfaceRun& run : runs) {
    const GpuDraw& draw = draws[run.draw];
    if (const GLuint wanted = programs.get(draw.features); wanted != program) {
      program = wanted;
      glUseProgram(program);
    }
    if (&draw != bound) {
      scene_.bind(draw, bound);
      bound = &draw;
    }
    if (programs.hasObjects()) glUniform1ui(0, run.firstInstance);
    if (before) before(run);
    glDrawElementsInstancedBaseInstance(glTopologyOf(draw.features), static_cast<GLsizei>(run.indexCount),
                                        GL_UNSIGNED_INT,
                                        reinterpret_cast<const void*>(std::uintptr_t{run.firstIndex} * 4),
                                        static_cast<GLsizei>(run.instanceCount), run.firstInstance);
  }
  for (GLuint i = 0; i < shaders::CLIP_PLANE_COUNT; ++i) glDisable(GL_CLIP_DISTANCE0 + i);
}

} // namespace vitrail::tool
