// Runs the passes of a frame plan.
#include <algorithm>
#include <cstddef>
#include <cstring>

#include "core/parameters.h"
#include "state.h"
#include "target.h"

namespace vitrail {

namespace {

// ---- Barriers

// OpenGL keeps its commands in order, but for what shaders write: a barrier says how that is read, or written over,
// next.
GLbitfield bitsOf(const Barriers& barriers) {
  GLbitfield bits = 0;
  for (std::uint32_t r = 0; r < kResources; ++r) {
    const Barrier& barrier = barriers[r];
    if ((barrier.before.stages & (kStageFragment | kStageCompute)) == 0) continue;
    const std::uint32_t after = barrier.after.accesses;
    const bool picture = static_cast<Resource>(r) == Resource::Picture;
    if ((after & (kAccessShaderRead | kAccessShaderWrite)) != 0) {
      bits |= picture ? GL_SHADER_IMAGE_ACCESS_BARRIER_BIT : GL_SHADER_STORAGE_BARRIER_BIT;
    }
    if ((after & kAccessIndirectRead) != 0) bits |= GL_COMMAND_BARRIER_BIT;
    if ((after & (kAccessTransferRead | kAccessTransferWrite)) != 0) bits |= GL_BUFFER_UPDATE_BARRIER_BIT;
  }
  return bits;
}

void barrier(const GlFunctions& gl, GLbitfield bits) {
  if (bits != 0) gl.MemoryBarrier(bits);
}

// ---- Transfers

void fill(const VitrailGlTarget_T& target, const StoragePart& part, std::uint64_t bytes, GLuint value) {
  if (bytes == 0) return;
  target.context->gl.ClearBufferSubData(GL_COPY_WRITE_BUFFER, GL_R32UI,
                                        static_cast<GLintptr>(target.storage.offset + part.offset),
                                        static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
}

// Through a buffer of its own: where the host writes into a buffer, a driver may move all of it to the host's memory.
void write(const VitrailGlTarget_T& target, const StoragePart& part, const void* data, std::size_t bytes) {
  const GlFunctions& gl = target.context->gl;
  gl.BindBuffer(GL_COPY_READ_BUFFER, target.writtenBuffer);
  gl.BufferSubData(GL_COPY_READ_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
  gl.CopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0,
                       static_cast<GLintptr>(target.storage.offset + part.offset), static_cast<GLsizeiptr>(bytes));
}

// The heads are emptied by a kernel, which is the next pass.
void clear(VitrailGlTarget_T& target) {
  const GlFunctions& gl = target.context->gl;
  const GlStorage& storage = target.storage;
  const SavedCopies saved(gl);
  const SavedUnpacking unpacking(gl);
  gl.BindBuffer(GL_COPY_WRITE_BUFFER, storage.buffer);
  const layout::VitrailParameters parameters = parametersOf(
      target.info, storage.needs.nodeCapacity, {0, storage.wholeByBinding}, target.area, target.frames.newest());
  write(target, storage.layout.parameters, &parameters, sizeof(parameters));
  fill(target, storage.layout.control, storage.layout.control.size, 0);
  if (target.info.keepsSums() && target.sums.begin(target.slots)) {
    fill(target, storage.layout.sums, storage.layout.sums.size, 0);
  }
  target.slots[target.slotOf(target.frames.newest())].tag = 0; // the slot's old frame is gone
}

void copyStatistics(const VitrailGlTarget_T& target) {
  const GlFunctions& gl = target.context->gl;
  const GlStorage& storage = target.storage;
  const SavedCopies saved(gl);
  gl.BindBuffer(GL_COPY_READ_BUFFER, storage.buffer);
  gl.BindBuffer(GL_COPY_WRITE_BUFFER, target.statsBuffer);
  const std::size_t slot = target.slotOf(target.frames.newest()) * sizeof(StatsSlot);
  gl.CopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER,
                       static_cast<GLintptr>(storage.offset + storage.layout.control.offset),
                       static_cast<GLintptr>(slot), sizeof(layout::VitrailControl));
  gl.CopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER,
                       static_cast<GLintptr>(storage.offset + storage.layout.parameters.offset +
                                             offsetof(layout::VitrailParameters, frame)),
                       static_cast<GLintptr>(slot + offsetof(StatsSlot, begunFrame)), sizeof(StatsSlot::begunFrame));
}

void finishStatistics(VitrailGlTarget_T& target) {
  const GlFunctions& gl = target.context->gl;
  const std::uint64_t frame = target.frames.newest();
  const std::size_t slot = target.slotOf(frame);
  PendingStats& pending = target.pending[slot];
  if (pending.fence != nullptr) gl.DeleteSync(pending.fence);
  target.slots[slot].facts = {target.storage.needs.nodeCapacity, target.order.misused() ? 1U : 0U, target.sums.fact()};
  pending = {gl.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0), frame};
  if (pending.fence == nullptr) target.lost = true;
}

