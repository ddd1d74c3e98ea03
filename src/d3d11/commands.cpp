// The calls of a frame.
#include "core/frame_start.h"
#include "core/parameters.h"
#include "state.h"
#include "target.h"

namespace vitrail {

namespace {

constexpr const char* kPrefix = "vitrailD3d11";
constexpr UINT kUavs = 4;
constexpr UINT kLists = 3;

bool allows(VitrailD3d11Target target, const ID3D11DeviceContext* commands, Call call) {
  const bool allowed = target->order.allows(call, target->context->log, kPrefix);
  if (commands != nullptr) return allowed;
  target->context->log.error("a call of the frame is given no device context: nothing is recorded");
  target->order.setMisused();
  return false;
}

bool nextIsNull(VitrailD3d11Target target, const void* next, const char* structure) {
  if (checkNoNext(target->context->log, next, structure) == VITRAIL_SUCCESS) return true;
  target->order.setMisused();
  return false;
}

// Starts the frame on the host's side: its number, its area.
void beginFrame(VitrailD3d11Target_T& target, const VitrailD3d11BeginInfo& info, bool open) {
  startFrame(target.frames, target.order, target.growth, target.context->log, info.frame, open);
  bool whole = true;
  target.area =
      areaOfFrame(target.info, target.context->log, info.area.x, info.area.y, info.area.width, info.area.height, whole);
  if (!whole) target.order.setMisused();
}

// The view to resolve to.
std::uint32_t viewOf(VitrailD3d11Target_T& target, const VitrailD3d11ResolveInfo* info) {
  const std::uint32_t view = info != nullptr ? info->view : 0;
  if (view == 0 || view < target.viewCount) return view;
  target.context->log.warn("view %u is resolved, the target has %u: view 0 is taken", view, target.viewCount);
  target.order.setMisused();
  return 0;
}

void setLists(const VitrailD3d11Target_T& target, ID3D11DeviceContext* commands, ID3D11Buffer* parameters,
              const std::array<ID3D11ShaderResourceView*, kLists>& lists) {
  const VitrailD3d11Context_T& context = *target.context;
  commands->PSSetConstantBuffers(context.constantSlot, 1, &parameters);
  commands->CSSetConstantBuffers(context.constantSlot, 1, &parameters);
  commands->PSSetShaderResources(context.listSlot, kLists, lists.data());
  commands->CSSetShaderResources(context.listSlot, kLists, lists.data());
}

} // namespace

} // namespace vitrail

extern "C" void vitrailD3d11Begin(VitrailD3d11Target target, ID3D11DeviceContext* commands,
                                  const VitrailD3d11BeginInfo* info) {
  using namespace vitrail;
  if (target == nullptr) return;
  const bool open = target->order.begun();
  const bool recorded = commands != nullptr;
  allows(target, commands, Call::Begin);
  const VitrailD3d11BeginInfo given = info != nullptr ? *info : VitrailD3d11BeginInfo{};
  nextIsNull(target, given.next, "VitrailD3d11BeginInfo");
  beginFrame(*target, given, open);
  if (!recorded) return target->order.setMisused();
  if (target->info.keepsSums() && commands->GetType() == D3D11_DEVICE_CONTEXT_IMMEDIATE) {
    for (std::size_t slot = 0; slot < target->slots.size(); ++slot) fetchStats(*target, commands, slot, false);
  }
  runCall(*target, commands, Call::Begin);
}

