// The calls of a frame.
#include "core/frame_start.h"
#include "core/parameters.h"
#include "target.h"

namespace vitrail {

namespace {

constexpr const char* kPrefix = "vitrailD3d12";

// Whether a call has a command list that can do what it is for; logs why not.
bool isUsable(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands) {
  if (commands == nullptr) {
    target->context->log.error("a call of the frame is given no command list: nothing is recorded");
  } else if (commands->GetType() != D3D12_COMMAND_LIST_TYPE_DIRECT) {
    target->context->log.error(
        "a call of the frame is given a command list of type %d: frames are recorded into lists of type DIRECT",
        static_cast<int>(commands->GetType()));
  } else {
    return true;
  }
  target->order.setMisused();
  return false;
}

bool allows(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands, Call call) {
  return isUsable(target, commands) && target->order.allows(call, target->context->log, kPrefix);
}

bool nextIsNull(VitrailD3d12Target target, const void* next, const char* structure) {
  if (checkNoNext(target->context->log, next, structure) == VITRAIL_SUCCESS) return true;
  target->order.setMisused();
  return false;
}

// Starts the frame on the host's side: its number, its memory, its area.
void beginFrame(VitrailD3d12Target_T& target, const VitrailD3d12BeginInfo& info, bool open) {
  if (startFrame(target.frames, target.order, target.growth, target.context->log, info.frame,
                 open)) { // a second time: the first one was never executed
    for (D3d12Storage& storage : target.retired) storage.use.drop(target.frames.begun());
  }
  if (open) forgetRecorded(target.storage); // the log says that it is taken to be dropped
  target.storage.use.add(target.frames.begun());
  freeRetired(target, target.frames.begun());
  bool whole = true;
  target.area =
      areaOfFrame(target.info, target.context->log, info.area.x, info.area.y, info.area.width, info.area.height, whole);
  if (!whole) target.order.setMisused();
}

// The view to resolve to.
std::uint32_t viewOf(VitrailD3d12Target_T& target, const VitrailD3d12ResolveInfo* info) {
  const std::uint32_t view = info != nullptr ? info->view : 0;
  if (view == 0 || view < target.viewCount) return view;
  target.context->log.warn("view %u is resolved, the target has %u: view 0 is taken", view, target.viewCount);
  target.order.setMisused();
  return 0;
}

constexpr std::uint32_t kCollected[] = {VITRAIL_BINDING_CONTROL, VITRAIL_BINDING_HEADS, VITRAIL_BINDING_NODES,
                                        VITRAIL_BINDING_SUMS};
constexpr std::uint32_t kWalked[] = {VITRAIL_BINDING_CONTROL, VITRAIL_BINDING_HEADS, VITRAIL_BINDING_NODES};
static_assert(VITRAIL_D3D12_COLLECT_DESCRIPTORS == 1 + std::size(kCollected));
static_assert(VITRAIL_D3D12_LIST_DESCRIPTORS == std::size(kWalked));

} // namespace

} // namespace vitrail

extern "C" void vitrailD3d12Begin(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands,
                                  const VitrailD3d12BeginInfo* info) {
  using namespace vitrail;
  if (target == nullptr || !isUsable(target, commands)) return;
  const bool open = target->order.begun();
  target->order.allows(Call::Begin, target->context->log, kPrefix);
  const VitrailD3d12BeginInfo given = info != nullptr ? *info : VitrailD3d12BeginInfo{};
  nextIsNull(target, given.next, "VitrailD3d12BeginInfo");
  beginFrame(*target, given, open);
  recordCall(*target, commands, Call::Begin);
}

extern "C" void vitrailD3d12Bind(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands,
                                 uint32_t firstParameter) {
  using namespace vitrail;
  if (target == nullptr || commands == nullptr) return;
  const D3d12Storage& storage = target->storage;
  const auto& layout = storage.layout;
  commands->SetGraphicsRootConstantBufferView(firstParameter, storage.address(D3d12Part::Constants));
  commands->SetGraphicsRootUnorderedAccessView(firstParameter + 1, storage.address(D3d12Part::Control));
  commands->SetGraphicsRootUnorderedAccessView(firstParameter + 2, storage.addressOf(layout.heads));
  commands->SetGraphicsRootUnorderedAccessView(firstParameter + 3, storage.addressOf(layout.nodes));
  commands->SetGraphicsRootUnorderedAccessView(firstParameter + 4, storage.addressOf(layout.sums));
}

