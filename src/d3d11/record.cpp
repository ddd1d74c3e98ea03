// Records the passes of a frame plan.
#include <algorithm>
#include <cstddef>
#include <cstring>

#include "core/parameters.h"
#include "state.h"
#include "target.h"

namespace vitrail {

namespace {

// ---- Transfers

void fill(ID3D11DeviceContext* commands, const D3d11Part& part, UINT value) {
  const std::array<UINT, 4> values = {value, value, value, value};
  commands->ClearUnorderedAccessViewUint(part.written.get(), values.data());
}

void copy(ID3D11DeviceContext* commands, ID3D11Resource* to, std::size_t toOffset, ID3D11Resource* from,
          std::size_t first, std::size_t bytes) {
  const D3D11_BOX box{static_cast<UINT>(first), 0, 0, static_cast<UINT>(first + bytes), 1, 1};
  commands->CopySubresourceRegion(to, 0, static_cast<UINT>(toOffset), 0, 0, from, 0, &box);
}

void clear(VitrailD3d11Target_T& target, ID3D11DeviceContext* commands) {
  const D3d11Storage& storage = target.storage;
  const layout::VitrailParameters parameters = parametersOf(
      target.info, storage.needs.nodeCapacity, {0, storage.wholeByBinding}, target.area, target.frames.newest());
  commands->UpdateSubresource(storage.parameters.get(), 0, nullptr, &parameters, 0, 0);
  const std::array<std::uint32_t, 4> number = {parameters.frame};
  commands->UpdateSubresource(target.begun.get(), 0, nullptr, number.data(), 0, 0);
  fill(commands, storage.heads(), layout::VITRAIL_END);
  fill(commands, storage.control(), 0);
  if (target.info.keepsSums() && target.sums.begin(target.slots)) fill(commands, storage.sums(), 0);
  target.slots[target.slotOf(target.frames.newest())].tag = 0; // the slot's old frame is gone
}

void copyStatistics(const VitrailD3d11Target_T& target, ID3D11DeviceContext* commands) {
  ID3D11Buffer* slot = target.statsBuffers[target.slotOf(target.frames.newest())].get();
  copy(commands, slot, 0, target.storage.control().buffer.get(), 0, sizeof(layout::VitrailControl));
  copy(commands, slot, offsetof(StatsSlot, begunFrame), target.begun.get(), 0, sizeof(StatsSlot::begunFrame));
}

void finishStatistics(VitrailD3d11Target_T& target, ID3D11DeviceContext* commands) {
  const std::uint64_t frame = target.frames.newest();
  D3d11Stamp stamp{};
  stamp.facts = {target.storage.needs.nodeCapacity, target.order.misused() ? 1U : 0U, target.sums.fact()};
  stamp.tag = frame + 1;
  commands->UpdateSubresource(target.stamp.get(), 0, nullptr, &stamp, 0, 0);
  const std::size_t number = target.slotOf(frame);
  ID3D11Buffer* slot = target.statsBuffers[number].get();
  copy(commands, slot, offsetof(StatsSlot, facts), target.stamp.get(), offsetof(D3d11Stamp, facts), sizeof(FrameFacts));
  copy(commands, slot, offsetof(StatsSlot, tag), target.stamp.get(), offsetof(D3d11Stamp, tag), sizeof(StatsSlot::tag));
  commands->End(target.statsWritten[number].get());
  target.statsExpected[number] = stamp.tag;
}

void beginCopy(const VitrailD3d11Target_T& target, ID3D11DeviceContext* commands, const VitrailRect& area) {
  layout::VitrailCopyHeader header{};
  header.capacity = target.info.copyLayers;
  header.x = area.x;
  header.y = area.y;
  header.width = area.width;
  header.height = area.height;
  const D3D11_BOX box{0, 0, 0, sizeof(header), 1, 1};
  commands->UpdateSubresource(target.storage.copy().buffer.get(), 0, &box, &header, 0, 0);
}

void finishCopy(const VitrailD3d11Target_T& target, ID3D11DeviceContext* commands, const D3d11CallInfo& info) {
  const std::uint64_t pixels = std::uint64_t{info.copied.width} * info.copied.height;
  copy(commands, info.copyBuffer, info.copyOffset, target.storage.copy().buffer.get(), 0,
       copyBytes(pixels, target.info.copyLayers));
}

// A resolve of one sample reads what it writes: from a copy of the area.
void copyBehind(const VitrailD3d11Target_T& target, ID3D11DeviceContext* commands, std::uint32_t number) {
  if (!target.behind) return;
  Com<ID3D11Resource> picture;
  target.views.at(number).color->GetResource(picture.out());
  const VitrailRect& area = target.area;
  const D3D11_BOX box{area.x, area.y, 0, area.x + area.width, area.y + area.height, 1};
  commands->CopySubresourceRegion(target.behind.get(), 0, area.x, area.y, 0, picture.get(), 0, &box);
}

// ---- Compute

std::array<ID3D11Buffer*, kKernelConstants> constantsOf(const VitrailD3d11Target_T& target) {
  return {target.storage.parameters.get(), target.constants.get()};
}

void bindCompute(const VitrailD3d11Target_T& target, ID3D11DeviceContext* commands, bool images, std::uint32_t number) {
  std::array<ID3D11UnorderedAccessView*, VITRAIL_BINDINGS> views{};
  std::array<ID3D11ShaderResourceView*, VITRAIL_VIEW_BINDINGS> resources{};
  for (std::uint32_t i = 0; i < VITRAIL_BINDINGS; ++i) views.at(i) = target.storage.parts.at(i).written.get();
  static_assert(VITRAIL_BINDING_PARAMETERS == 0 && VITRAIL_VIEW_BINDING_COLOR == 0, "the image has what is free");
  if (images && number < target.viewCount) {
    const D3d11View& view = target.views.at(number);
    views[VITRAIL_VIEW_BINDING_COLOR] = view.color;
    resources[VITRAIL_VIEW_BINDING_OPAQUE] = target.behind ? target.behindView.get() : view.opaque;
    resources[VITRAIL_VIEW_BINDING_DEPTH] = view.depth;
  }
  std::array<UINT, VITRAIL_BINDINGS> counters{};
  counters.fill(D3D11_KEEP_UNORDERED_ACCESS_VIEWS);
  const auto constants = constantsOf(target);
  commands->CSSetConstantBuffers(0, countOf(constants), constants.data());
  commands->CSSetShaderResources(0, countOf(resources), resources.data());
  commands->CSSetUnorderedAccessViews(0, countOf(views), views.data(), counters.data());
}

std::uint32_t groupsFor(std::uint32_t pixels) { return (pixels + kGroupSide - 1) / kGroupSide; }

void copyArguments(const VitrailD3d11Target_T& target, ID3D11DeviceContext* commands) {
  copy(commands, target.storage.arguments.get(), 0, target.storage.control().buffer.get(), 0,
       sizeof(layout::VitrailControl));
}

void dispatch(const VitrailD3d11Target_T& target, ID3D11DeviceContext* commands, const Pass& pass,
              const D3d11CallInfo& info) {
  switch (pass.extent) {
    case Extent::None:
      break;
    case Extent::One:
      commands->Dispatch(1, 1, 1);
      break;
    case Extent::Nodes:
      commands->Dispatch(nodeGroups(target.storage.needs.nodeCapacity), 1, 1);
      break;
    case Extent::Heads:
      commands->Dispatch(nodeGroups(target.area.width * target.area.height), 1, 1);
      break;
    case Extent::Copied:
      commands->Dispatch(groupsFor(info.copied.width), groupsFor(info.copied.height), 1);
      break;
    case Extent::Indirect:
      copyArguments(target, commands);
      commands->DispatchIndirect(target.storage.arguments.get(), pass.arguments);
      break;
  }
}

// ---- Draws

void bindDraw(const VitrailD3d11Target_T& target, ID3D11DeviceContext* commands, std::uint32_t number) {
  const D3d11Storage& storage = target.storage;
  std::array<ID3D11ShaderResourceView*, SavedDraw::kResources> resources{};
  if (number < target.viewCount) {
    resources[VITRAIL_VIEW_BINDING_OPAQUE] = target.views.at(number).opaque;
    resources[VITRAIL_VIEW_BINDING_DEPTH] = target.views.at(number).depth;
  }
  constexpr std::array<std::uint32_t, 3> kRead = {VITRAIL_BINDING_HEADS, VITRAIL_BINDING_NODES, VITRAIL_BINDING_SUMS};
  for (const std::uint32_t i : kRead) {
    resources.at(kPixelBufferSlot + i) = storage.parts.at(i).read.get();
  }
  const auto constants = constantsOf(target);
  ID3D11UnorderedAccessView* const counters = storage.control().written.get();
  commands->PSSetConstantBuffers(0, countOf(constants), constants.data());
  setPixelViews(commands, kPixelCounterSlot, 1, &counters);
  commands->PSSetShaderResources(0, countOf(resources), resources.data());
}

void setDrawState(const VitrailD3d11Target_T& target, ID3D11DeviceContext* commands) {
  const VitrailRect& area = target.area;
  const D3D11_VIEWPORT viewport{static_cast<FLOAT>(area.x),
                                static_cast<FLOAT>(area.y),
                                static_cast<FLOAT>(area.width),
                                static_cast<FLOAT>(area.height),
                                0.0F,
                                1.0F};
  const D3D11_RECT scissor{static_cast<LONG>(area.x), static_cast<LONG>(area.y), static_cast<LONG>(area.x + area.width),
                           static_cast<LONG>(area.y + area.height)};
  constexpr std::array<FLOAT, 4> kFactor{};
  commands->IASetInputLayout(nullptr);
  commands->IASetPrimitiveTopology(D3D11_PRIMITIVE_TOPOLOGY_TRIANGLELIST);
  commands->VSSetShader(target.context->triangle.get(), nullptr, 0);
  commands->HSSetShader(nullptr, nullptr, 0);
  commands->DSSetShader(nullptr, nullptr, 0);
  commands->GSSetShader(nullptr, nullptr, 0);
  commands->RSSetState(target.rasterizing.get());
  commands->RSSetViewports(1, &viewport);
  commands->RSSetScissorRects(1, &scissor);
  commands->OMSetBlendState(target.blending.get(), kFactor.data(), 0xffffffffU);
  commands->OMSetDepthStencilState(target.testing.get(), 0);
}

bool runsShaders(const Pass& pass) {
  return pass.action == Action::Dispatch || pass.action == Action::Draw || pass.action == Action::DrawPlain;
}

void runTransfer(VitrailD3d11Target_T& target, ID3D11DeviceContext* commands, const Pass& pass,
                 const D3d11CallInfo& info) {
  switch (pass.action) {
    case Action::Clear:
      return clear(target, commands);
    case Action::BeginCopy:
      return beginCopy(target, commands, info.copied);
    case Action::FinishCopy:
      return finishCopy(target, commands, info);
    case Action::CopyStatistics:
      return copyStatistics(target, commands);
    case Action::FinishStatistics:
      return finishStatistics(target, commands);
    default:
      break;
  }
}

// Runs of passes of one kind share what they save.
void runDispatches(const VitrailD3d11Target_T& target, ID3D11DeviceContext* commands, std::size_t first,
                   std::size_t end, const D3d11CallInfo& info) {
  const bool images = target.plan.passes()[first].call == Call::Resolve;
  if (images) copyBehind(target, commands, info.view);
  const SavedCompute saved(commands);
  bindCompute(target, commands, images, info.view);
  for (std::size_t i = first; i < end; ++i) {
    commands->CSSetShader(target.shaders[i].compute.get(), nullptr, 0);
    dispatch(target, commands, target.plan.passes()[i], info);
  }
}

void runDraws(const VitrailD3d11Target_T& target, ID3D11DeviceContext* commands, std::size_t first, std::size_t end,
              const D3d11CallInfo& info) {
  copyArguments(target, commands);
  const SavedDraw saved(commands, target.context->uavSlots);
  bindDraw(target, commands, info.view);
  setDrawState(target, commands);
  for (std::size_t i = first; i < end; ++i) {
    commands->PSSetShader(target.shaders[i].pixel.get(), nullptr, 0);
    commands->DrawInstancedIndirect(target.storage.arguments.get(), target.plan.passes()[i].arguments);
  }
}

} // namespace

void runCall(VitrailD3d11Target_T& target, ID3D11DeviceContext* commands, Call call, const D3d11CallInfo& info) {
  const std::vector<Pass>& passes = target.plan.passes();
  const SavedPredication predication(commands);
  for (std::size_t i = 0; i < passes.size();) {
    const bool dispatches = passes[i].action == Action::Dispatch;
    if (passes[i].call != call || !runsShaders(passes[i])) {
      if (passes[i].call == call) runTransfer(target, commands, passes[i], info);
      ++i;
      continue;
    }
    std::size_t end = i + 1;
    while (end < passes.size() && passes[end].call == call && runsShaders(passes[end]) &&
           (passes[end].action == Action::Dispatch) == dispatches) {
      ++end;
    }
    if (dispatches) {
      runDispatches(target, commands, i, end, info);
    } else {
      runDraws(target, commands, i, end, info);
    }
    i = end;
  }
}

void fetchStats(VitrailD3d11Target_T& target, ID3D11DeviceContext* immediate, std::size_t slot, bool flush) {
  if (target.statsExpected[slot] == 0) return;
  // Asked before it is mapped: Wine maps as if it might wait.
  const UINT flags = flush ? 0U : UINT{D3D11_ASYNC_GETDATA_DONOTFLUSH};
  if (immediate->GetData(target.statsWritten[slot].get(), nullptr, 0, flags) != S_OK) return;
  D3D11_MAPPED_SUBRESOURCE mapped{};
  ID3D11Buffer* buffer = target.statsBuffers[slot].get();
  if (FAILED(immediate->Map(buffer, 0, D3D11_MAP_READ, D3D11_MAP_FLAG_DO_NOT_WAIT, &mapped))) return;
  StatsSlot read{};
  std::memcpy(&read, mapped.pData, sizeof(read));
  immediate->Unmap(buffer, 0);
  if (read.tag != target.statsExpected[slot]) return; // of a command list that has not run yet
  target.slots[slot] = read;
  target.statsExpected[slot] = 0;
}

} // namespace vitrail
