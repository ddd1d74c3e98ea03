// Creation, resizing and destruction of a target, and what it tells.
#include "target.h"

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

#include "core/target_common.h"

namespace vitrail {

namespace {

TargetInfo targetInfo(const VitrailD3d12TargetDesc& desc) {
  TargetInfo info = infoOf(desc);
  info.ownBuffer = desc.heap != nullptr;
  info.bufferSize = UINT64_MAX; // checkHeap() looks
  info.canStoreColor = desc.views.color != nullptr;
  info.hasStencil = desc.depthStencilFormat == DXGI_FORMAT_D24_UNORM_S8_UINT ||
                    desc.depthStencilFormat == DXGI_FORMAT_D32_FLOAT_S8X24_UINT;
  return info;
}

DXGI_FORMAT colorFormatOf(const VitrailD3d12TargetDesc& desc) {
  return desc.colorFormat != 0 ? static_cast<DXGI_FORMAT>(desc.colorFormat) : DXGI_FORMAT_R16G16B16A16_FLOAT;
}

// Whether a compute resolve needs a texture for what is behind.
bool copiesBehind(const TargetInfo& info) { return info.resolve == VITRAIL_RESOLVE_COMPUTE && info.samples == 1; }

// What a target has beside the lists and the slots for statistics.
std::uint64_t bytesBeside(const TargetInfo& info, DXGI_FORMAT format) {
  if (!copiesBehind(info)) return kConstantsBytes;
  return kConstantsBytes + std::uint64_t{info.width} * info.height * bytesOfPixel(format);
}

// The target with its defaults, and with what its budget leaves for its lists.
TargetInfo describe(const VitrailD3d12Context_T& context, const VitrailD3d12TargetDesc& desc) {
  const TargetInfo info = withDefaults(context.limits, targetInfo(desc));
  return underBudget(info, desc.memoryBudget, bytesBeside(info, colorFormatOf(desc)));
}

// Whether a texture is as large as the target and has the samples that it is read with.
VitrailResult checkTexture(const Log& log, const TargetInfo& info, ID3D12Resource* texture, const char* name,
                           std::uint32_t number, std::uint32_t samples) {
  const D3D12_RESOURCE_DESC desc = texture->GetDesc();
  if (desc.Dimension != D3D12_RESOURCE_DIMENSION_TEXTURE2D) {
    return log.fail(VITRAIL_ERROR_INVALID, "views.%s[%u] is not a 2D texture", name, number);
  }
  if (desc.Width < info.width || desc.Height < info.height) {
    return log.fail(VITRAIL_ERROR_INVALID, "views.%s[%u] has %llux%u pixels, the target %ux%u", name, number,
                    static_cast<unsigned long long>(desc.Width), desc.Height, info.width, info.height);
  }
  if (desc.SampleDesc.Count != samples) {
    return log.fail(VITRAIL_ERROR_INVALID, "views.%s[%u] has %u samples a pixel, %u are needed", name, number,
                    desc.SampleDesc.Count, samples);
  }
  return VITRAIL_SUCCESS;
}

// Whether the colour is what a compute resolve writes.
VitrailResult checkColor(const Log& log, ID3D12Resource* texture, std::uint32_t number, DXGI_FORMAT format) {
  const D3D12_RESOURCE_DESC desc = texture->GetDesc();
  if (desc.Format != format) {
    return log.fail(VITRAIL_ERROR_FORMAT, "views.color[%u] has format %d, colorFormat is %d", number,
                    static_cast<int>(desc.Format), static_cast<int>(format));
  }
  if ((desc.Flags & D3D12_RESOURCE_FLAG_ALLOW_UNORDERED_ACCESS) == 0) {
    return log.fail(VITRAIL_ERROR_INVALID, "views.color[%u] needs D3D12_RESOURCE_FLAG_ALLOW_UNORDERED_ACCESS", number);
  }
  return VITRAIL_SUCCESS;
}

VitrailResult checkTextures(const Log& log, const TargetInfo& info, DXGI_FORMAT format,
                            const VitrailD3d12Views& views) {
  VitrailResult result = checkViews(log, info, infoOfViews(views));
  for (std::uint32_t i = 0; i < views.count && result == VITRAIL_SUCCESS; ++i) {
    if (info.resolve == VITRAIL_RESOLVE_COMPUTE) {
      result = checkTexture(log, info, views.color[i], "color", i, 1);
      if (result == VITRAIL_SUCCESS) result = checkColor(log, views.color[i], i, format);
    }
    if (result == VITRAIL_SUCCESS && info.perPixel()) {
      result = checkTexture(log, info, views.opaque[i], "opaque", i, info.samples);
    }
    if (result == VITRAIL_SUCCESS && info.testsDepth()) {
      result = checkTexture(log, info, views.depth[i], "depth", i, info.samples);
    }
  }
  return result;
}

VitrailResult checkHeap(const VitrailD3d12Context_T& context, const VitrailD3d12TargetDesc& desc,
                        const TargetInfo& info) {
  const Log& log = context.log;
  if (desc.heap != nullptr) {
    const std::uint64_t bytes = heapBytes(layoutStorage(storageNeeds(context.limits, info)));
    if (desc.heapOffset % kPlacement != 0) {
      return log.fail(VITRAIL_ERROR_INVALID, "heapOffset %llu is not a multiple of %llu",
                      static_cast<unsigned long long>(desc.heapOffset), static_cast<unsigned long long>(kPlacement));
    }
    if (desc.heapSize < bytes) {
      return log.fail(VITRAIL_ERROR_INVALID, "heapSize %llu: the target needs %llu bytes from heapOffset on",
                      static_cast<unsigned long long>(desc.heapSize), static_cast<unsigned long long>(bytes));
    }
  }
  if (desc.descriptorHeap == nullptr) return VITRAIL_SUCCESS;
  const std::uint32_t wanted = descriptorSets(info.framesInFlight) * kSetDescriptors;
  const D3D12_DESCRIPTOR_HEAP_DESC heap = desc.descriptorHeap->GetDesc();
  if (heap.Type != D3D12_DESCRIPTOR_HEAP_TYPE_CBV_SRV_UAV ||
      (heap.Flags & D3D12_DESCRIPTOR_HEAP_FLAG_SHADER_VISIBLE) == 0) {
    return log.fail(VITRAIL_ERROR_INVALID, "descriptorHeap is not a shader-visible heap of type CBV_SRV_UAV");
  }
  if (desc.descriptorCount < wanted ||
      std::uint64_t{desc.firstDescriptor} + desc.descriptorCount > heap.NumDescriptors) {
    return log.fail(VITRAIL_ERROR_INVALID,
                    "descriptorCount %u from firstDescriptor %u on: the target needs %u, the heap has %u",
                    desc.descriptorCount, desc.firstDescriptor, wanted, heap.NumDescriptors);
  }
  return VITRAIL_SUCCESS;
}

VitrailResult checkDesc(const VitrailD3d12Context_T& context, const VitrailD3d12TargetDesc& desc,
                        const TargetInfo& info) {
  VitrailResult result = checkTarget(context.limits, context.log, info);
  if (result != VITRAIL_SUCCESS) return result;
  const DXGI_FORMAT format = colorFormatOf(desc);
  if (info.resolve == VITRAIL_RESOLVE_COMPUTE && format != DXGI_FORMAT_R16G16B16A16_FLOAT &&
      format != DXGI_FORMAT_R32G32B32A32_FLOAT) {
    return context.log.fail(VITRAIL_ERROR_FORMAT,
                            "colorFormat %d: a compute resolve writes DXGI_FORMAT_R16G16B16A16_FLOAT or "
                            "DXGI_FORMAT_R32G32B32A32_FLOAT",
                            static_cast<int>(format));
  }
  if (desc.stencilMask > 0xffU) {
    return context.log.fail(VITRAIL_ERROR_INVALID, "stencilMask 0x%x: a stencil has 8 bits", desc.stencilMask);
  }
  result = checkTextures(context.log, info, format, desc.views);
  return result == VITRAIL_SUCCESS ? checkHeap(context, desc, info) : result;
}

// ---- Memory

VitrailResult replaceStorage(VitrailD3d12Target_T& target, const TargetInfo& info, const StorageNeeds& needs,
                             std::uint64_t heapOffset = 0) {
  D3d12StorageInfo wanted;
  wanted.needs = needs;
  wanted.heap = target.hostHeap;
  wanted.heapOffset = heapOffset;
  wanted.views = &target.views;
  wanted.viewCount = target.viewCount;
  wanted.samples = info.samples;
  wanted.colorFormat = info.resolve == VITRAIL_RESOLVE_COMPUTE ? target.colorFormat : DXGI_FORMAT_UNKNOWN;
  wanted.width = copiesBehind(info) ? info.width : 0;
  wanted.height = info.height;
  wanted.debugName = target.debugName.c_str();
  D3d12Storage made;
  const VitrailResult result = made.create(*target.context, target.descriptors, wanted);
  if (result != VITRAIL_SUCCESS) return result;
  if (target.storage.heap) target.retired.push_back(std::move(target.storage));
  target.storage = std::move(made);
  target.sums.reset();
  return VITRAIL_SUCCESS;
}

std::unique_ptr<VitrailD3d12Target_T> makeTarget(VitrailD3d12Context context, const VitrailD3d12TargetDesc& desc,
                                                 const TargetInfo& info) {
  std::unique_ptr<VitrailD3d12Target_T> made(new (std::nothrow) VitrailD3d12Target_T);
  if (!made) return nullptr;
  made->context = context;
  ++context->owners;
  made->info = info;
  made->info.nodeCapacity = capacityWithin(context->limits, info);
  made->colorFormat = colorFormatOf(desc);
  made->memoryBudget = desc.memoryBudget;
  made->hostHeap = desc.heap;
  made->debugName = desc.debugName != nullptr ? desc.debugName : "vitrail";
  if (desc.descriptorHeap != nullptr) {
    made->descriptors.heap = Com<ID3D12DescriptorHeap>::shared(desc.descriptorHeap);
    made->descriptors.first = desc.firstDescriptor;
    made->descriptors.taken.resize(descriptorSets(info.framesInFlight));
  }
  keepViewsOf(made->views, desc.views);
  made->viewCount = desc.views.count;
  return made;
}

// ---- Statistics

bool readFrame(const VitrailD3d12Target_T& target, std::uint64_t frame, VitrailStats& stats) {
  const NodeKind nodes{static_cast<std::uint32_t>(target.info.nodeFormat), target.info.samples};
  return readSlot(target.slots()[target.slotOf(frame)], frame, nodes, stats);
}

bool readNewest(const VitrailD3d12Target_T& target, std::uint64_t frame, VitrailStats& stats) {
  return readNewestOf(frame, target.slots().size(), [&](std::uint64_t one) { return readFrame(target, one, stats); });
}

} // namespace

void freeRetired(VitrailD3d12Target_T& target, std::uint64_t place) {
  std::erase_if(target.retired, [&](D3d12Storage& storage) {
    if (!storage.use.isFree(place, target.info.framesInFlight)) return false;
    storage.release(target.descriptors);
    return true;
  });
}

} // namespace vitrail

