#include "objects.h"

#include <algorithm>
#include <utility>

namespace vitrail::tool {

GlObject::GlObject(GlObject&& other) noexcept : kind_(other.kind_), name_(std::exchange(other.name_, 0)) {}

GlObject& GlObject::operator=(GlObject&& other) noexcept {
  std::swap(kind_, other.kind_);
  std::swap(name_, other.name_);
  return *this;
}

GlObject::~GlObject() {
  if (name_ == 0) return;
  switch (kind_) {
    case GlKind::Buffer:
      glDeleteBuffers(1, &name_);
      break;
    case GlKind::Texture:
      glDeleteTextures(1, &name_);
      break;
    case GlKind::Sampler:
      glDeleteSamplers(1, &name_);
      break;
    case GlKind::Framebuffer:
      glDeleteFramebuffers(1, &name_);
      break;
    case GlKind::VertexArray:
      glDeleteVertexArrays(1, &name_);
      break;
    case GlKind::Program:
      glDeleteProgram(name_);
      break;
  }
}

GlMemory::GlMemory(GlMemory&& other) noexcept
    : gl_(std::exchange(other.gl_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}

GlMemory& GlMemory::operator=(GlMemory&& other) noexcept {
  std::swap(gl_, other.gl_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

GlMemory::~GlMemory() {
  if (gl_ != nullptr) gl_->memoryFreed(bytes_);
}

GlBuffer::GlBuffer(Gl& gl, std::uint64_t size, const char* what) {
  const std::uint64_t bytes = std::max<std::uint64_t>(size, 1);
  GLuint name = 0;
  glCreateBuffers(1, &name);
  object_ = {GlKind::Buffer, name};
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
  gl.check(what);
  memory_ = {gl, bytes};
}

GlTexture::GlTexture(Gl& gl, const GlTextureInfo& info, const char* what) {
  const auto width = static_cast<GLsizei>(info.width);
  const auto height = static_cast<GLsizei>(info.height);
  GLuint name = 0;
  if (info.samples > 1) {
    glCreateTextures(GL_TEXTURE_2D_MULTISAMPLE, 1, &name);
    object_ = {GlKind::Texture, name};
    glTextureStorage2DMultisample(name, static_cast<GLsizei>(info.samples), info.format, width, height, GL_TRUE);
  } else {
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    object_ = {GlKind::Texture, name};
    glTextureStorage2D(name, static_cast<GLsizei>(info.levels), info.format, width, height);
    if (info.levels == 1) { // complete without mipmaps, for those that are fetched
      glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
      glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
  }
  gl.check(what);
  const std::uint64_t base = std::uint64_t{info.width} * info.height * info.pixelBytes * info.samples;
  memory_ = {gl, info.levels > 1 ? base + base / 3 : base};
}

GlObject makeFramebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return {GlKind::Framebuffer, name};
}

} // namespace vitrail::tool