extern "C" void vitrailD3d12WriteDescriptors(VitrailD3d12Target target, uint64_t handle) {
  using namespace vitrail;
  if (target == nullptr || handle == 0) return;
  const VitrailD3d12Context_T& context = *target->context;
  D3D12_CPU_DESCRIPTOR_HANDLE place{};
  place.ptr = static_cast<decltype(place.ptr)>(handle);
  D3D12_CONSTANT_BUFFER_VIEW_DESC parameters{};
  parameters.BufferLocation = target->storage.address(D3d12Part::Constants);
  parameters.SizeInBytes = kArgumentsOffset; // a multiple of 256
  context.device->CreateConstantBufferView(&parameters, place);
  for (const std::uint32_t binding : kCollected) {
    place.ptr += context.descriptorBytes;
    writeBufferView(context, target->storage, binding, true, place);
  }
  for (const std::uint32_t binding : kWalked) {
    place.ptr += context.descriptorBytes;
    writeBufferView(context, target->storage, binding, false, place);
  }
}

extern "C" void vitrailD3d12Collected(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands) {
  using namespace vitrail;
  if (target == nullptr || !allows(target, commands, Call::Collected)) return;
  recordCall(*target, commands, Call::Collected);
}

extern "C" void vitrailD3d12BindLists(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands,
                                      uint32_t firstParameter, uint32_t compute) {
  using namespace vitrail;
  if (target == nullptr || commands == nullptr) return;
  recordReadable(*target, commands);
  if (firstParameter == VITRAIL_D3D12_NO_PARAMETER) return;
  const D3d12Storage& storage = target->storage;
  const std::uint64_t parameters = storage.address(D3d12Part::Constants);
  const std::uint64_t buffers[] = {storage.address(D3d12Part::Control), storage.addressOf(storage.layout.heads),
                                   storage.addressOf(storage.layout.nodes)};
  if (compute != 0) {
    commands->SetComputeRootConstantBufferView(firstParameter, parameters);
    for (const std::uint64_t buffer : buffers) commands->SetComputeRootShaderResourceView(++firstParameter, buffer);
  } else {
    commands->SetGraphicsRootConstantBufferView(firstParameter, parameters);
    for (const std::uint64_t buffer : buffers) commands->SetGraphicsRootShaderResourceView(++firstParameter, buffer);
  }
}

extern "C" void vitrailD3d12UnbindLists(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands) {
  if (target == nullptr || commands == nullptr) return;
  vitrail::recordReady(*target, commands);
}

extern "C" void vitrailD3d12CopyLists(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands,
                                      const VitrailD3d12CopyInfo* info) {
  using namespace vitrail;
  if (target == nullptr || !allows(target, commands, Call::CopyLists)) return;
  if (info == nullptr) {
    nullArgument(target->context, "vitrailD3d12CopyLists");
    return target->order.setMisused();
  }
  if (!nextIsNull(target, info->next, "VitrailD3d12CopyInfo")) return;
  const CopyRequest request{
      info->area.x, info->area.y, info->area.width,      info->area.height, info->buffer != nullptr,
      info->offset, info->size,   "vitrailD3d12CopySize"};
  if (!canCopy(target->context->log, kPrefix, target->info, target->area, request))
    return target->order.setMisused(); // what is in the host's buffer is of another frame
  D3d12CallInfo call;
  call.copied = info->area;
  call.copyBuffer = info->buffer;
  call.copyOffset = info->offset;
  recordCall(*target, commands, Call::CopyLists, call);
}

extern "C" void vitrailD3d12Resolve(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands,
                                    const VitrailD3d12ResolveInfo* info) {
  using namespace vitrail;
  if (target == nullptr || !allows(target, commands, Call::Resolve)) return;
  if (info != nullptr) nextIsNull(target, info->next, "VitrailD3d12ResolveInfo");
  D3d12CallInfo call;
  call.view = viewOf(*target, info);
  if (target->area.width == 0) return; // nothing of the picture is in the area
  recordCall(*target, commands, Call::Resolve, call);
  if (target->info.resolve == VITRAIL_RESOLVE_COMPUTE) target->sums.cleaned();
}

extern "C" void vitrailD3d12End(VitrailD3d12Target target, ID3D12GraphicsCommandList* commands) {
  using namespace vitrail;
  if (target == nullptr) return;
  const bool collected = target->order.collected();
  if (!allows(target, commands, Call::End)) return;
  // The dispatch that cleans up has its arguments from the call that was to collect.
  if (target->drawsResolve() && collected) target->sums.cleaned();
  recordCall(*target, commands, Call::End);
}