extern "C" VitrailResolve vitrailD3d12DefaultResolve(VitrailD3d12Context context, const VitrailD3d12TargetDesc* desc) {
  if (context == nullptr || desc == nullptr) {
    vitrail::nullArgument(context, "vitrailD3d12DefaultResolve");
    return VITRAIL_RESOLVE_DEFAULT;
  }
  return vitrail::defaultResolve(vitrail::targetInfo(*desc));
}

extern "C" VitrailListBuild vitrailD3d12DefaultListBuild(VitrailD3d12Context context,
                                                         const VitrailD3d12TargetDesc* desc) {
  if (context == nullptr || desc == nullptr) {
    vitrail::nullArgument(context, "vitrailD3d12DefaultListBuild");
    return VITRAIL_LIST_BUILD_DEFAULT;
  }
  return vitrail::defaultListBuild(context->limits, vitrail::targetInfo(*desc));
}

extern "C" VitrailResult vitrailD3d12TargetRequirements(VitrailD3d12Context context, const VitrailD3d12TargetDesc* desc,
                                                        VitrailD3d12Requirements* requirements) {
  using namespace vitrail;
  if (requirements != nullptr) clearKeepingNext(*requirements);
  if (context == nullptr || desc == nullptr || requirements == nullptr) {
    return nullArgument(context, "vitrailD3d12TargetRequirements");
  }
  VitrailResult result = checkNoNext(context->log, desc->next, "VitrailD3d12TargetDesc");
  if (result != VITRAIL_SUCCESS) return result;
  const TargetInfo info = describe(*context, *desc);
  result = checkMemory(context->limits, context->log, info);
  if (result != VITRAIL_SUCCESS) return result;
  requirements->size = heapBytes(layoutStorage(storageNeeds(context->limits, info)));
  requirements->alignment = kPlacement;
  requirements->descriptors = descriptorSets(info.framesInFlight) * kSetDescriptors;
  return VITRAIL_SUCCESS;
}

