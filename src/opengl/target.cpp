// Creation, resizing and destruction of a target, and what it tells.
#include "target.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

#include "core/target_common.h"
#include "state.h"

namespace vitrail {

namespace {

TargetInfo targetInfo(const VitrailGlTargetDesc& desc) {
  TargetInfo info = infoOf(desc);
  info.canStoreColor = desc.textures.color != nullptr;
  info.hasStencil = true; // the framebuffer may have one
  return info;
}

ViewsInfo viewsInfo(const VitrailGlTextures& textures) {
  ViewsInfo info = infoOfViews(textures);
  info.field = "textures";
  return info;
}

void keepViews(VitrailGlTarget_T& target, const VitrailGlTextures& textures) {
  keepViewsOf(target.views, textures);
  target.viewCount = textures.count;
}

GLenum colorFormatOf(const VitrailGlTargetDesc& desc) { return desc.colorFormat != 0 ? desc.colorFormat : GL_RGBA16F; }

VitrailResult checkDesc(const VitrailGlContext_T& context, const VitrailGlTargetDesc& desc, const TargetInfo& info) {
  const VitrailResult result = checkTarget(context.limits, context.log, info);
  if (result != VITRAIL_SUCCESS) return result;
  const GLenum format = colorFormatOf(desc);
  if (info.resolve == VITRAIL_RESOLVE_COMPUTE && format != GL_RGBA16F && format != GL_RGBA32F) {
    return context.log.fail(VITRAIL_ERROR_FORMAT, "colorFormat 0x%x: a compute resolve writes GL_RGBA16F or GL_RGBA32F",
                            format);
  }
  if (desc.stencilMask > 0xffU) {
    return context.log.fail(VITRAIL_ERROR_INVALID, "stencilMask 0x%x: a stencil has 8 bits", desc.stencilMask);
  }
  return checkViews(context.log, info, viewsInfo(desc.textures));
}

// ---- What a target is made of

ProgramKey programKey(const VitrailGlTarget_T& target, const Pass& pass) {
  const DeviceLimits& limits = target.context->limits;
  const TargetInfo& info = target.info;
  ProgramKey key;
  key.format = info.nodeFormat;
  key.samples = info.samples;
  key.nearestIsOne = info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE;
  key.maxLayers = info.maxLayers;
  key.testDepth = info.testsDepth();
  key.networks = limits.networks;
  if (pass.action != Action::Dispatch) {
    key.draws = true;
    key.kernel = static_cast<std::uint32_t>(
        pass.action == Action::DrawPlain ? FragmentResolve::Plain : fragmentResolve(info, !target.severalDrawBuffers));
    return key;
  }
  key.kernel = static_cast<std::uint32_t>(pass.kernel);
  key.networks = limits.networks && (limits.exchangesInGroups || info.resolve != VITRAIL_RESOLVE_COMPUTE);
  if (pass.group != 0) key.group = pass.group;
  if (pass.call == Call::Resolve) {
    key.color = target.colorFormat == GL_RGBA32F ? ColorImage::Rgba32f : ColorImage::Rgba16f;
    key.multisampled = info.samples > 1;
  } else {
    key.testDepth = false; // only what writes a picture looks at depth: the others are shared by more targets
  }
  return key;
}

VitrailResult findPrograms(VitrailGlTarget_T& target) {
  const std::vector<Pass>& passes = target.plan.passes();
  std::vector<ProgramKey> keys;
  for (const Pass& pass : passes) {
    if (runsShaders(pass)) keys.push_back(programKey(target, pass));
  }
  std::vector<GLuint> found(keys.size());
  const VitrailResult result = findPrograms(*target.context, keys, found);
  if (result != VITRAIL_SUCCESS) return result;
  target.programs.resize(passes.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    if (runsShaders(passes[i])) target.programs[i] = found[next++];
  }
  return VITRAIL_SUCCESS;
}

VitrailResult createStats(VitrailGlTarget_T& target) {
  const GlFunctions& gl = target.context->gl;
  const SavedCopies saved(gl);
  const std::uint64_t bytes = statisticsBytes(target.info.framesInFlight);
  constexpr GLbitfield kMapped = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  target.slots.resize(statisticsSlots(target.info.framesInFlight));
  target.pending.resize(target.slots.size());
  // Counters of no frame, for one whose commands never run though its fence says so: a context was lost.
  for (StatsSlot& slot : target.slots) slot.begunFrame = kNoFrame;
  const BufferDesc desc{bytes,          target.slots.data(),      kMapped | GL_CLIENT_STORAGE_BIT,
                        GL_STREAM_READ, target.debugName.c_str(), "statistics"};
  const VitrailResult result = createBuffer(*target.context, desc, &target.statsBuffer);
  if (result != VITRAIL_SUCCESS) return result;
  if (gl.BufferStorage != nullptr && gl.MapBufferRange != nullptr) {
    target.stats = static_cast<const std::byte*>(
        gl.MapBufferRange(GL_COPY_WRITE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), kMapped));
  }
  return VITRAIL_SUCCESS;
}

VitrailResult createWritten(VitrailGlTarget_T& target) {
  const SavedCopies saved(target.context->gl);
  constexpr std::size_t kBytes = std::max(sizeof(layout::VitrailParameters), sizeof(layout::VitrailCopyHeader));
  const BufferDesc desc{kBytes,      nullptr, GL_DYNAMIC_STORAGE_BIT, GL_STREAM_COPY, target.debugName.c_str(),
                        "parameters"};
  return createBuffer(*target.context, desc, &target.writtenBuffer);
}

VitrailResult replaceStorage(VitrailGlTarget_T& target, const StorageNeeds& needs) {
  GlStorage made;
  const std::uint64_t budget = target.info.memoryBudget;
  const std::uint64_t beside = statisticsBytes(target.info.framesInFlight);
  const VitrailResult result =
      made.create(*target.context, needs, target.hostBuffer, target.info.bufferOffset,
                  budget == 0 ? std::numeric_limits<std::uint64_t>::max() : budget - std::min(budget, beside),
                  target.debugName.c_str());
  if (result != VITRAIL_SUCCESS) return result;
  target.storage.destroy(*target.context);
  target.storage = made;
  target.sums.reset();
  return VITRAIL_SUCCESS;
}

VitrailResult buildTarget(VitrailGlTarget_T& target) {
  target.plan = FramePlan(planFacts(target.context->limits, target.info));
  VitrailResult result = findPrograms(target);
  if (result == VITRAIL_SUCCESS) result = createStats(target);
  if (result == VITRAIL_SUCCESS) result = createWritten(target);
  if (result != VITRAIL_SUCCESS) return result;
  return replaceStorage(target, storageNeeds(target.context->limits, target.info));
}

std::unique_ptr<VitrailGlTarget_T> makeTarget(VitrailGlContext context, const VitrailGlTargetDesc& desc,
                                              const TargetInfo& info) {
  std::unique_ptr<VitrailGlTarget_T> made(new (std::nothrow) VitrailGlTarget_T);
  if (!made) return nullptr;
  made->context = context;
  ++context->owners;
  made->info = info;
  made->info.nodeCapacity = capacityWithin(context->limits, info);
  made->colorFormat = colorFormatOf(desc);
  made->hostBuffer = desc.buffer;
  made->hostBarriers = desc.hostBarriers != 0;
  made->severalDrawBuffers = desc.severalDrawBuffers != 0;
  if (desc.stencilMask != 0) made->stencilMask = desc.stencilMask;
  made->debugName = desc.debugName != nullptr ? desc.debugName : "vitrail";
  keepViews(*made, desc.textures);
  return made;
}

// ---- Statistics

// Takes the counters of a slot from where the GPU has written them, once it has.
void fetch(VitrailGlTarget_T& target, std::size_t slot) {
  const GlFunctions& gl = target.context->gl;
  PendingStats& pending = target.pending[slot];
  if (pending.fence == nullptr) return;
  const GLenum state = gl.ClientWaitSync(pending.fence, GL_SYNC_FLUSH_COMMANDS_BIT, 0);
  if (state == GL_WAIT_FAILED) target.lost = true; // the fence is one: nothing else can be wrong
  if (state != GL_ALREADY_SIGNALED && state != GL_CONDITION_SATISFIED) return;
  constexpr std::size_t kBytes = offsetof(StatsSlot, facts);
  StatsSlot& kept = target.slots[slot];
  if (target.stats != nullptr) {
    std::memcpy(&kept, target.stats + slot * sizeof(StatsSlot), kBytes);
  } else {
    const SavedCopies saved(gl);
    gl.BindBuffer(GL_COPY_READ_BUFFER, target.statsBuffer);
    gl.GetBufferSubData(GL_COPY_READ_BUFFER, static_cast<GLintptr>(slot * sizeof(StatsSlot)), kBytes, &kept);
  }
  kept.tag = pending.frame + 1;
  gl.DeleteSync(pending.fence);
  pending.fence = nullptr;
}

bool readFrame(VitrailGlTarget_T& target, std::uint64_t frame, VitrailStats& stats) {
  const std::size_t slot = target.slotOf(frame);
  fetch(target, slot);
  return readSlot(target.slots[slot], frame, {static_cast<std::uint32_t>(target.info.nodeFormat), target.info.samples},
                  stats);
}

// The statistics of the newest finished frame, of `frame` and those before it that still have a slot.
bool readNewest(VitrailGlTarget_T& target, std::uint64_t frame, VitrailStats& stats) {
  return readNewestOf(frame, target.slots.size(), [&](std::uint64_t one) { return readFrame(target, one, stats); });
}

} // namespace

} // namespace vitrail

