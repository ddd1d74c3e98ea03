// Records the passes of a frame plan. The plan's barriers become transitions where a buffer changes its state, else
// barriers of unordered access.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "core/parameters.h"
#include "target.h"

namespace vitrail {

namespace {

using State = D3D12_RESOURCE_STATES;

constexpr State kWritten = D3D12_RESOURCE_STATE_UNORDERED_ACCESS;
constexpr State kCopied = D3D12_RESOURCE_STATE_COPY_SOURCE;
constexpr State kFilled = D3D12_RESOURCE_STATE_COPY_DEST;
constexpr State either(State one, State other) {
  return static_cast<State>(static_cast<int>(one) | static_cast<int>(other));
}
constexpr State kRead =
    either(D3D12_RESOURCE_STATE_NON_PIXEL_SHADER_RESOURCE, D3D12_RESOURCE_STATE_PIXEL_SHADER_RESOURCE);
// Of the constants: parameters and arguments.
constexpr State kConstant =
    either(D3D12_RESOURCE_STATE_VERTEX_AND_CONSTANT_BUFFER, D3D12_RESOURCE_STATE_INDIRECT_ARGUMENT);

// ---- Barriers

class BarrierBatch {
 public:
  explicit BarrierBatch(D3d12Storage& storage) : storage_(storage) {}

  void transition(ID3D12Resource* resource, State before, State after) {
    D3D12_RESOURCE_BARRIER& barrier = barriers_.at(count_++);
    barrier.Type = D3D12_RESOURCE_BARRIER_TYPE_TRANSITION;
    barrier.Transition.pResource = resource;
    barrier.Transition.Subresource = 0;
    barrier.Transition.StateBefore = before;
    barrier.Transition.StateAfter = after;
  }

  // What was written is visible to what is written and read next.
  void wait(ID3D12Resource* resource) {
    D3D12_RESOURCE_BARRIER& barrier = barriers_.at(count_++);
    barrier.Type = D3D12_RESOURCE_BARRIER_TYPE_UAV;
    barrier.UAV.pResource = resource;
  }

  // The buffer is needed in that state; `hazard`: for something that waits for what was done in it before.
  void need(D3d12Part part, State state, bool hazard = false) {
    State& present = storage_.states.at(static_cast<std::uint32_t>(part));
    if (present != state) {
      transition(storage_.buffer(part), present, state);
      present = state;
    } else if (hazard && state == kWritten) {
      wait(storage_.buffer(part));
    }
  }

  void record(ID3D12GraphicsCommandList* commands) {
    if (count_ > 0) commands->ResourceBarrier(count_, barriers_.data());
    count_ = 0;
    barriers_ = {};
  }

