#include "gl_images.h"

#include <fmt/format.h>

namespace vitrail::tool {

namespace {

void checkExtent(const Gl& gl, const GlImagesInfo& info) {
  const std::uint32_t side = gl.limits().textureSide;
  if (info.width < 1 || info.height < 1) throw GpuError("a picture has at least 1x1 pixels");
  if (info.width > side || info.height > side) {
    throw GpuError(fmt::format("a picture of {}x{} pixels is too large: {} renders at most {}x{}", info.width,
                               info.height, gl.name(), side, side));
  }
}

void requireComplete(GLuint framebuffer, const Gl& gl) {
  if (glCheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return;
  throw GpuError(fmt::format("{} cannot draw into images of 16-bit floats with a depth of 32 bits", gl.name()));
}

} // namespace

GlImages::GlImages(Gl& gl, const GlImagesInfo& info) : info_(info) {
  checkExtent(gl, info);
  GlTextureInfo image;
  image.width = info.width;
  image.height = info.height;
  image.format = GL_RGBA16F;
  image.pixelBytes = 8;
  color_ = GlTexture(gl, image, "the picture");
  image.samples = info.samples;
  if (info.samples > 1) multisampled_ = GlTexture(gl, image, "the picture's samples");
  image.format = info.stencil ? GL_DEPTH32F_STENCIL8 : GL_DEPTH_COMPONENT32F;
  image.pixelBytes = info.stencil ? 8 : 4;
  depth_ = GlTexture(gl, image, "the picture's depth");

  const GLenum depthPoint = info.stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT;
  drawnFramebuffer_ = makeFramebuffer();
  glNamedFramebufferTexture(drawnFramebuffer_.get(), GL_COLOR_ATTACHMENT0,
                            info.samples > 1 ? multisampled_.get() : color_.get(), 0);
  glNamedFramebufferTexture(drawnFramebuffer_.get(), depthPoint, depth_.get(), 0);
  requireComplete(drawnFramebuffer_.get(), gl);
  depthFramebuffer_ = makeFramebuffer();
  glNamedFramebufferTexture(depthFramebuffer_.get(), depthPoint, depth_.get(), 0);
  glNamedFramebufferDrawBuffer(depthFramebuffer_.get(), GL_NONE);
  requireComplete(depthFramebuffer_.get(), gl);
  colorFramebuffer_ = makeFramebuffer();
  glNamedFramebufferTexture(colorFramebuffer_.get(), GL_COLOR_ATTACHMENT0, color_.get(), 0);
  requireComplete(colorFramebuffer_.get(), gl);
}

void GlImages::bind(const GlObject& framebuffer) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
  glViewport(0, 0, static_cast<GLsizei>(info_.width), static_cast<GLsizei>(info_.height));
}

void GlImages::bindDrawn() const { bind(drawnFramebuffer_); }
void GlImages::bindDepthAlone() const { bind(depthFramebuffer_); }
void GlImages::bindColor() const { bind(colorFramebuffer_); }

void GlImages::boxFilter() const {
  const auto width = static_cast<GLint>(info_.width);
  const auto height = static_cast<GLint>(info_.height);
  glBlitNamedFramebuffer(drawnFramebuffer_.get(), colorFramebuffer_.get(), 0, 0, width, height, 0, 0, width, height,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void clearColor(const std::array<float, 4>& color) { glClearBufferfv(GL_COLOR, 0, color.data()); }

} // namespace vitrail::tool
