// One view: its memory now, the memory that frames in flight still use, its pipelines, the frame that is being
// recorded.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "context.h"
#include "core/call_order.h"
#include "core/frame_numbers.h"
#include "core/frame_plan.h"
#include "core/growth.h"
#include "core/statistics.h"
#include "core/sums_clear.h"
#include "storage.h"

struct VitrailD3d12Target_T {
  VitrailD3d12Context context = nullptr; // which the target owns a share of
  vitrail::TargetInfo info;              // with its defaults
  DXGI_FORMAT colorFormat = DXGI_FORMAT_R16G16B16A16_FLOAT;
  std::uint64_t memoryBudget = 0; // the host's, of which info has what is left for the lists
  ID3D12Heap* hostHeap = nullptr;
  std::string debugName;
  std::array<vitrail::D3d12View, VITRAIL_MAX_VIEWS> views{};
  std::uint32_t viewCount = 0;

  vitrail::FramePlan plan;
  std::vector<vitrail::Com<ID3D12PipelineState>> pipelines; // of each of the plan's passes; null where a pass has none
  vitrail::KernelConstants constants{};
  vitrail::D3d12Descriptors descriptors;
  vitrail::D3d12Storage storage;
  std::vector<vitrail::D3d12Storage> retired; // that frames in flight use
  vitrail::Com<ID3D12Resource> stats;         // StatsSlot[statisticsSlots()], for the host to read
  vitrail::StatsSlot* mapped = nullptr;
  vitrail::Growth growth;
  vitrail::SumsClear sums;

  // The frame that is being recorded.
  vitrail::FrameNumbers frames;
  vitrail::CallOrder order;
  VitrailRect area{};

  [[nodiscard]] std::span<vitrail::StatsSlot> slots() const {
    return {mapped, vitrail::statisticsSlots(info.framesInFlight)};
  }
  [[nodiscard]] std::size_t slotOf(std::uint64_t frame) const { return frame % slots().size(); }
  [[nodiscard]] std::uint64_t slotOffset() const { return slotOf(frames.newest()) * sizeof(vitrail::StatsSlot); }
  [[nodiscard]] bool drawsResolve() const { return info.resolve == VITRAIL_RESOLVE_FRAGMENT; }
};

namespace vitrail {

// Makes plan, pipelines and statistics. Logs its errors.
VitrailResult buildTarget(VitrailD3d12Target_T& target, const VitrailD3d12TargetDesc& desc);

// What a call's passes need beyond the target.
struct D3d12CallInfo {
  std::uint32_t view = 0; // of a resolve
  VitrailRect copied{};   // of a copy of lists
  ID3D12Resource* copyBuffer = nullptr;
  std::uint64_t copyOffset = 0;
};

// Records the passes of a call, with all barriers between them, and what the next call finds.
void recordCall(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands, Call call,
                const D3d12CallInfo& info = {});

// What was recorded of an open frame is never executed: the buffers are as the frame before has left them.
void forgetRecorded(D3d12Storage& storage);

// Makes the lists readable for shaders of the host, and as the library's next call finds them.
void recordReadable(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands);
void recordReady(VitrailD3d12Target_T& target, ID3D12GraphicsCommandList* commands);

// Frees memory that only frames used that have finished when the frame at that place (FrameNumbers) is recorded.
void freeRetired(VitrailD3d12Target_T& target, std::uint64_t place);

} // namespace vitrail
