// Creation, resizing and destruction of a target, and what it tells.
#include "target.h"

#include <algorithm>
#include <memory>
#include <new>

#include "check.h"
#include "convert.h"
#include "core/target_common.h"

namespace vitrail {

namespace {

VkResult checkDesc(VitrailVkContext context, const VitrailVkTargetDesc& desc, const TargetInfo& info) {
  VkResult result = toVk(checkTarget(context->limits, context->log, info));
  if (result == VK_SUCCESS) result = checkFormats(*context, desc, info);
  if (result == VK_SUCCESS) result = toVk(checkViews(context->log, info, infoOfViews(desc.views)));
  return result;
}

std::unique_ptr<VitrailVkTarget_T> makeTarget(VitrailVkContext context, const VitrailVkTargetDesc& desc,
                                              const TargetInfo& info) {
  std::unique_ptr<VitrailVkTarget_T> made(new (std::nothrow) VitrailVkTarget_T);
  if (!made) return nullptr;
  made->context = context;
  ++context->owners;
  made->info = info;
  made->info.nodeCapacity = capacityWithin(context->limits, info);
  made->colorFormat = colorFormatOf(desc);
  made->scope = desc.scope;
  made->hostBarriers = desc.hostBarriers != VK_FALSE;
  made->hostBuffer = desc.buffer;
  made->debugName = desc.debugName != nullptr ? desc.debugName : "vitrail";
  keepViews(*made, desc.views);
  return made;
}

bool readFrame(const VitrailVkTarget_T& target, std::uint64_t frame, VitrailStats& stats) {
  const NodeKind nodes{target.info.nodeFormat, target.info.samples};
  return readSlot(target.slots()[target.slotOf(frame)], frame, nodes, stats);
}

// The statistics of the newest finished frame, of `frame` and those before it that still have a slot.
bool readNewest(const VitrailVkTarget_T& target, std::uint64_t frame, VitrailStats& stats) {
  return readNewestOf(frame, target.slots().size(), [&](std::uint64_t one) { return readFrame(target, one, stats); });
}

} // namespace

} // namespace vitrail

extern "C" VitrailResolve vitrailVkDefaultResolve(VitrailVkContext context, const VitrailVkTargetDesc* desc) {
  if (context == nullptr || desc == nullptr) {
    vitrail::nullArgument(context, "vitrailVkDefaultResolve");
    return VITRAIL_RESOLVE_DEFAULT;
  }
  return vitrail::defaultResolve(vitrail::targetInfo(*context, *desc));
}

extern "C" VitrailListBuild vitrailVkDefaultListBuild(VitrailVkContext context, const VitrailVkTargetDesc* desc) {
  if (context == nullptr || desc == nullptr) {
    vitrail::nullArgument(context, "vitrailVkDefaultListBuild");
    return VITRAIL_LIST_BUILD_DEFAULT;
  }
  return vitrail::defaultListBuild(context->limits, vitrail::targetInfo(*context, *desc));
}

extern "C" VkResult vitrailVkTargetRequirements(VitrailVkContext context, const VitrailVkTargetDesc* desc,
                                                VitrailVkRequirements* requirements) {
  using namespace vitrail;
  if (requirements != nullptr) clearKeepingNext(*requirements);
  if (context == nullptr || desc == nullptr || requirements == nullptr) {
    return nullArgument(context, "vitrailVkTargetRequirements");
  }
  VkResult result = checkNext(context->log, desc->next, "VitrailVkTargetDesc");
  if (result != VK_SUCCESS) return result;
  const TargetInfo info = withDefaults(context->limits, targetInfo(*context, *desc));
  result = toVk(checkMemory(context->limits, context->log, info));
  if (result != VK_SUCCESS) return result;
  requirements->size = layoutStorage(storageNeeds(context->limits, info)).total;
  requirements->alignment = context->limits.alignment;
  requirements->usage = storageUsage(*context);
  return VK_SUCCESS;
}