void beginCopy(const VitrailGlTarget_T& target, const VitrailRect& area) {
  const SavedCopies saved(target.context->gl);
  target.context->gl.BindBuffer(GL_COPY_WRITE_BUFFER, target.storage.buffer);
  layout::VitrailCopyHeader header{};
  header.capacity = target.info.copyLayers;
  header.x = area.x;
  header.y = area.y;
  header.width = area.width;
  header.height = area.height;
  write(target, target.storage.layout.copy, &header, sizeof(header));
}

void finishCopy(const VitrailGlTarget_T& target, const GlCallInfo& info) {
  const GlFunctions& gl = target.context->gl;
  const GlStorage& storage = target.storage;
  const SavedCopies saved(gl);
  gl.BindBuffer(GL_COPY_READ_BUFFER, storage.buffer);
  gl.BindBuffer(GL_COPY_WRITE_BUFFER, info.copyBuffer);
  const std::uint64_t pixels = std::uint64_t{info.copied.width} * info.copied.height;
  gl.CopyBufferSubData(
      GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(storage.offset + storage.layout.copy.offset),
      static_cast<GLintptr>(info.copyOffset), static_cast<GLsizeiptr>(copyBytes(pixels, target.info.copyLayers)));
}

// ---- Shaders

void bindImages(const VitrailGlTarget_T& target, std::uint32_t number) {
  if (number >= target.viewCount) return;
  const GlFunctions& gl = target.context->gl;
  const GlView& view = target.views[number];
  if (view.color != 0) {
    gl.BindImageTexture(VITRAIL_VIEW_BINDING_COLOR, view.color, 0, GL_FALSE, 0, GL_READ_WRITE, target.colorFormat);
  }
  const auto bind = [&](GLuint unit, GLuint texture) {
    gl.ActiveTexture(GL_TEXTURE0 + unit);
    gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, texture);
  };
  if (view.opaque != 0) bind(VITRAIL_VIEW_BINDING_OPAQUE, view.opaque);
  // Where nobody looks at a depth, shaders may name it all the same.
  if (view.depth != 0 || view.opaque != 0) bind(VITRAIL_VIEW_BINDING_DEPTH, view.depth != 0 ? view.depth : view.opaque);
}

std::uint32_t groupsFor(std::uint32_t pixels) { return (pixels + kGroupSide - 1) / kGroupSide; }

const void* argumentsOf(const GlStorage& storage, const Pass& pass) {
  const std::uint64_t offset = storage.offset + storage.layout.control.offset + pass.arguments;
  // OpenGL takes offsets as pointers. NOLINTNEXTLINE(performance-no-int-to-ptr)
  return reinterpret_cast<const void*>(static_cast<std::uintptr_t>(offset));
}

void dispatch(const VitrailGlTarget_T& target, const Pass& pass, const GlCallInfo& info) {
  const GlFunctions& gl = target.context->gl;
  const GlStorage& storage = target.storage;
  switch (pass.extent) {
    case Extent::None:
      break;
    case Extent::One:
      gl.DispatchCompute(1, 1, 1);
      break;
    case Extent::Nodes:
      gl.DispatchCompute(nodeGroups(storage.needs.nodeCapacity), 1, 1);
      break;
    case Extent::Heads:
      gl.DispatchCompute(nodeGroups(target.area.width * target.area.height), 1, 1);
      break;
    case Extent::Copied:
      gl.DispatchCompute(groupsFor(info.copied.width), groupsFor(info.copied.height), 1);
      break;
    case Extent::Indirect:
      gl.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, storage.buffer);
      gl.DispatchComputeIndirect(reinterpret_cast<GLintptr>(argumentsOf(storage, pass)));
      break;
  }
}

