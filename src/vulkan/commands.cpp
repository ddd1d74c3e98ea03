// The recording calls.
#include "check.h"
#include "convert.h"
#include "core/frame_start.h"
#include "record.h"

namespace vitrail {

namespace {

constexpr const char* kPrefix = "vitrailVkCmd";

// Whether a call has what it needs; logs what not.
bool isThere(VitrailVkTarget target, VkCommandBuffer commandBuffer, const char* call) {
  if (target == nullptr) return false;
  if (commandBuffer != VK_NULL_HANDLE) return true;
  nullArgument(target->context, call);
  target->order.setMisused();
  return false;
}

bool allows(VitrailVkTarget target, Call call) { return target->order.allows(call, target->context->log, kPrefix); }

// Barriers between the calls are the host's where it says so.
void boundary(VkCommandBuffer commandBuffer, const VitrailVkTarget_T& target, Call call) {
  if (!target.hostBarriers) recordBoundary(commandBuffer, target, call);
}

bool nextIsNull(VitrailVkTarget target, const void* next, const char* structure) {
  if (checkNext(target->context->log, next, structure) == VK_SUCCESS) return true;
  target->order.setMisused();
  return false;
}

// Starts the frame on the host's side: its number, its memory, its area.
void beginFrame(VitrailVkTarget_T& target, const VitrailVkBeginInfo& info, bool open) {
  if (startFrame(target.frames, target.order, target.growth, target.context->log, info.frame,
                 open)) { // a second time: the first one was never submitted
    for (Storage& storage : target.retired) storage.use.drop(target.frames.begun());
  }
  target.storage.use.add(target.frames.begun());
  freeRetired(target, target.frames.begun());
  const VkRect2D& wanted = info.area;
  bool whole = true;
  target.area = areaOfFrame(target.info, target.context->log, wanted.offset.x, wanted.offset.y, wanted.extent.width,
                            wanted.extent.height, whole);
  if (!whole) target.order.setMisused();
}

// The view to resolve to.
std::uint32_t viewOf(VitrailVkTarget_T& target, const VitrailVkResolveInfo* info) {
  const std::uint32_t view = info != nullptr ? info->view : 0;
  if (view == 0 || view < target.storage.viewCount) return view;
  target.context->log.warn("view %u is resolved, the target has %u: view 0 is taken", view, target.storage.viewCount);
  target.order.setMisused();
  return 0;
}

} // namespace

} // namespace vitrail

extern "C" void vitrailVkCmdBegin(VkCommandBuffer commandBuffer, VitrailVkTarget target,
                                  const VitrailVkBeginInfo* info) {
  using namespace vitrail;
  if (!isThere(target, commandBuffer, "vitrailVkCmdBegin")) return;
  const bool open = target->order.begun();
  allows(target, Call::Begin);
  const VitrailVkBeginInfo given = info != nullptr ? *info : VitrailVkBeginInfo{};
  nextIsNull(target, given.next, "VitrailVkBeginInfo");
  beginFrame(*target, given, open);
  boundary(commandBuffer, *target, Call::Begin);
  recordCall(commandBuffer, *target, Call::Begin);
  boundary(commandBuffer, *target, Call::Draws);
}

extern "C" void vitrailVkCmdCollected(VkCommandBuffer commandBuffer, VitrailVkTarget target) {
  using namespace vitrail;
  if (!isThere(target, commandBuffer, "vitrailVkCmdCollected") || !allows(target, Call::Collected)) return;
  boundary(commandBuffer, *target, Call::Collected);
  recordCall(commandBuffer, *target, Call::Collected);
  // Here and not in the resolve, which may be in a rendering scope; shaders of the host that walk lists need it, too.
  boundary(commandBuffer, *target, Call::Resolve);
}