extern "C" VitrailResolve vitrailGlDefaultResolve(VitrailGlContext context, const VitrailGlTargetDesc* desc) {
  if (context == nullptr || desc == nullptr) {
    vitrail::nullArgument(context, "vitrailGlDefaultResolve");
    return VITRAIL_RESOLVE_DEFAULT;
  }
  return vitrail::defaultResolve(vitrail::targetInfo(*desc));
}

extern "C" VitrailListBuild vitrailGlDefaultListBuild(VitrailGlContext context, const VitrailGlTargetDesc* desc) {
  if (context == nullptr || desc == nullptr) {
    vitrail::nullArgument(context, "vitrailGlDefaultListBuild");
    return VITRAIL_LIST_BUILD_DEFAULT;
  }
  return vitrail::defaultListBuild(context->limits, vitrail::targetInfo(*desc));
}

extern "C" VitrailResult vitrailGlTargetRequirements(VitrailGlContext context, const VitrailGlTargetDesc* desc,
                                                     VitrailGlRequirements* requirements) {
  using namespace vitrail;
  if (requirements != nullptr) clearKeepingNext(*requirements);
  if (context == nullptr || desc == nullptr || requirements == nullptr) {
    return nullArgument(context, "vitrailGlTargetRequirements");
  }
  VitrailResult result = checkNoNext(context->log, desc->next, "VitrailGlTargetDesc");
  if (result != VITRAIL_SUCCESS) return result;
  const TargetInfo info = withDefaults(context->limits, targetInfo(*desc));
  result = checkMemory(context->limits, context->log, info);
  if (result != VITRAIL_SUCCESS) return result;
  requirements->size = layoutStorage(storageNeeds(context->limits, info)).total;
  requirements->alignment = context->limits.alignment;
  return VITRAIL_SUCCESS;
}

