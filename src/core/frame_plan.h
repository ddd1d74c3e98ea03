// A frame as data: the passes that a target's frames consist of, each with its kernel, its extent and what it reads and
// writes. Barriers follow from that. A backend records the plan and decides nothing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "call_order.h"
#include "kernels/kernels.h"
#include "target_rules.h"

namespace vitrail {

// ---- What passes read and write

enum class Resource : std::uint32_t {
  Lists,      // the target's buffer: parameters, counters, heads, lists, sums, nodes
  Statistics, // the frame's slot
  Picture     // the images of a compute resolve
};
constexpr std::uint32_t kResources = 3;

// Bits.
enum Stage : std::uint32_t {
  kStageIndirect = 1U << 0U, // the command processor reads arguments
  kStageFragment = 1U << 1U,
  kStageCompute = 1U << 2U,
  kStageTransfer = 1U << 3U,
  kStageHost = 1U << 4U
};
enum Access : std::uint32_t {
  kAccessIndirectRead = 1U << 0U,
  kAccessUniformRead = 1U << 1U,
  kAccessShaderRead = 1U << 2U,
  kAccessShaderWrite = 1U << 3U,
  kAccessTransferRead = 1U << 4U,
  kAccessTransferWrite = 1U << 5U,
  kAccessHostRead = 1U << 6U
};

struct Accesses {
  std::uint32_t stages = 0;
  std::uint32_t accesses = 0;

  Accesses& operator|=(const Accesses& more) {
    stages |= more.stages;
    accesses |= more.accesses;
    return *this;
  }
};

using PassAccesses = std::array<Accesses, kResources>; // by Resource

// What has to have finished, and what waits for it; nothing where the stages are 0.
struct Barrier {
  Accesses before;
  Accesses after;
};
using Barriers = std::array<Barrier, kResources>; // by Resource

// ---- Passes

enum class Action : std::uint32_t {
  Clear,           // parameters, counters, heads unless a kernel does it, the slot's tag and, where needed, sums
  HostDraws,       // the host's draws that collect; nothing is recorded
  HostReads,       // shaders of the host that walk lists, or the host itself; nothing is recorded
  Dispatch,        // `kernel`
  Draw,            // the fragment resolve
  DrawPlain,       // the fragment resolve of a frame without fragments
  BeginCopy,       // the header of a copy of lists
  FinishCopy,      // from there to the host's buffer
  CopyStatistics,  // counters and what the host knows, to the slot
  FinishStatistics // the slot's tag
};

// How many work groups.
enum class Extent : std::uint32_t {
  None,
  One,
  Nodes,   // a thread a node of the pool, or several nodes
  Heads,   // a thread a pixel of the area, or several pixels, in a row
  Copied,  // a thread a pixel of the copied area
  Indirect // as the counters say: `arguments` is their offset in VitrailControl
};

struct Pass {
  Call call = Call::Begin;
  Action action = Action::Clear;
  Kernel kernel = Kernel::Prepare;
  std::uint32_t group = 0; // invocations that share a list, of kernels that ask
  Extent extent = Extent::None;
  std::uint32_t arguments = 0;
  PassAccesses uses{};
  Barriers before{}; // between this pass and those before it in the same call
};

// What a frame's passes depend on: bits, all of which follow from the target and the device.
enum PlanFact : std::uint32_t {
  kBuildsByCompute = 1U << 0U,
  kResolvesByCompute = 1U << 1U,
  kNetworks = 1U << 2U, // the compute resolve sorts by networks and in groups
  kCapped = 1U << 3U,   // lists are not sorted as a whole: only their nearest fragments are kept
  kKeepsSums = 1U << 4U,
  kAveragesSamples = 1U << 5U, // several samples are resolved per pixel
  kCopiesLists = 1U << 6U,
  kHostResolves = 1U << 7U,   // shaders of the host's walk the sorted lists, and the library draws nothing
  kClearsByCompute = 1U << 8U // a kernel empties the lists
};
std::uint32_t planFacts(const DeviceLimits& limits, const TargetInfo& info);

// Which fragment resolve draws a target's lists; `dual`: with dual-source blending.
FragmentResolve fragmentResolve(const TargetInfo& info, bool dual);

// The passes of a frame in their order, and the barriers between its calls.
class FramePlan {
 public:
  FramePlan() = default;
  explicit FramePlan(std::uint32_t facts);

  [[nodiscard]] const std::vector<Pass>& passes() const { return passes_; }

  // What must be waited for before a call (Call::Draws: before the host's draws), whichever of the calls before it were
  // recorded.
  [[nodiscard]] const Barriers& beforeCall(Call call) const { return boundaries_[static_cast<std::uint32_t>(call)]; }

 private:
  std::vector<Pass> passes_;
  std::array<Barriers, kCalls> boundaries_{};
};

} // namespace vitrail
