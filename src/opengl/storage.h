// A target's memory: one buffer object, its own or the host's.
#pragma once

#include "context.h"
#include "core/pool.h"

namespace vitrail {

struct GlStorage {
  StorageNeeds needs;
  StorageLayout layout;
  GLuint buffer = 0;
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0; // of the layout, and of what fills the last page
  bool own = false;
  bool wholeByBinding = false;

  // `hostBuffer` 0: a buffer of its own, of `mostBytes` at most where the layout is no larger. Logs its errors.
  VitrailResult create(const VitrailGlContext_T& context, const StorageNeeds& wanted, GLuint hostBuffer,
                       std::uint64_t hostOffset, std::uint64_t mostBytes, const char* name);
  void destroy(const VitrailGlContext_T& context);

  // Binds the first `count` parts (bindings.h) to the points from `base` on.
  void bind(const VitrailGlContext_T& context, GLuint base, std::uint32_t count) const;
};

struct BufferDesc {
  std::uint64_t bytes;
  const void* data;   // null: anything
  GLbitfield storage; // flags of glBufferStorage(), where there is that,
  GLenum usage;       // else this holds
  const char* name;
  const char* what;
};

// Makes a buffer object; leaves it bound to GL_COPY_WRITE_BUFFER. Logs its errors; then *buffer is 0.
VitrailResult createBuffer(const VitrailGlContext_T& context, const BufferDesc& desc, GLuint* buffer);

} // namespace vitrail
