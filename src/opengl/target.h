// One view: its memory, its programs, the frame that is being recorded.
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

// A frame's counters on their way to the host.
struct PendingStats {
  GLsync fence = nullptr; // null: there are none on their way
  std::uint64_t frame = 0;
};

// The textures of one view; 0 where there is none.
struct GlView {
  GLuint color = 0;
  GLuint opaque = 0;
  GLuint depth = 0;
};

} // namespace vitrail

struct VitrailGlTarget_T {
  VitrailGlContext context = nullptr; // which the target owns a share of
  vitrail::TargetInfo info;           // with its defaults
  GLenum colorFormat = GL_RGBA16F;
  GLuint hostBuffer = 0; // where the host brought the memory
  bool hostBarriers = false;
  bool severalDrawBuffers = false;
  GLuint stencilMask = 0xff;
  std::string debugName;
  std::array<vitrail::GlView, VITRAIL_MAX_VIEWS> views{};
  std::uint32_t viewCount = 0;

  vitrail::FramePlan plan;
  std::vector<GLuint> programs; // of each of the plan's passes, the context's; 0 where a pass has none
  vitrail::GlStorage storage;
  GLuint writtenBuffer = 0;              // what the host writes to the device, on its way
  GLuint statsBuffer = 0;                // StatsSlot[statisticsSlots()], of which the GPU writes the counters
  const std::byte* stats = nullptr;      // where it is mapped
  std::vector<vitrail::StatsSlot> slots; // what is known of each
  std::vector<vitrail::PendingStats> pending;
  bool lost = false; // the context is: statistics that are not there yet will never be
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
struct GlCallInfo {
  std::uint32_t view = 0; // of a resolve
  VitrailRect copied{};   // of a copy of lists
  GLuint copyBuffer = 0;
  std::uint64_t copyOffset = 0;
};

// Whether a pass has a program.
bool runsShaders(const Pass& pass);

// The passes of a call, with the barriers between them.
void runCall(VitrailGlTarget_T& target, Call call, const GlCallInfo& info = {});

// The bits of the barrier that a call needs before its passes.
GLbitfield boundaryOf(const VitrailGlTarget_T& target, Call call);

} // namespace vitrail