extern "C" VitrailResult vitrailGlCreateTarget(VitrailGlContext context, const VitrailGlTargetDesc* desc,
                                               VitrailGlTarget* target) {
  using namespace vitrail;
  if (target != nullptr) *target = nullptr;
  if (context == nullptr || desc == nullptr || target == nullptr) {
    return nullArgument(context, "vitrailGlCreateTarget");
  }
  VitrailResult result = checkNoNext(context->log, desc->next, "VitrailGlTargetDesc");
  if (result != VITRAIL_SUCCESS) return result;
  const TargetInfo info = withDefaults(context->limits, targetInfo(*desc));
  result = checkDesc(*context, *desc, info);
  if (result != VITRAIL_SUCCESS) return result;
  std::unique_ptr<VitrailGlTarget_T> made = makeTarget(context, *desc, info);
  if (!made) return context->log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "no memory for a target");
  result = buildTarget(*made);
  if (result != VITRAIL_SUCCESS) {
    vitrailGlDestroyTarget(made.release());
    return result; // the log has the reason
  }
  *target = made.release();
  return VITRAIL_SUCCESS;
}

extern "C" void vitrailGlDestroyTarget(VitrailGlTarget target) {
  if (target == nullptr) return;
  const std::unique_ptr<VitrailGlTarget_T> owned(target);
  const vitrail::GlFunctions& gl = target->context->gl;
  for (const vitrail::PendingStats& pending : target->pending) {
    if (pending.fence != nullptr) gl.DeleteSync(pending.fence);
  }
  target->storage.destroy(*target->context);
  if (target->writtenBuffer != 0) gl.DeleteBuffers(1, &target->writtenBuffer);
  if (target->statsBuffer != 0) gl.DeleteBuffers(1, &target->statsBuffer); // which unmaps it
  vitrail::releaseContext(target->context);
}

