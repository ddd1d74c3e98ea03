// OpenGL objects with an owner. They are made and destroyed with the context of their Gl current.
#pragma once

#include <cstdint>
#include <string>

#include "gl.h"

namespace vitrail::tool {

enum class GlKind { Buffer, Texture, Sampler, Framebuffer, VertexArray, Program };

// One name of OpenGL's; deletes it.
class GlObject {
 public:
  GlObject() = default;
  GlObject(GlKind kind, GLuint name) : kind_(kind), name_(name) {}
  GlObject(GlObject&& other) noexcept;
  GlObject& operator=(GlObject&& other) noexcept;
  ~GlObject();

  GLuint get() const { return name_; } // 0: none

 private:
  GlKind kind_ = GlKind::Buffer;
  GLuint name_ = 0;
};

// Bytes on the device, counted by the Gl.
class GlMemory {
 public:
  GlMemory() = default;
  GlMemory(Gl& gl, std::uint64_t bytes) : gl_(&gl), bytes_(bytes) { gl.memoryAllocated(bytes); }
  GlMemory(GlMemory&& other) noexcept;
  GlMemory& operator=(GlMemory&& other) noexcept;
  ~GlMemory();

  std::uint64_t bytes() const { return bytes_; }

 private:
  Gl* gl_ = nullptr;
  std::uint64_t bytes_ = 0;
};

class GlBuffer {
 public:
  GlBuffer() = default;
  // Of so many bytes, one at least, which glNamedBufferSubData() may change. Throws GpuError. `what` it is for.
  GlBuffer(Gl& gl, std::uint64_t size, const char* what);

  GLuint get() const { return object_.get(); }
  std::uint64_t size() const { return memory_.bytes(); }

 private:
  GlObject object_;
  GlMemory memory_;
};

struct GlTextureInfo {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  GLenum format = GL_NONE;
  std::uint32_t pixelBytes = 0; // of a sample
  std::uint32_t samples = 1;    // several: GL_TEXTURE_2D_MULTISAMPLE
  std::uint32_t levels = 1;
};

class GlTexture {
 public:
  GlTexture() = default;
  // Immutable storage. Throws GpuError.
  GlTexture(Gl& gl, const GlTextureInfo& info, const char* what);

  GLuint get() const { return object_.get(); }

 private:
  GlObject object_;
  GlMemory memory_;
};

GlObject makeFramebuffer();

} // namespace vitrail::tool