extern "C" VitrailResult vitrailD3d12CreateTarget(VitrailD3d12Context context, const VitrailD3d12TargetDesc* desc,
                                                  VitrailD3d12Target* target) {
  using namespace vitrail;
  if (target != nullptr) *target = nullptr;
  if (context == nullptr || desc == nullptr || target == nullptr) {
    return nullArgument(context, "vitrailD3d12CreateTarget");
  }
  VitrailResult result = checkNoNext(context->log, desc->next, "VitrailD3d12TargetDesc");
  if (result != VITRAIL_SUCCESS) return result;
  const TargetInfo info = describe(*context, *desc);
  result = checkDesc(*context, *desc, info);
  if (result != VITRAIL_SUCCESS) return result;
  std::unique_ptr<VitrailD3d12Target_T> made = makeTarget(context, *desc, info);
  if (!made) return context->log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "no memory for a target");
  result = buildTarget(*made, *desc);
  if (result == VITRAIL_SUCCESS) {
    result = replaceStorage(*made, made->info, storageNeeds(context->limits, made->info), desc->heapOffset);
  }
  if (result != VITRAIL_SUCCESS) {
    vitrailD3d12DestroyTarget(made.release());
    return result; // the log has the reason
  }
  *target = made.release();
  return VITRAIL_SUCCESS;
}