extern "C" VkResult vitrailVkCreateTarget(VitrailVkContext context, const VitrailVkTargetDesc* desc,
                                          VitrailVkTarget* target) {
  using namespace vitrail;
  if (target != nullptr) *target = nullptr;
  if (context == nullptr || desc == nullptr || target == nullptr) {
    return nullArgument(context, "vitrailVkCreateTarget");
  }
  if (context->destroyed) {
    return context->log.fail(VK_ERROR_INITIALIZATION_FAILED, "vitrailVkCreateTarget: the context was destroyed");
  }
  VkResult result = checkNext(context->log, desc->next, "VitrailVkTargetDesc");
  if (result != VK_SUCCESS) return result;
  const TargetInfo info = withDefaults(context->limits, targetInfo(*context, *desc));
  result = checkDesc(context, *desc, info);
  if (result != VK_SUCCESS) return result;
  std::unique_ptr<VitrailVkTarget_T> made = makeTarget(context, *desc, info);
  if (!made) return context->log.fail(VK_ERROR_OUT_OF_HOST_MEMORY, "no memory for a target");
  result = buildTarget(*made);
  if (result != VK_SUCCESS) {
    vitrailVkDestroyTarget(made.release());
    return result; // the log has the reason
  }
  *target = made.release();
  return VK_SUCCESS;
}

extern "C" void vitrailVkDestroyTarget(VitrailVkTarget target) {
  if (target == nullptr) return;
  const std::unique_ptr<VitrailVkTarget_T> owned(target);
  const VitrailVkContext_T& context = *target->context;
  for (vitrail::Storage& storage : target->retired) storage.destroy(context);
  target->storage.destroy(context);
  target->stats.destroy(context);
  for (const VkPipeline pipeline : target->graphicsPipelines) {
    context.vk.DestroyPipeline(context.device, pipeline, context.allocator);
  }
  vitrail::releaseContext(target->context);
}

