// The calls of a frame.
#include "core/frame_start.h"
#include "core/parameters.h"
#include "target.h"
#include "vitrail/bindings.h"

namespace vitrail {

namespace {

constexpr const char* kPrefix = "vitrailGl";

bool allows(VitrailGlTarget target, Call call) { return target->order.allows(call, target->context->log, kPrefix); }

// Barriers between the calls are the host's where it says so.
void boundary(const VitrailGlTarget_T& target, Call call) {
  const GLbitfield bits = target.hostBarriers ? 0 : boundaryOf(target, call);
  if (bits != 0) target.context->gl.MemoryBarrier(bits);
}

bool nextIsNull(VitrailGlTarget target, const void* next, const char* structure) {
  if (checkNoNext(target->context->log, next, structure) == VITRAIL_SUCCESS) return true;
  target->order.setMisused();
  return false;
}

// Starts the frame on the host's side: its number, its area.
void beginFrame(VitrailGlTarget_T& target, const VitrailGlBeginInfo& info, bool open) {
  startFrame(target.frames, target.order, target.growth, target.context->log, info.frame, open);
  bool whole = true;
  target.area =
      areaOfFrame(target.info, target.context->log, info.area.x, info.area.y, info.area.width, info.area.height, whole);
  if (!whole) target.order.setMisused();
}

// The view to resolve to.
std::uint32_t viewOf(VitrailGlTarget_T& target, const VitrailGlResolveInfo* info) {
  const std::uint32_t view = info != nullptr ? info->view : 0;
  if (view == 0 || view < target.viewCount) return view;
  target.context->log.warn("view %u is resolved, the target has %u: view 0 is taken", view, target.viewCount);
  target.order.setMisused();
  return 0;
}

} // namespace

} // namespace vitrail

extern "C" void vitrailGlBegin(VitrailGlTarget target, const VitrailGlBeginInfo* info) {
  using namespace vitrail;
  if (target == nullptr) return;
  const bool open = target->order.begun();
  allows(target, Call::Begin);
  const VitrailGlBeginInfo given = info != nullptr ? *info : VitrailGlBeginInfo{};
  nextIsNull(target, given.next, "VitrailGlBeginInfo");
  beginFrame(*target, given, open);
  boundary(*target, Call::Begin);
  runCall(*target, Call::Begin);
  boundary(*target, Call::Draws);
}

extern "C" void vitrailGlBind(VitrailGlTarget target) {
  if (target == nullptr) return;
  static_assert(VITRAIL_GL_BINDINGS == VITRAIL_BINDING_MEDIUM_LISTS, "what fragment shaders see");
  target->storage.bind(*target->context, target->context->bindingBase, VITRAIL_GL_BINDINGS);
}

extern "C" void vitrailGlCollected(VitrailGlTarget target) {
  using namespace vitrail;
  if (target == nullptr || !allows(target, Call::Collected)) return;
  boundary(*target, Call::Collected);
  runCall(*target, Call::Collected);
  boundary(*target, Call::Resolve); // here and not in the resolve: shaders of the host that walk lists need it, too
}

extern "C" void vitrailGlCopyLists(VitrailGlTarget target, const VitrailGlCopyInfo* info) {
  using namespace vitrail;
  if (target == nullptr || !allows(target, Call::CopyLists)) return;
  if (info == nullptr) {
    nullArgument(target->context, "vitrailGlCopyLists");
    return target->order.setMisused();
  }
  if (!nextIsNull(target, info->next, "VitrailGlCopyInfo")) return;
  const CopyRequest request{info->area.x,      info->area.y, info->area.width, info->area.height,
                            info->buffer != 0, info->offset, info->size,       "vitrailGlCopySize"};
  if (!canCopy(target->context->log, kPrefix, target->info, target->area, request))
    return target->order.setMisused(); // what is in the host's buffer is of another frame
  GlCallInfo call;
  call.copied = info->area;
  call.copyBuffer = info->buffer;
  call.copyOffset = info->offset;
  const GlFunctions& gl = target->context->gl;
  const GLbitfield before = boundaryOf(*target, Call::CopyLists);
  if (before != 0) gl.MemoryBarrier(before); // not one of the points that vitrailGlBarriers() names
  runCall(*target, Call::CopyLists, call);
  const GLbitfield after = boundaryOf(*target, Call::Resolve); // the copy relinks long lists
  if (after != 0) gl.MemoryBarrier(after);
}

extern "C" void vitrailGlResolve(VitrailGlTarget target, const VitrailGlResolveInfo* info) {
  using namespace vitrail;
  if (target == nullptr || !allows(target, Call::Resolve)) return;
  if (info != nullptr) nextIsNull(target, info->next, "VitrailGlResolveInfo");
  GlCallInfo call;
  call.view = viewOf(*target, info);
  if (target->area.width == 0) return; // nothing of the picture is in the area
  runCall(*target, Call::Resolve, call);
  if (target->info.resolve != VITRAIL_RESOLVE_COMPUTE) return;
  target->sums.cleaned();
  if (target->hostBarriers) return;
  // Writer: the resolve. Readers and writers: whatever the host does with the texture, and its shaders that walk lists.
  target->context->gl.MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                                    GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                                    GL_PIXEL_BUFFER_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

extern "C" void vitrailGlEnd(VitrailGlTarget target) {
  using namespace vitrail;
  if (target == nullptr) return;
  const bool collected = target->order.collected();
  if (!allows(target, Call::End)) return;
  boundary(*target, Call::End);
  // The dispatch that cleans up has its arguments from the call that was to collect.
  if (target->info.resolve == VITRAIL_RESOLVE_FRAGMENT && collected) target->sums.cleaned();
  runCall(*target, Call::End);
}

extern "C" uint32_t vitrailGlBarriers(VitrailGlTarget target, VitrailGlBarrierPoint point) {
  using namespace vitrail;
  if (target == nullptr) return 0;
  switch (point) {
    case VITRAIL_GL_BARRIER_BEGIN:
      return boundaryOf(*target, Call::Begin);
    case VITRAIL_GL_BARRIER_COLLECT:
      return boundaryOf(*target, Call::Draws);
    case VITRAIL_GL_BARRIER_COLLECTED:
      return boundaryOf(*target, Call::Collected);
    case VITRAIL_GL_BARRIER_RESOLVE:
      return boundaryOf(*target, Call::Resolve);
    case VITRAIL_GL_BARRIER_END:
      return boundaryOf(*target, Call::End);
    case VITRAIL_GL_BARRIER_POINT_MAX_ENUM:
      break;
  }
  target->context->log.error("vitrailGlBarriers: point %d is none of VitrailGlBarrierPoint", static_cast<int>(point));
  return 0;
}
