#include "gl_stage.h"

#include <fmt/format.h>

#include "../gpu/features.h"
#include "../scene/srgb.h"
#include "../stage/frame_data.h"
#include "files/gl_opaque.frag.h"
#include "files/gl_screen.vert.h"
#include "files/gl_sky.frag.h"

namespace vitrail::tool {

namespace {

std::array<float, 4> clearColorOf(const Background& background) {
  if (background.kind != Background::Kind::Color) return {};
  const glm::vec3 linear = linearFromSrgb(background.srgb);
  return {linear.r, linear.g, linear.b, 1.0F};
}

GlObject makeVertexArray() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return {GlKind::VertexArray, name};
}

void requireSamples(const Gl& gl, std::uint32_t samples) {
  const std::uint32_t offered = gl.limits().sampleCounts;
  if ((offered & samples) != 0) return;
  throw GpuError(fmt::format("{} draws {} samples a pixel, not {}: choose one of these with --samples", gl.name(),
                             sampleCountsText(offered), samples));
}

} // namespace

GlStage::GlStage(Gl& gl, const Scene& scene, std::optional<float> opacity, DrawOrder order, std::uint32_t samples,
                 Scene* released)
    : gl_(gl), surfaces_(gl, scene, opacity, order, released), noVertices_(makeVertexArray()) {
  requireSamples(gl, samples);
  info_.samples = samples;
  // What all passes have: depths as Vulkan has them, 1 at the near plane.
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_PROGRAM_POINT_SIZE);
}

void GlStage::setNeeds(const GlImageNeeds& needs) {
  static_cast<GlImageNeeds&>(info_) = needs;
  opaque_.emplace(surfaces_, surfaces_.scene().opaqueDraws(), "opaque",
                  [](std::uint32_t /*features*/) { return ShaderText{files::gl_opaque_frag}; });
  sky_ = makeDrawProgram({files::gl_screen_vert}, {files::gl_sky_frag}, "sky");
}

bool GlStage::hasSize(std::uint32_t width, std::uint32_t height) const {
  return width == images_.info().width && height == images_.info().height;
}

void GlStage::setSize(std::uint32_t width, std::uint32_t height) {
  images_ = GlImages(); // first: the old size and the new one need not fit together
  info_.width = width;
  info_.height = height;
  images_ = GlImages(gl_, info_);
}

void GlStage::setView(const View& view) {
  surfaces_.setView(makeFrameData(view, info_.width, info_.height, surfaces_.scene().origin()));
}

// Clears the opaque scope's images and draws the background.
void GlStage::begin(const Background& background) {
  images_.bindDrawn();
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_CULL_FACE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glStencilMask(0xff);
  clearColor(clearColorOf(background));
  if (info_.stencil) {
    glClearBufferfi(GL_DEPTH_STENCIL, 0, 0.0F, 0);
  } else {
    const float farPlane = 0.0F;
    glClearBufferfv(GL_DEPTH, 0, &farPlane);
  }
  if (background.kind != Background::Kind::Sky) return;
  glDisable(GL_DEPTH_TEST);
  surfaces_.bindView();
  glBindVertexArray(noVertices_.get());
  glUseProgram(sky_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void GlStage::drawBackground(GlFrame& frame, const Background& background) {
  begin(background);
  if (info_.samples > 1) images_.boxFilter();
  frame.endPass("background");
}

void GlStage::drawOpaque(GlFrame& frame, const Background& background) {
  begin(background);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GEQUAL); // of surfaces in one plane the one that is drawn last is seen
  const std::vector<GpuDraw>& draws = surfaces_.scene().opaqueDraws();
  surfaces_.draw(draws, runsOf(draws), *opaque_);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE); // nothing else writes the opaque depth
  frame.endPass("opaque");
}

void GlStage::finishPicture(GlFrame& frame) {
  if (!info_.perSample || info_.samples == 1) return;
  images_.boxFilter();
  frame.endPass("box_filter");
}

} // namespace vitrail::tool