extern "C" void vitrailD3d11Bind(VitrailD3d11Target target, ID3D11DeviceContext* commands) {
  using namespace vitrail;
  if (target == nullptr || commands == nullptr) return;
  const D3d11Storage& storage = target->storage;
  std::array<ID3D11UnorderedAccessView*, kUavs> views{};
  for (UINT i = 0; i < kUavs; ++i) views.at(i) = storage.parts.at(VITRAIL_BINDING_CONTROL + i).written.get();
  static_assert(VITRAIL_BINDING_HEADS == VITRAIL_BINDING_CONTROL + 1 &&
                VITRAIL_BINDING_NODES == VITRAIL_BINDING_CONTROL + 2 &&
                VITRAIL_BINDING_SUMS == VITRAIL_BINDING_CONTROL + 3);
  ID3D11Buffer* const parameters = storage.parameters.get();
  commands->PSSetConstantBuffers(target->context->constantSlot, 1, &parameters);
  setPixelViews(commands, target->context->uavSlot, kUavs, views.data());
}

extern "C" void vitrailD3d11Collected(VitrailD3d11Target target, ID3D11DeviceContext* commands) {
  using namespace vitrail;
  if (target == nullptr || !allows(target, commands, Call::Collected)) return;
  constexpr std::array<ID3D11UnorderedAccessView*, kUavs> kNone{};
  setPixelViews(commands, target->context->uavSlot, kUavs, kNone.data());
  runCall(*target, commands, Call::Collected);
}

extern "C" void vitrailD3d11BindLists(VitrailD3d11Target target, ID3D11DeviceContext* commands) {
  if (target == nullptr || commands == nullptr) return;
  const vitrail::D3d11Storage& storage = target->storage;
  vitrail::setLists(
      *target, commands, storage.parameters.get(),
      {storage.control().read.get(), storage.heads().read.get(), storage.parts[VITRAIL_BINDING_NODES].read.get()});
}

extern "C" void vitrailD3d11UnbindLists(VitrailD3d11Target target, ID3D11DeviceContext* commands) {
  if (target == nullptr || commands == nullptr) return;
  vitrail::setLists(*target, commands, nullptr, {});
}

extern "C" void vitrailD3d11CopyLists(VitrailD3d11Target target, ID3D11DeviceContext* commands,
                                      const VitrailD3d11CopyInfo* info) {
  using namespace vitrail;
  if (target == nullptr || !allows(target, commands, Call::CopyLists)) return;
  if (info == nullptr) {
    nullArgument(target->context, "vitrailD3d11CopyLists");
    return target->order.setMisused();
  }
  if (!nextIsNull(target, info->next, "VitrailD3d11CopyInfo")) return;
  const CopyRequest request{
      info->area.x, info->area.y, info->area.width,      info->area.height, info->buffer != nullptr,
      info->offset, info->size,   "vitrailD3d11CopySize"};
  if (!canCopy(target->context->log, kPrefix, target->info, target->area, request))
    return target->order.setMisused(); // what is in the host's buffer is of another frame
  D3d11CallInfo call;
  call.copied = info->area;
  call.copyBuffer = info->buffer;
  call.copyOffset = info->offset;
  runCall(*target, commands, Call::CopyLists, call);
}

extern "C" void vitrailD3d11Resolve(VitrailD3d11Target target, ID3D11DeviceContext* commands,
                                    const VitrailD3d11ResolveInfo* info) {
  using namespace vitrail;
  if (target == nullptr || !allows(target, commands, Call::Resolve)) return;
  if (info != nullptr) nextIsNull(target, info->next, "VitrailD3d11ResolveInfo");
  D3d11CallInfo call;
  call.view = viewOf(*target, info);
  if (target->area.width == 0) return; // nothing of the picture is in the area
  runCall(*target, commands, Call::Resolve, call);
  if (target->info.resolve == VITRAIL_RESOLVE_COMPUTE) target->sums.cleaned();
}

extern "C" void vitrailD3d11End(VitrailD3d11Target target, ID3D11DeviceContext* commands) {
  using namespace vitrail;
  if (target == nullptr) return;
  const bool collected = target->order.collected();
  if (!allows(target, commands, Call::End)) return;
  // The dispatch that cleans up has its arguments from the call that was to collect.
  if (target->info.resolve == VITRAIL_RESOLVE_FRAGMENT && collected) target->sums.cleaned();
  runCall(*target, commands, Call::End);
}