extern "C" void vitrailD3d12DestroyTarget(VitrailD3d12Target target) {
  if (target == nullptr) return;
  const VitrailD3d12Context context = target->context;
  if (target->mapped != nullptr) target->stats->Unmap(0, nullptr);
  delete target; // before what it has of the context
  vitrail::releaseContext(context);
}

extern "C" VitrailResult vitrailD3d12UpdateTarget(VitrailD3d12Target target, uint64_t frame) {
  using namespace vitrail;
  if (target == nullptr) return VITRAIL_ERROR_INVALID;
  // A number that is too large says nothing of frames that were never begun.
  const std::uint64_t number = std::min(target->frames.numberOf(frame), target->frames.numberOf(0));
  const bool again = target->frames.any() && number == target->frames.newest() && frame != 0;
  const std::uint64_t place = target->frames.begun() + (again ? 0 : 1); // of the frame that is about to be recorded
  freeRetired(*target, place);
  StorageNeeds needs = target->storage.needs;
  needs.nodeCapacity = wantedCapacity(target->growth, target->context->limits, target->info, needs.nodeCapacity,
                                      [&](VitrailStats& stats) { return readNewest(*target, number, stats); });
  if (needs.nodeCapacity == target->storage.needs.nodeCapacity) return VITRAIL_SUCCESS;
  const VitrailResult result = replaceStorage(*target, target->info, needs);
  if (result != VITRAIL_SUCCESS) return result;
  target->order.drop(target->context->log, "vitrailD3d12UpdateTarget() gives the target another pool");
  freeRetired(*target, place); // at once where no frame was begun with it
  return VITRAIL_SUCCESS;
}

