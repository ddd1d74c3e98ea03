#include "storage.h"

#include <algorithm>

#include "state.h"
#include "vitrail/bindings.h"

namespace vitrail {

namespace {

// NVIDIA's driver gives a buffer large pages where it is a whole number of them, and small ones otherwise, which cost
// the atomics of collecting a tenth (docs/notes/opengl.md).
std::uint64_t wholePages(std::uint64_t bytes, std::uint64_t most) {
  constexpr std::uint64_t kPage = std::uint64_t{2} << 20U;
  const std::uint64_t whole = (bytes + kPage - 1) / kPage * kPage;
  return bytes >= kPage && whole <= most ? whole : bytes;
}

} // namespace

VitrailResult createBuffer(const VitrailGlContext_T& context, const BufferDesc& desc, GLuint* buffer) {
  const GlFunctions& gl = context.gl;
  *buffer = 0;
  // What the host left there would be taken for this buffer's.
  const ErrorFlags left = takeErrors(gl);
  if (left.lost) return contextIsLost(context);
  if (left.any) {
    context.log.warn("an error flag of OpenGL was set before this call, and is cleared: glGetError() says it no more");
  }
  GLuint made = 0;
  gl.GenBuffers(1, &made);
  gl.BindBuffer(GL_COPY_WRITE_BUFFER, made);
  const auto size = static_cast<GLsizeiptr>(desc.bytes);
  if (gl.BufferStorage != nullptr) {
    gl.BufferStorage(GL_COPY_WRITE_BUFFER, size, desc.data, desc.storage);
  } else {
    gl.BufferData(GL_COPY_WRITE_BUFFER, size, desc.data, desc.usage);
  }
  const GLenum error = gl.GetError();
  if (made != 0 && error == GL_NO_ERROR) {
    context.label(GL_BUFFER, made, desc.name, desc.what);
    *buffer = made;
    return VITRAIL_SUCCESS;
  }
  gl.DeleteBuffers(1, &made);
  if (error == GL_CONTEXT_LOST) return contextIsLost(context);
  return context.log.fail(VITRAIL_ERROR_OUT_OF_MEMORY,
                          "no memory for %s: %llu bytes, OpenGL says 0x%x: use a smaller nodeCapacity or memoryBudget",
                          desc.what, static_cast<unsigned long long>(desc.bytes), error);
}

VitrailResult GlStorage::create(const VitrailGlContext_T& context, const StorageNeeds& wanted, GLuint hostBuffer,
                                std::uint64_t hostOffset, std::uint64_t mostBytes, const char* name) {
  needs = wanted;
  layout = layoutStorage(needs);
  bytes = layout.total;
  if (hostBuffer != 0) {
    buffer = hostBuffer;
    offset = hostOffset;
  } else {
    const SavedCopies saved(context.gl);
    bytes = wholePages(layout.total, mostBytes);
    const BufferDesc desc{bytes, nullptr, 0, GL_DYNAMIC_COPY, name, "fragment lists"}; // the device's alone
    const VitrailResult result = createBuffer(context, desc, &buffer);
    if (result != VITRAIL_SUCCESS) return result;
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