extern "C" void vitrailVkCmdCopyLists(VkCommandBuffer commandBuffer, VitrailVkTarget target,
                                      const VitrailVkCopyInfo* info) {
  using namespace vitrail;
  if (!isThere(target, commandBuffer, "vitrailVkCmdCopyLists") || !allows(target, Call::CopyLists)) return;
  if (info == nullptr) {
    nullArgument(target->context, "vitrailVkCmdCopyLists");
    return target->order.setMisused();
  }
  if (!nextIsNull(target, info->next, "VitrailVkCopyInfo")) return;
  const VkRect2D& copied = info->area;
  const CopyRequest request{
      copied.offset.x, copied.offset.y, copied.extent.width, copied.extent.height, info->buffer != VK_NULL_HANDLE,
      info->offset,    info->size,      "vitrailVkCopySize"};
  if (!canCopy(target->context->log, kPrefix, target->info, target->area, request))
    return target->order.setMisused(); // what is in the host's buffer is of another frame
  CallInfo call;
  call.copied = {static_cast<std::uint32_t>(info->area.offset.x), static_cast<std::uint32_t>(info->area.offset.y),
                 info->area.extent.width, info->area.extent.height};
  call.copyBuffer = info->buffer;
  call.copyOffset = info->offset;
  recordBoundary(commandBuffer, *target, Call::CopyLists); // not one of the points that vitrailVkBarriers() names
  recordCall(commandBuffer, *target, Call::CopyLists, call);
  recordBoundary(commandBuffer, *target, Call::Resolve); // the copy relinks long lists
}

extern "C" void vitrailVkCmdResolve(VkCommandBuffer commandBuffer, VitrailVkTarget target,
                                    const VitrailVkResolveInfo* info) {
  using namespace vitrail;
  if (!isThere(target, commandBuffer, "vitrailVkCmdResolve") || !allows(target, Call::Resolve)) return;
  if (info != nullptr) nextIsNull(target, info->next, "VitrailVkResolveInfo");
  CallInfo call;
  call.view = viewOf(*target, info);
  if (target->area.width == 0) return; // nothing of the picture is in the area
  recordCall(commandBuffer, *target, Call::Resolve, call);
  if (target->info.resolve == VITRAIL_RESOLVE_COMPUTE) target->sums.cleaned();
}

extern "C" void vitrailVkCmdEnd(VkCommandBuffer commandBuffer, VitrailVkTarget target) {
  using namespace vitrail;
  if (!isThere(target, commandBuffer, "vitrailVkCmdEnd")) return;
  const bool collected = target->order.collected();
  if (!allows(target, Call::End)) return;
  boundary(commandBuffer, *target, Call::End);
  // The dispatch that cleans up has its arguments from the call that was to collect.
  if (target->info.resolve == VITRAIL_RESOLVE_FRAGMENT && collected) target->sums.cleaned();
  recordCall(commandBuffer, *target, Call::End);
}

extern "C" void vitrailVkBarriers(VitrailVkTarget target, VitrailVkBarrierPoint point, VitrailVkBarriers* barriers) {
  using namespace vitrail;
  if (barriers != nullptr) clearKeepingNext(*barriers);
  if (target == nullptr) return;
  if (barriers == nullptr) {
    nullArgument(target->context, "vitrailVkBarriers");
    return;
  }
  switch (point) {
    case VITRAIL_VK_BARRIER_BEGIN:
      return boundaryOf(*target, Call::Begin, *barriers);
    case VITRAIL_VK_BARRIER_COLLECT:
      return boundaryOf(*target, Call::Draws, *barriers);
    case VITRAIL_VK_BARRIER_COLLECTED:
      return boundaryOf(*target, Call::Collected, *barriers);
    case VITRAIL_VK_BARRIER_RESOLVE:
      return boundaryOf(*target, Call::Resolve, *barriers);
    case VITRAIL_VK_BARRIER_END:
      return boundaryOf(*target, Call::End, *barriers);
    case VITRAIL_VK_BARRIER_POINT_MAX_ENUM:
      break;
  }
  target->context->log.error("vitrailVkBarriers: point %d is none of VitrailVkBarrierPoint", static_cast<int>(point));
}
