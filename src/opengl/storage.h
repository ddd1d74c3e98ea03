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
  bool own = false;
  bool wholeByBinding = false;

  // `hostBuffer` 0: a buffer of its own. Logs its errors.
  VitrailResult create(const VitrailGlContext_T& context, const StorageNeeds& wanted, GLuint hostBuffer,
                       std::uint64_t hostOffset, const char* name);
  void destroy(const VitrailGlContext_T& context);

  // Binds the first `count` parts (bindings.h) to the points from `base` on.
  void bind(const VitrailGlContext_T& context, GLuint base, std::uint32_t count) const;
};

// Makes a buffer object of so many bytes; leaves it bound to GL_COPY_WRITE_BUFFER. `storage`: flags of
// glBufferStorage(), where there is that, else `usage` holds. 0: there is no memory for it, as the log says.
GLuint createBuffer(const VitrailGlContext_T& context, std::uint64_t bytes, GLbitfield storage, GLenum usage,
                    const char* name, const char* what);

} // namespace vitrail