// C + T * d: one alpha for all channels, or a transmittance of their own. What is written whole is not blended.
void setBlending(const VitrailGlTarget_T& target) {
  const GlFunctions& gl = target.context->gl;
  if (target.info.perPixel()) {
    gl.Disablei(GL_BLEND, 0);
    return;
  }
  const bool dual = !target.severalDrawBuffers;
  gl.Enablei(GL_BLEND, 0);
  gl.BlendEquationSeparatei(0, GL_FUNC_ADD, GL_FUNC_ADD);
  gl.BlendFuncSeparatei(0, GL_ONE, dual ? GL_SRC1_COLOR : GL_ONE_MINUS_SRC_ALPHA, GL_ONE,
                        dual ? GL_SRC1_ALPHA : GL_ONE_MINUS_SRC_ALPHA);
}

void draw(const VitrailGlTarget_T& target, const Pass& pass) {
  const GlFunctions& gl = target.context->gl;
  const VitrailRect& area = target.area;
  const SavedDraw saved(gl);
  setBlending(target);
  if (target.info.stencilMark) {
    gl.Enable(GL_STENCIL_TEST);
    gl.StencilFuncSeparate(GL_FRONT_AND_BACK, GL_NOTEQUAL, 0, target.stencilMask);
    gl.StencilOpSeparate(GL_FRONT_AND_BACK, GL_KEEP, GL_KEEP, GL_KEEP);
  }
  gl.ViewportIndexedf(0, static_cast<GLfloat>(area.x), static_cast<GLfloat>(area.y), static_cast<GLfloat>(area.width),
                      static_cast<GLfloat>(area.height));
  gl.Enablei(GL_SCISSOR_TEST, 0);
  gl.ScissorIndexed(0, static_cast<GLint>(area.x), static_cast<GLint>(area.y), static_cast<GLsizei>(area.width),
                    static_cast<GLsizei>(area.height));
  gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, target.storage.buffer);
  gl.DrawArraysIndirect(GL_TRIANGLES, argumentsOf(target.storage, pass));
}

void runShaders(const VitrailGlTarget_T& target, const Pass& pass, GLuint program, const GlCallInfo& info) {
  target.context->gl.UseProgram(program);
  if (pass.action == Action::Dispatch) {
    dispatch(target, pass, info);
  } else {
    draw(target, pass);
  }
}

void runTransfer(VitrailGlTarget_T& target, const Pass& pass, const GlCallInfo& info) {
  switch (pass.action) {
    case Action::Clear:
      return clear(target);
    case Action::BeginCopy:
      return beginCopy(target, info.copied);
    case Action::FinishCopy:
      return finishCopy(target, info);
    case Action::CopyStatistics:
      return copyStatistics(target);
    case Action::FinishStatistics:
      return finishStatistics(target);
    default:
      break;
  }
}

// Runs of passes of one kind share what they save.
void runPasses(VitrailGlTarget_T& target, std::size_t first, std::size_t end, const GlCallInfo& info) {
  const GlFunctions& gl = target.context->gl;
  const Pass& pass = target.plan.passes()[first];
  const GLenum indirect = pass.action == Action::Dispatch ? GL_DISPATCH_INDIRECT_BUFFER : GL_DRAW_INDIRECT_BUFFER;
  const bool images = pass.call == Call::Resolve;
  const SavedShaders saved(gl, indirect, images);
  target.storage.bind(*target.context, 0, VITRAIL_BINDINGS);
  if (images) bindImages(target, info.view);
  for (std::size_t i = first; i < end; ++i) {
    barrier(gl, bitsOf(target.plan.passes()[i].before));
    runShaders(target, target.plan.passes()[i], target.programs[i], info);
  }
}

} // namespace

bool runsShaders(const Pass& pass) {
  return pass.action == Action::Dispatch || pass.action == Action::Draw || pass.action == Action::DrawPlain;
}

void runCall(VitrailGlTarget_T& target, Call call, const GlCallInfo& info) {
  const std::vector<Pass>& passes = target.plan.passes();
  for (std::size_t i = 0; i < passes.size();) {
    if (passes[i].call != call) {
      ++i;
      continue;
    }
    if (!runsShaders(passes[i])) {
      barrier(target.context->gl, bitsOf(passes[i].before));
      runTransfer(target, passes[i], info);
      ++i;
      continue;
    }
    std::size_t end = i + 1;
    while (end < passes.size() && passes[end].call == call && runsShaders(passes[end])) ++end;
    runPasses(target, i, end, info);
    i = end;
  }
}

GLbitfield boundaryOf(const VitrailGlTarget_T& target, Call call) { return bitsOf(target.plan.beforeCall(call)); }

} // namespace vitrail
