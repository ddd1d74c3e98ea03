// One view: its memory, its shaders, the frame that is being recorded.
#pragma once

#include <array>
#include <cstdint>
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

namespace vitrail {

// The views of one picture; null where there is none.
struct D3d11View {
  ID3D11UnorderedAccessView* color = nullptr;
  ID3D11ShaderResourceView* opaque = nullptr;
  ID3D11ShaderResourceView* depth = nullptr;
};

// The shader of a pass, if it has one.
struct D3d11Shader {
  Com<ID3D11ComputeShader> compute;
  Com<ID3D11PixelShader> pixel;
};

// What the host knows of a frame, written by the GPU in its turn: the number when it begins, the rest when it ends.
struct D3d11Stamp {
  FrameFacts facts;
  std::uint32_t unused;
  std::uint64_t tag;
  std::uint64_t unused2; // buffers are written by 16 bytes
};
static_assert(sizeof(D3d11Stamp) == 32);

} // namespace vitrail

struct VitrailD3d11Target_T {
  VitrailD3d11Context context = nullptr; // which the target owns a share of
  vitrail::TargetInfo info;              // with its defaults
  DXGI_FORMAT colorFormat = DXGI_FORMAT_R16G16B16A16_FLOAT;
  std::uint64_t memoryBudget = 0; // the host's, of which info has what is left for the lists
  bool hostBuffers = false;
  bool severalRenderTargets = false;
  std::string debugName;
  std::array<vitrail::D3d11View, VITRAIL_MAX_VIEWS> views{};
  std::uint32_t viewCount = 0;

  vitrail::FramePlan plan;
  std::vector<vitrail::D3d11Shader> shaders; // of each of the plan's passes
  vitrail::D3d11Storage storage;
  vitrail::Com<ID3D11Buffer> constants; // KernelConstants
  // A compute resolve of one sample: what is behind, as it was before.
  vitrail::Com<ID3D11Texture2D> behind;
  vitrail::Com<ID3D11ShaderResourceView> behindView;
  // A fragment resolve.
  vitrail::Com<ID3D11BlendState> blending;
  vitrail::Com<ID3D11DepthStencilState> testing;
  vitrail::Com<ID3D11RasterizerState> rasterizing;

  vitrail::Com<ID3D11Buffer> begun;                     // the number of the frame
  vitrail::Com<ID3D11Buffer> stamp;                     // D3d11Stamp
  std::vector<vitrail::Com<ID3D11Buffer>> statsBuffers; // a StatsSlot each, for the host to read
  std::vector<vitrail::Com<ID3D11Query>> statsWritten;  // whether the GPU has written each
  std::vector<std::uint64_t> statsExpected;             // the tag of what is on its way to each; 0: nothing is
  std::vector<vitrail::StatsSlot> slots;                // what was read of each
  vitrail::Growth growth;
  vitrail::SumsClear sums;

  // The frame that is being recorded.
  vitrail::FrameNumbers frames;
  vitrail::CallOrder order;
  VitrailRect area{};

  [[nodiscard]] std::size_t slotOf(std::uint64_t frame) const { return frame % slots.size(); }
};

namespace vitrail {

// What a call's passes need beyond the target.
struct D3d11CallInfo {
  std::uint32_t view = 0; // of a resolve
  VitrailRect copied{};   // of a copy of lists
  ID3D11Buffer* copyBuffer = nullptr;
  std::uint64_t copyOffset = 0;
};

// The passes of a call.
void runCall(VitrailD3d11Target_T& target, ID3D11DeviceContext* commands, Call call, const D3d11CallInfo& info = {});

// Takes the counters of a slot from where the GPU has written them, if it has. `flush`: else has it begin to. Through
// the immediate context.
void fetchStats(VitrailD3d11Target_T& target, ID3D11DeviceContext* immediate, std::size_t slot, bool flush);

} // namespace vitrail