 private:
  D3d12Storage& storage_;
  std::array<D3D12_RESOURCE_BARRIER, 6> barriers_{};
  UINT count_ = 0;
};

bool isHazard(const Barriers& barriers, Resource resource) {
  return barriers[static_cast<std::uint32_t>(resource)].after.stages != 0;
}

// Indirect commands read a copy of the counters, which kernels go on writing.
void copyArguments(D3d12Storage& storage, ID3D12GraphicsCommandList* commands) {
  if (!storage.argumentsStale) return;
  BarrierBatch barriers(storage);
  barriers.need(D3d12Part::Control, kCopied);
  barriers.need(D3d12Part::Constants, kFilled);
  barriers.record(commands);
  commands->CopyBufferRegion(storage.buffer(D3d12Part::Constants), kArgumentsOffset, storage.buffer(D3d12Part::Control),
                             0, sizeof(layout::VitrailControl));
  storage.argumentsStale = false;
}

// Whether any pass of a call has its extent from the counters.
bool readsArguments(const FramePlan& plan, Call call) {
  return std::any_of(plan.passes().begin(), plan.passes().end(),
                     [&](const Pass& pass) { return pass.call == call && pass.extent == Extent::Indirect; });
}

// ---- Words

// What words.hlsl takes.
struct Words {
  std::uint32_t count = 0;
  std::uint32_t given = 0;
  std::uint32_t value = 0;
  std::uint32_t mark = 0;
  std::array<std::uint32_t, 16> words{};
  std::array<std::uint32_t, 4> places = {UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX};
};
static_assert(sizeof(Words) == 24 * sizeof(std::uint32_t)); // root.hlsl

void beginWords(const VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands) {
  commands->SetComputeRootSignature(target.context->wordsRoot.get());
  commands->SetPipelineState(target.context->words.get());
}

void write(ID3D12GraphicsCommandList* commands, std::uint64_t address, const Words& words) {
  if (words.count == 0) return;
  commands->SetComputeRoot32BitConstants(kWordsConstants, sizeof(Words) / sizeof(std::uint32_t), &words, 0);
  commands->SetComputeRootUnorderedAccessView(kWordsBuffer, address);
  commands->Dispatch(nodeGroups(words.count), 1, 1); // of 64 threads, which take several words where there are many
}

void fill(ID3D12GraphicsCommandList* commands, std::uint64_t address, std::uint64_t bytes, std::uint32_t value) {
  Words words;
  words.count = static_cast<std::uint32_t>(bytes / sizeof(std::uint32_t));
  words.value = value;
  write(commands, address, words);
}

template <class Structure>
void give(ID3D12GraphicsCommandList* commands, std::uint64_t address, const Structure& given) {
  Words words;
  static_assert(sizeof(given) <= sizeof(words.words));
  words.count = words.given = sizeof(given) / sizeof(std::uint32_t);
  std::memcpy(words.words.data(), &given, sizeof(given));
  write(commands, address, words);
}

// Sixteen words, and of the capacities behind them the few that are not 0, which are all alike.
void giveParameters(ID3D12GraphicsCommandList* commands, std::uint64_t address,
                    const layout::VitrailParameters& parameters) {
  constexpr std::uint32_t kGiven = offsetof(layout::VitrailParameters, capacities) / sizeof(std::uint32_t);
  std::array<std::uint32_t, sizeof(parameters) / sizeof(std::uint32_t)> all{};
  std::memcpy(all.data(), &parameters, sizeof(parameters));
  Words words;
  static_assert(kGiven == 16);
  words.count = countOf(all);
  words.given = kGiven;
  std::copy_n(all.begin(), kGiven, words.words.begin());
  std::size_t places = 0;
  for (std::uint32_t i = kGiven; i < all.size(); ++i) {
    if (all.at(i) == 0) continue;
    words.mark = all.at(i);
    words.places.at(places++) = i;
  }
  write(commands, address, words);
}

// ---- Transfers

void copyToStatistics(const VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, std::size_t at,
                      D3d12Part from, std::uint64_t first, std::uint64_t bytes) {
  commands->CopyBufferRegion(target.stats.get(), target.slotOffset() + at, target.storage.buffer(from), first, bytes);
}

void clear(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, bool hazard) {
  D3d12Storage& storage = target.storage;
  const layout::VitrailParameters parameters = parametersOf(
      target.info, storage.needs.nodeCapacity, {0, storage.wholeByBinding}, target.area, target.frames.newest());
  BarrierBatch barriers(storage);
  barriers.need(D3d12Part::Constants, kWritten, true);
  barriers.need(D3d12Part::Control, kWritten, hazard);
  barriers.need(D3d12Part::Lists, kWritten, hazard);
  barriers.record(commands);
  const std::uint64_t constants = storage.address(D3d12Part::Constants);
  beginWords(target, commands);
  giveParameters(commands, constants, parameters);
  give(commands, constants + kStampOffset, D3d12Stamp{});
  fill(commands, storage.address(D3d12Part::Control), sizeof(layout::VitrailControl), 0);
  fill(commands, storage.addressOf(storage.layout.heads), headBytes(parameters.width * parameters.height),
       layout::VITRAIL_END);
  if (target.info.keepsSums() && target.sums.begin(target.slots())) {
    fill(commands, storage.addressOf(storage.layout.sums), storage.layout.sums.size, 0);
  }
  storage.argumentsStale = true;
  barriers.need(D3d12Part::Constants, kCopied);
  barriers.record(commands);
  // The slot's old frame is gone.
  copyToStatistics(target, commands, offsetof(StatsSlot, tag), D3d12Part::Constants,
                   kStampOffset + offsetof(D3d12Stamp, tag), sizeof(StatsSlot::tag));
}

void copyStatistics(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands) {
  D3d12Storage& storage = target.storage;
  D3d12Stamp stamp{}; // without the tag
  stamp.facts = {storage.needs.nodeCapacity, target.order.misused() ? 1U : 0U, target.sums.fact()};
  static_assert(sizeof(stamp.facts) == sizeof(FrameFacts) && offsetof(FrameFacts, misused) == 4 &&
                offsetof(FrameFacts, sumsCleared) == 8);
  BarrierBatch barriers(storage);
  barriers.need(D3d12Part::Constants, kWritten, true);
  barriers.record(commands);
  beginWords(target, commands);
  give(commands, storage.address(D3d12Part::Constants) + kStampOffset, stamp);
  barriers.need(D3d12Part::Constants, kCopied);
  barriers.need(D3d12Part::Control, kCopied);
  barriers.record(commands);
  copyToStatistics(target, commands, 0, D3d12Part::Control, 0, sizeof(layout::VitrailControl));
  copyToStatistics(target, commands, offsetof(StatsSlot, begunFrame), D3d12Part::Constants,
                   offsetof(layout::VitrailParameters, frame), sizeof(StatsSlot::begunFrame));
  copyToStatistics(target, commands, offsetof(StatsSlot, facts), D3d12Part::Constants,
                   kStampOffset + offsetof(D3d12Stamp, facts), sizeof(FrameFacts));
}

// The tag comes after what it vouches for: it is written when the copies have been made, and copied then.
void finishStatistics(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands) {
  D3d12Storage& storage = target.storage;
  const std::uint64_t tag = target.frames.newest() + 1;
  const std::array<std::uint32_t, 2> words = {static_cast<std::uint32_t>(tag), static_cast<std::uint32_t>(tag >> 32U)};
  constexpr std::uint64_t kTag = kStampOffset + offsetof(D3d12Stamp, tag);
  BarrierBatch barriers(storage);
  barriers.need(D3d12Part::Constants, kWritten);
  barriers.record(commands);
  beginWords(target, commands);
  give(commands, storage.address(D3d12Part::Constants) + kTag, words);
  barriers.need(D3d12Part::Constants, kCopied);
  barriers.record(commands);
  copyToStatistics(target, commands, offsetof(StatsSlot, tag), D3d12Part::Constants, kTag, sizeof(words));
}

void beginCopy(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, const VitrailRect& area,
               bool hazard) {
  layout::VitrailCopyHeader header{};
  header.capacity = target.info.copyLayers;
  header.x = area.x;
  header.y = area.y;
  header.width = area.width;
  header.height = area.height;
  BarrierBatch barriers(target.storage);
  barriers.need(D3d12Part::Lists, kWritten, hazard);
  barriers.need(D3d12Part::Control, kWritten, hazard);
  barriers.record(commands);
  beginWords(target, commands);
  give(commands, target.storage.addressOf(target.storage.layout.copy), header);
}

void finishCopy(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, const D3d12CallInfo& info) {
  D3d12Storage& storage = target.storage;
  BarrierBatch barriers(storage);
  barriers.need(D3d12Part::Lists, kCopied);
  barriers.record(commands);
  const std::uint64_t pixels = std::uint64_t{info.copied.width} * info.copied.height;
  commands->CopyBufferRegion(info.copyBuffer, info.copyOffset, storage.buffer(D3d12Part::Lists),
                             offsetInLists(storage.layout, storage.layout.copy),
                             copyBytes(pixels, target.info.copyLayers));
}

// A resolve of one sample reads what it writes: from a copy of the area.
void copyBehind(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, ID3D12Resource* picture) {
  D3d12Storage& storage = target.storage;
  ID3D12Resource* behind = storage.behind.get();
  if (behind == nullptr) return;
  BarrierBatch barriers(storage);
  barriers.transition(picture, kWritten, kCopied);
  barriers.transition(behind, D3D12_RESOURCE_STATE_NON_PIXEL_SHADER_RESOURCE, kFilled);
  barriers.record(commands);
  const VitrailRect& area = target.area;
  const D3D12_BOX box{area.x, area.y, 0, area.x + area.width, area.y + area.height, 1};
  D3D12_TEXTURE_COPY_LOCATION to{};
  to.pResource = behind;
  to.Type = D3D12_TEXTURE_COPY_TYPE_SUBRESOURCE_INDEX;
  D3D12_TEXTURE_COPY_LOCATION from = to;
  from.pResource = picture;
  commands->CopyTextureRegion(&to, area.x, area.y, 0, &from, &box);
  barriers.transition(picture, kCopied, kWritten);
  barriers.transition(behind, kFilled, D3D12_RESOURCE_STATE_NON_PIXEL_SHADER_RESOURCE);
  barriers.record(commands);
}

// ---- Compute

D3D12_GPU_DESCRIPTOR_HANDLE tableOf(const VitrailD3d12Target_T& target, std::uint32_t number) {
  const D3d12Storage& storage = target.storage;
  D3D12_GPU_DESCRIPTOR_HANDLE place = storage.heap->GetGPUDescriptorHandleForHeapStart();
  place.ptr += std::uint64_t{storage.first + number} * target.context->descriptorBytes;
  return place;
}

void setHeap(const D3d12Storage& storage, ID3D12GraphicsCommandList* commands) {
  if (!storage.ownHeap) return;
  ID3D12DescriptorHeap* heap = storage.heap.get();
  commands->SetDescriptorHeaps(1, &heap);
}

void bindCompute(const VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, std::uint32_t view) {
  const D3d12Storage& storage = target.storage;
  setHeap(storage, commands);
  commands->SetComputeRootSignature(target.context->computeRoot.get());
  commands->SetComputeRootConstantBufferView(kComputeParameters, storage.address(D3d12Part::Constants));
  commands->SetComputeRoot32BitConstants(kComputeConstants, sizeof(KernelConstants) / sizeof(std::uint32_t),
                                         &target.constants, 0);
  commands->SetComputeRootDescriptorTable(kComputeBuffers, tableOf(target, 0));
  commands->SetComputeRootDescriptorTable(kComputeImages,
                                          tableOf(target, kBufferDescriptors + view * VITRAIL_VIEW_BINDINGS));
}

std::uint32_t groupsFor(std::uint32_t pixels) { return (pixels + kGroupSide - 1) / kGroupSide; }

void dispatch(const VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, const Pass& pass,
              const D3d12CallInfo& info) {
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
      commands->ExecuteIndirect(target.context->dispatches.get(), 1, target.storage.buffer(D3d12Part::Constants),
                                kArgumentsOffset + pass.arguments, nullptr, 0);
      break;
  }
}

void recordDispatch(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, std::size_t number, bool hazard,
                    const D3d12CallInfo& info) {
  const Pass& pass = target.plan.passes()[number];
  D3d12Storage& storage = target.storage;
  if (pass.extent == Extent::Indirect) copyArguments(storage, commands);
  BarrierBatch barriers(storage);
  barriers.need(D3d12Part::Constants, kConstant);
  barriers.need(D3d12Part::Control, kWritten, hazard);
  barriers.need(D3d12Part::Lists, kWritten, hazard);
  if (isHazard(pass.before, Resource::Picture)) barriers.wait(target.views.at(info.view).color);
  barriers.record(commands);
  bindCompute(target, commands, info.view);
  commands->SetPipelineState(target.pipelines[number].get());
  dispatch(target, commands, pass, info);
  storage.argumentsStale = true;
}

// ---- Draws

void bindDraw(const VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, std::uint32_t view) {
  const D3d12Storage& storage = target.storage;
  setHeap(storage, commands);
  commands->SetGraphicsRootSignature(target.context->drawRoot.get());
  commands->SetGraphicsRootConstantBufferView(kDrawParameters, storage.address(D3d12Part::Constants));
  commands->SetGraphicsRoot32BitConstants(kDrawConstants, sizeof(KernelConstants) / sizeof(std::uint32_t),
                                          &target.constants, 0);
  commands->SetGraphicsRootUnorderedAccessView(kDrawCounters, storage.address(D3d12Part::Control));
  commands->SetGraphicsRootShaderResourceView(kDrawHeads, storage.addressOf(storage.layout.heads));
  commands->SetGraphicsRootShaderResourceView(kDrawNodes, storage.addressOf(storage.layout.nodes));
  commands->SetGraphicsRootShaderResourceView(kDrawSums, storage.addressOf(storage.layout.sums));
  commands->SetGraphicsRootDescriptorTable(
      kDrawImages, tableOf(target, kBufferDescriptors + view * VITRAIL_VIEW_BINDINGS + VITRAIL_VIEW_BINDING_OPAQUE));
}

// No barrier: the call before has made the lists readable.
void recordDraw(const VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, std::size_t number,
                const D3d12CallInfo& info) {
  const VitrailRect& area = target.area;
  const D3D12_VIEWPORT viewport{static_cast<FLOAT>(area.x),
                                static_cast<FLOAT>(area.y),
                                static_cast<FLOAT>(area.width),
                                static_cast<FLOAT>(area.height),
                                0.0F,
                                1.0F};
  const D3D12_RECT scissor{static_cast<LONG>(area.x), static_cast<LONG>(area.y), static_cast<LONG>(area.x + area.width),
                           static_cast<LONG>(area.y + area.height)};
  bindDraw(target, commands, info.view);
  commands->SetPipelineState(target.pipelines[number].get());
  commands->IASetPrimitiveTopology(D3D_PRIMITIVE_TOPOLOGY_TRIANGLELIST);
  commands->RSSetViewports(1, &viewport);
  commands->RSSetScissorRects(1, &scissor);
  if (target.info.stencilMark) commands->OMSetStencilRef(0);
  commands->ExecuteIndirect(target.context->draws.get(), 1, target.storage.buffer(D3d12Part::Constants),
                            kArgumentsOffset + target.plan.passes()[number].arguments, nullptr, 0);
}

void recordPass(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, std::size_t number, bool hazard,
                const D3d12CallInfo& info) {
  switch (target.plan.passes()[number].action) {
    case Action::Clear:
      return clear(target, commands, hazard);
    case Action::Dispatch:
      return recordDispatch(target, commands, number, hazard, info);
    case Action::Draw:
    case Action::DrawPlain:
      return recordDraw(target, commands, number, info);
    case Action::BeginCopy:
      return beginCopy(target, commands, info.copied, hazard);
    case Action::FinishCopy:
      return finishCopy(target, commands, info);
    case Action::CopyStatistics:
      return copyStatistics(target, commands);
    case Action::FinishStatistics:
      return finishStatistics(target, commands);
    case Action::HostDraws:
    case Action::HostReads:
      break;
  }
}

// As the call after this one finds the buffers: draws of either side cannot make barriers of their own.
void recordNext(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, Call next) {
  D3d12Storage& storage = target.storage;
  const bool hazard = isHazard(target.plan.beforeCall(next), Resource::Lists);
  if (next == Call::Resolve && readsArguments(target.plan, next)) copyArguments(storage, commands);
  BarrierBatch barriers(storage);
  barriers.need(D3d12Part::Constants, kConstant);
  barriers.need(D3d12Part::Control, kWritten, hazard);
  barriers.need(D3d12Part::Lists, next == Call::Resolve && target.drawsResolve() ? kRead : kWritten, hazard);
  barriers.record(commands);
}

} // namespace

