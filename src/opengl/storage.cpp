#include "storage.h"

#include <algorithm>

#include "state.h"
#include "vitrail/bindings.h"

namespace vitrail {

GLuint createBuffer(const VitrailGlContext_T& context, std::uint64_t bytes, GLbitfield storage, GLenum usage,
                    const char* name, const char* what) {
  const GlFunctions& gl = context.gl;
  // What the host left there would be taken for this buffer's.
  bool left = false;
  for (int i = 0; i < 16 && gl.GetError() != GL_NO_ERROR; ++i) left = true; // a lost context may go on for ever
  if (left)
    context.log.warn("an error flag of OpenGL was set before this call, and is cleared: glGetError() says it no more");
  GLuint buffer = 0;
  gl.GenBuffers(1, &buffer);
  gl.BindBuffer(GL_COPY_WRITE_BUFFER, buffer);
  const auto size = static_cast<GLsizeiptr>(bytes);
  if (gl.BufferStorage != nullptr) {
    gl.BufferStorage(GL_COPY_WRITE_BUFFER, size, nullptr, storage);
  } else {
    gl.BufferData(GL_COPY_WRITE_BUFFER, size, nullptr, usage);
  }
  const GLenum error = gl.GetError();
  if (buffer != 0 && error == GL_NO_ERROR) {
    context.label(GL_BUFFER, buffer, name, what);
    return buffer;
  }
  gl.DeleteBuffers(1, &buffer);
  context.log.error("no memory for %s: %llu bytes, OpenGL says 0x%x: use a smaller nodeCapacity or memoryBudget", what,
                    static_cast<unsigned long long>(bytes), error);
  return 0;
}

VitrailResult GlStorage::create(const VitrailGlContext_T& context, const StorageNeeds& wanted, GLuint hostBuffer,
                                std::uint64_t hostOffset, const char* name) {
  needs = wanted;
  layout = layoutStorage(needs);
  if (hostBuffer != 0) {
    buffer = hostBuffer;
    offset = hostOffset;
  } else {
    const SavedCopies saved(context.gl);
    buffer = createBuffer(context, layout.total, GL_DYNAMIC_STORAGE_BIT, GL_DYNAMIC_COPY, name, "fragment lists");
    if (buffer == 0) return VITRAIL_ERROR_OUT_OF_MEMORY;
    own = true;
  }
  wholeByBinding = layout.nodes.size <= context.limits.storageBufferRange;
  return VITRAIL_SUCCESS;
}

void GlStorage::destroy(const VitrailGlContext_T& context) {
  if (own) context.gl.DeleteBuffers(1, &buffer); // frames in flight keep it as long as they need it
  *this = {};
}

void GlStorage::bind(const VitrailGlContext_T& context, GLuint base, std::uint32_t count) const {
  const std::array<const StoragePart*, VITRAIL_BINDINGS> parts = {
      &layout.parameters, &layout.control,     &layout.heads,     &layout.nodes,
      &layout.sums,       &layout.mediumLists, &layout.longLists, &layout.copy};
  static_assert(VITRAIL_BINDING_PARAMETERS == 0 && VITRAIL_BINDING_CONTROL == 1 && VITRAIL_BINDING_HEADS == 2 &&
                VITRAIL_BINDING_NODES == 3 && VITRAIL_BINDING_SUMS == 4 && VITRAIL_BINDING_MEDIUM_LISTS == 5 &&
                VITRAIL_BINDING_LONG_LISTS == 6 && VITRAIL_BINDING_COPY == 7);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t size = std::min(parts[i]->size, context.limits.storageBufferRange);
    context.gl.BindBufferRange(i == VITRAIL_BINDING_PARAMETERS ? GL_UNIFORM_BUFFER : GL_SHADER_STORAGE_BUFFER, base + i,
                               buffer, static_cast<GLintptr>(offset + parts[i]->offset), static_cast<GLsizeiptr>(size));
  }
}

} // namespace vitrail