extern "C" VkResult vitrailVkUpdateTarget(VitrailVkTarget target, uint64_t frame) {
  using namespace vitrail;
  if (target == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  // A number that is too large says nothing of frames that were never begun.
  const std::uint64_t number = std::min(target->frames.numberOf(frame), target->frames.numberOf(0));
  const bool again = target->frames.any() && number == target->frames.newest() && frame != 0;
  const std::uint64_t place = target->frames.begun() + (again ? 0 : 1); // of the frame that is about to be recorded
  freeRetired(*target, place);
  StorageNeeds needs = target->storage.needs;
  needs.nodeCapacity = wantedCapacity(target->growth, target->context->limits, target->info, needs.nodeCapacity,
                                      [&](VitrailStats& stats) { return readNewest(*target, number, stats); });
  if (needs.nodeCapacity == target->storage.needs.nodeCapacity) return VK_SUCCESS;
  const VkResult result = replaceStorage(*target, needs, target->views);
  if (result != VK_SUCCESS) return result;
  target->order.drop(target->context->log, "vitrailVkUpdateTarget() gives the target another pool");
  freeRetired(*target, place); // at once where no frame was begun with it
  return VK_SUCCESS;
}

extern "C" VkResult vitrailVkResizeTarget(VitrailVkTarget target, const VitrailVkResizeInfo* info) {
  using namespace vitrail;
  if (target == nullptr || info == nullptr) {
    return nullArgument(target != nullptr ? target->context : nullptr, "vitrailVkResizeTarget");
  }
  const VitrailVkContext_T& context = *target->context;
  VkResult result = checkNext(context.log, info->next, "VitrailVkResizeInfo");
  if (result != VK_SUCCESS) return result;
  if (target->hostBuffer != VK_NULL_HANDLE) {
    return context.log.fail(VK_ERROR_INITIALIZATION_FAILED,
                            "a target in the host's memory cannot be resized: make another one");
  }
  TargetInfo wanted = resized(target->info, target->storage.needs.nodeCapacity, info->extent.width, info->extent.height,
                              info->nodeCapacity, info->areaPixels);
  result = toVk(checkTarget(context.limits, context.log, wanted));
  if (result == VK_SUCCESS) result = toVk(checkViews(context.log, wanted, infoOfViews(info->views)));
  if (result != VK_SUCCESS) return result;
  wanted.nodeCapacity = capacityWithin(context.limits, wanted);
  result = replaceStorage(*target, storageNeeds(context.limits, wanted), info->views);
  if (result != VK_SUCCESS) return result;
  target->order.drop(context.log, "vitrailVkResizeTarget()");
  target->info = wanted;
  keepViews(*target, info->views);
  target->growth.forget();
  freeRetired(*target, target->frames.begun());
  return VK_SUCCESS;
}

extern "C" VitrailResolve vitrailVkTargetResolve(VitrailVkTarget target) {
  return target != nullptr ? target->info.resolve : VITRAIL_RESOLVE_DEFAULT;
}

extern "C" VitrailListBuild vitrailVkTargetListBuild(VitrailVkTarget target) {
  return target != nullptr ? target->info.listBuild : VITRAIL_LIST_BUILD_DEFAULT;
}

extern "C" VkDescriptorSet vitrailVkTargetDescriptorSet(VitrailVkTarget target) {
  return target != nullptr ? target->storage.set : VK_NULL_HANDLE;
}

extern "C" uint64_t vitrailVkTargetFrame(VitrailVkTarget target) {
  return target != nullptr ? target->frames.newest() : 0;
}

extern "C" void vitrailVkTargetMemory(VitrailVkTarget target, VitrailMemory* memory) {
  if (memory != nullptr) vitrail::clearKeepingNext(*memory);
  if (target == nullptr || memory == nullptr) {
    vitrail::nullArgument(target != nullptr ? target->context : nullptr, "vitrailVkTargetMemory");
    return;
  }
  const vitrail::Storage& storage = target->storage;
  std::uint64_t retired = 0;
  for (const vitrail::Storage& one : target->retired) retired += one.layout.total;
  vitrail::tellMemory(*memory, storage.needs, storage.layout, target->stats.size, retired);
}

extern "C" VkDeviceSize vitrailVkCopySize(VitrailVkTarget target, uint32_t width, uint32_t height) {
  if (target == nullptr) return 0;
  return vitrail::copyBytes(std::uint64_t{width} * height, target->info.copyLayers);
}

extern "C" void vitrailVkCollectSpecialization(VitrailVkContext context, const VitrailVkTargetDesc* desc,
                                               VitrailVkSpecialization* specialization) {
  if (specialization != nullptr) *specialization = {};
  if (context == nullptr || desc == nullptr || specialization == nullptr) {
    vitrail::nullArgument(context, "vitrailVkCollectSpecialization");
    return;
  }
  constexpr std::uint32_t kFirstId = 1700; // VITRAIL_CONSTANT_ID of shaders/vitrail/collect.glsl
  const vitrail::TargetInfo info = vitrail::withDefaults(context->limits, vitrail::targetInfo(*context, *desc));
  specialization->data[0] = info.nodeFormat;
  specialization->data[1] = info.samples;
  specialization->data[2] = info.keepsSums() ? 1 : 0;
  specialization->data[3] = info.listBuild == VITRAIL_LIST_BUILD_COMPUTE ? 1 : 0;
  specialization->data[4] = info.userWords ? 1 : 0;
  specialization->count = 5;
  for (std::uint32_t i = 0; i < specialization->count; ++i) {
    specialization->entries[i] = {kFirstId + i, static_cast<std::uint32_t>(i * sizeof(std::uint32_t)),
                                  sizeof(std::uint32_t)};
  }
}

extern "C" void vitrailVkStencilMark(VkStencilOpState* state) {
  if (state == nullptr) return;
  *state = {};
  state->failOp = VK_STENCIL_OP_KEEP;
  state->passOp = VK_STENCIL_OP_INCREMENT_AND_CLAMP;
  state->depthFailOp = VK_STENCIL_OP_KEEP;
  state->compareOp = VK_COMPARE_OP_ALWAYS;
  state->compareMask = 0xffU;
  state->writeMask = 0xffU;
}

extern "C" void vitrailVkTilePlanTarget(VitrailTilePlan plan, VitrailVkTargetDesc* desc) {
  vitrail::tilePlanTarget(plan, desc);
}

extern "C" VkResult vitrailVkReadStats(VitrailVkTarget target, uint64_t frame, VitrailStats* stats) {
  using namespace vitrail;
  if (target == nullptr || stats == nullptr) {
    if (stats != nullptr) clearKeepingNext(*stats);
    return nullArgument(target != nullptr ? target->context : nullptr, "vitrailVkReadStats");
  }
  const bool newest = frame == 0 && !target->frames.areGiven();
  const bool read = newest ? readNewest(*target, target->frames.newest(), *stats) : readFrame(*target, frame, *stats);
  return read ? VK_SUCCESS : VK_NOT_READY;
}