extern "C" VitrailResult vitrailGlUpdateTarget(VitrailGlTarget target, uint64_t frame) {
  using namespace vitrail;
  if (target == nullptr) return VITRAIL_ERROR_INVALID;
  // A number that is too large says nothing of frames that were never begun.
  const std::uint64_t number = std::min(target->frames.numberOf(frame), target->frames.numberOf(0));
  StorageNeeds needs = target->storage.needs;
  bool read = true;
  needs.nodeCapacity = wantedCapacity(target->growth, target->context->limits, target->info, needs.nodeCapacity,
                                      [&](VitrailStats& stats) { return read = readNewest(*target, number, stats); });
  if (!read && target->lost) return VITRAIL_ERROR_DEVICE_LOST;
  if (needs.nodeCapacity == target->storage.needs.nodeCapacity) return VITRAIL_SUCCESS;
  const VitrailResult result = replaceStorage(*target, needs);
  if (result != VITRAIL_SUCCESS) return result;
  target->order.drop(target->context->log, "vitrailGlUpdateTarget() gives the target another pool");
  return VITRAIL_SUCCESS;
}

extern "C" VitrailResult vitrailGlResizeTarget(VitrailGlTarget target, const VitrailGlResizeInfo* info) {
  using namespace vitrail;
  if (target == nullptr || info == nullptr) {
    return nullArgument(target != nullptr ? target->context : nullptr, "vitrailGlResizeTarget");
  }
  const VitrailGlContext_T& context = *target->context;
  VitrailResult result = checkNoNext(context.log, info->next, "VitrailGlResizeInfo");
  if (result != VITRAIL_SUCCESS) return result;
  if (target->hostBuffer != 0) {
    return context.log.fail(VITRAIL_ERROR_INVALID, "a target in the host's memory cannot be resized: make another one");
  }
  TargetInfo wanted = resized(target->info, target->storage.needs.nodeCapacity, info->width, info->height,
                              info->nodeCapacity, info->areaPixels);
  result = checkTarget(context.limits, context.log, wanted);
  if (result == VITRAIL_SUCCESS) result = checkViews(context.log, wanted, viewsInfo(info->textures));
  if (result != VITRAIL_SUCCESS) return result;
  wanted.nodeCapacity = capacityWithin(context.limits, wanted);
  result = replaceStorage(*target, storageNeeds(context.limits, wanted));
  if (result != VITRAIL_SUCCESS) return result;
  target->order.drop(context.log, "vitrailGlResizeTarget()");
  target->info = wanted;
  keepViews(*target, info->textures);
  target->growth.forget();
  return VITRAIL_SUCCESS;
}