extern "C" VitrailResult vitrailD3d12ResizeTarget(VitrailD3d12Target target, const VitrailD3d12ResizeInfo* info) {
  using namespace vitrail;
  if (target == nullptr || info == nullptr) {
    return nullArgument(target != nullptr ? target->context : nullptr, "vitrailD3d12ResizeTarget");
  }
  const VitrailD3d12Context_T& context = *target->context;
  VitrailResult result = checkNoNext(context.log, info->next, "VitrailD3d12ResizeInfo");
  if (result != VITRAIL_SUCCESS) return result;
  if (target->hostHeap != nullptr) {
    return context.log.fail(VITRAIL_ERROR_INVALID, "a target in the host's memory cannot be resized: make another one");
  }
  TargetInfo present = target->info;
  TargetInfo larger = present; // as far as the budget is concerned
  larger.width = info->width;
  larger.height = info->height;
  present = underBudget(present, target->memoryBudget, bytesBeside(larger, target->colorFormat));
  TargetInfo wanted = resized(present, target->storage.needs.nodeCapacity, info->width, info->height,
                              info->nodeCapacity, info->areaPixels);
  result = checkTarget(context.limits, context.log, wanted);
  if (result == VITRAIL_SUCCESS) result = checkTextures(context.log, wanted, target->colorFormat, info->views);
  if (result != VITRAIL_SUCCESS) return result;
  wanted.nodeCapacity = capacityWithin(context.limits, wanted);
  const auto views = target->views;
  const std::uint32_t viewCount = target->viewCount;
  keepViewsOf(target->views, info->views);
  target->viewCount = info->views.count;
  result = replaceStorage(*target, wanted, storageNeeds(context.limits, wanted));
  if (result != VITRAIL_SUCCESS) {
    target->views = views;
    target->viewCount = viewCount;
    return result;
  }
  target->order.drop(context.log, "vitrailD3d12ResizeTarget()");
  target->info = wanted;
  target->growth.forget();
  freeRetired(*target, target->frames.begun());
  return VITRAIL_SUCCESS;
}

extern "C" VitrailResolve vitrailD3d12TargetResolve(VitrailD3d12Target target) {
  return target != nullptr ? target->info.resolve : VITRAIL_RESOLVE_DEFAULT;
}

extern "C" VitrailListBuild vitrailD3d12TargetListBuild(VitrailD3d12Target target) {
  return target != nullptr ? target->info.listBuild : VITRAIL_LIST_BUILD_DEFAULT;
}

extern "C" uint64_t vitrailD3d12TargetFrame(VitrailD3d12Target target) {
  return target != nullptr ? target->frames.newest() : 0;
}

extern "C" void vitrailD3d12TargetMemory(VitrailD3d12Target target, VitrailMemory* memory) {
  if (memory != nullptr) vitrail::clearKeepingNext(*memory);
  if (target == nullptr || memory == nullptr) {
    vitrail::nullArgument(target != nullptr ? target->context : nullptr, "vitrailD3d12TargetMemory");
    return;
  }
  std::uint64_t retired = 0;
  for (const vitrail::D3d12Storage& storage : target->retired) retired += storage.bytes();
  const vitrail::D3d12Storage& storage = target->storage;
  const std::uint64_t beside =
      vitrail::statisticsBytes(target->info.framesInFlight) + vitrail::bytesBeside(target->info, target->colorFormat);
  vitrail::tellMemory(*memory, storage.needs, storage.layout, beside, retired);
}

extern "C" uint64_t vitrailD3d12CopySize(VitrailD3d12Target target, uint32_t width, uint32_t height) {
  if (target == nullptr) return 0;
  return vitrail::copyBytes(std::uint64_t{width} * height, target->info.copyLayers);
}

extern "C" void vitrailD3d12TilePlanTarget(VitrailTilePlan plan, VitrailD3d12TargetDesc* desc) {
  vitrail::tilePlanTarget(plan, desc);
}

extern "C" VitrailResult vitrailD3d12ReadStats(VitrailD3d12Target target, uint64_t frame, VitrailStats* stats) {
  using namespace vitrail;
  if (target == nullptr || stats == nullptr) {
    if (stats != nullptr) clearKeepingNext(*stats);
    return nullArgument(target != nullptr ? target->context : nullptr, "vitrailD3d12ReadStats");
  }
  const bool newest = frame == 0 && !target->frames.areGiven();
  const bool read = newest ? readNewest(*target, target->frames.newest(), *stats) : readFrame(*target, frame, *stats);
  return read ? VITRAIL_SUCCESS : VITRAIL_INCOMPLETE;
}