void recordCall(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, Call call,
                const D3d12CallInfo& info) {
  const std::vector<Pass>& passes = target.plan.passes();
  bool first = call != Call::Resolve; // what that waits for the calls before it have recorded
  if (call == Call::Resolve && target.info.resolve == VITRAIL_RESOLVE_COMPUTE) {
    copyBehind(target, commands, target.views.at(info.view).color);
  }
  for (std::size_t i = 0; i < passes.size(); ++i) {
    if (passes[i].call != call) continue;
    const bool boundary = first && isHazard(target.plan.beforeCall(call), Resource::Lists);
    recordPass(target, commands, i, boundary || isHazard(passes[i].before, Resource::Lists), info);
    first = false;
  }
  if (call == Call::Begin) recordNext(target, commands, Call::Draws);
  if (call == Call::Collected || call == Call::CopyLists) recordNext(target, commands, Call::Resolve);
  if (call == Call::End) recordNext(target, commands, Call::Begin);
}

void forgetRecorded(D3d12Storage& storage) { // as recordNext() does it for Call::Begin
  storage.states = {kConstant, kWritten, kWritten};
  static_assert(static_cast<std::uint32_t>(D3d12Part::Constants) == 0);
}

void recordReadable(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands) {
  BarrierBatch barriers(target.storage);
  barriers.need(D3d12Part::Constants, kConstant);
  barriers.need(D3d12Part::Control, kRead);
  barriers.need(D3d12Part::Lists, kRead);
  barriers.record(commands);
}

void recordReady(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands) {
  recordNext(target, commands, target.order.collected() ? Call::Resolve : Call::Begin);
}

} // namespace vitrail