extern "C" VitrailResolve vitrailGlTargetResolve(VitrailGlTarget target) {
  return target != nullptr ? target->info.resolve : VITRAIL_RESOLVE_DEFAULT;
}

extern "C" VitrailListBuild vitrailGlTargetListBuild(VitrailGlTarget target) {
  return target != nullptr ? target->info.listBuild : VITRAIL_LIST_BUILD_DEFAULT;
}

extern "C" uint64_t vitrailGlTargetFrame(VitrailGlTarget target) {
  return target != nullptr ? target->frames.newest() : 0;
}

extern "C" void vitrailGlTargetMemory(VitrailGlTarget target, VitrailMemory* memory) {
  if (memory != nullptr) vitrail::clearKeepingNext(*memory);
  if (target == nullptr || memory == nullptr) {
    vitrail::nullArgument(target != nullptr ? target->context : nullptr, "vitrailGlTargetMemory");
    return;
  }
  const vitrail::GlStorage& storage = target->storage;
  const std::uint64_t page = storage.bytes - storage.layout.total; // what fills it
  vitrail::tellMemory(*memory, storage.needs, storage.layout,
                      page + vitrail::statisticsBytes(target->info.framesInFlight), 0);
}

extern "C" uint64_t vitrailGlCopySize(VitrailGlTarget target, uint32_t width, uint32_t height) {
  if (target == nullptr) return 0;
  return vitrail::copyBytes(std::uint64_t{width} * height, target->info.copyLayers);
}

extern "C" void vitrailGlCollectSpecialization(VitrailGlContext context, const VitrailGlTargetDesc* desc,
                                               VitrailGlSpecialization* specialization) {
  if (specialization != nullptr) *specialization = {};
  if (context == nullptr || desc == nullptr || specialization == nullptr) {
    vitrail::nullArgument(context, "vitrailGlCollectSpecialization");
    return;
  }
  const vitrail::TargetInfo info = vitrail::withDefaults(context->limits, vitrail::targetInfo(*desc));
  std::snprintf(specialization->defines, sizeof(specialization->defines),
                "#define VITRAIL_ONLY_FORMAT %d\n#define VITRAIL_ONLY_SAMPLES %u\n#define VITRAIL_ONLY_OVERFLOW %d\n"
                "#define VITRAIL_ONLY_LIST_BUILD %d\n#define VITRAIL_ONLY_USER_WORDS %d\n",
                static_cast<int>(info.nodeFormat), info.samples, info.keepsSums() ? 0 : 1,
                static_cast<int>(info.listBuild), info.userWords ? 1 : 0);
}

extern "C" void vitrailGlTilePlanTarget(VitrailTilePlan plan, VitrailGlTargetDesc* desc) {
  vitrail::tilePlanTarget(plan, desc);
}

extern "C" VitrailResult vitrailGlReadStats(VitrailGlTarget target, uint64_t frame, VitrailStats* stats) {
  using namespace vitrail;
  if (target == nullptr || stats == nullptr) {
    if (stats != nullptr) clearKeepingNext(*stats);
    return nullArgument(target != nullptr ? target->context : nullptr, "vitrailGlReadStats");
  }
  const bool newest = frame == 0 && !target->frames.areGiven();
  const bool read = newest ? readNewest(*target, target->frames.newest(), *stats) : readFrame(*target, frame, *stats);
  if (read) return VITRAIL_SUCCESS;
  return target->lost ? VITRAIL_ERROR_DEVICE_LOST : VITRAIL_INCOMPLETE;
}
