#include "frame_plan.h"

#include <cstddef>

#include "vitrail/layout.h"

namespace vitrail {

namespace {

// ---- Accesses of a pass, by what it is

constexpr Accesses kShaderReadsWrites{0, kAccessUniformRead | kAccessShaderRead | kAccessShaderWrite};

constexpr PassAccesses lists(Accesses accesses) { return {accesses, {}, {}}; }
constexpr PassAccesses shaders(std::uint32_t stages) { return lists({stages, kShaderReadsWrites.accesses}); }

constexpr PassAccesses kCompute = shaders(kStageCompute);
constexpr PassAccesses kIndirect =
    lists({kStageIndirect | kStageCompute, kAccessIndirectRead | kShaderReadsWrites.accesses});
constexpr PassAccesses kPicture = {
    Accesses{kStageIndirect | kStageCompute, kAccessIndirectRead | kShaderReadsWrites.accesses}, Accesses{},
    Accesses{kStageCompute, kAccessShaderRead | kAccessShaderWrite}};
constexpr PassAccesses kTriangle =
    lists({kStageIndirect | kStageFragment, kAccessIndirectRead | kShaderReadsWrites.accesses});
constexpr PassAccesses kPlainTriangle =
    lists({kStageIndirect | kStageFragment, kAccessIndirectRead | kAccessUniformRead});
constexpr PassAccesses kClearing = {
    Accesses{kStageTransfer, kAccessTransferWrite}, Accesses{kStageTransfer, kAccessTransferWrite}, {}};
constexpr PassAccesses kCopying = {
    Accesses{kStageTransfer, kAccessTransferRead}, Accesses{kStageTransfer, kAccessTransferWrite}, {}};
// The counters are visible to the host before the tag is written that says so.
constexpr PassAccesses kTagging = {
    Accesses{}, Accesses{kStageTransfer | kStageHost, kAccessTransferWrite | kAccessHostRead}, {}};

// ---- The passes

struct Row {
  Pass pass;
  std::uint32_t all = 0;  // facts that it needs
  std::uint32_t none = 0; // facts that rule it out
};

constexpr Row action(Call call, Action what, const PassAccesses& uses, std::uint32_t all = 0, std::uint32_t none = 0) {
  Row row;
  row.pass.call = call;
  row.pass.action = what;
  row.pass.uses = uses;
  row.all = all;
  row.none = none;
  return row;
}

constexpr Row dispatch(Call call, Kernel kernel, Extent extent, std::size_t arguments, const PassAccesses& uses,
                       std::uint32_t all, std::uint32_t none = 0, std::uint32_t group = 0) {
  Row row = action(call, Action::Dispatch, uses, all, none);
  row.pass.kernel = kernel;
  row.pass.extent = extent;
  row.pass.arguments = static_cast<std::uint32_t>(arguments);
  row.pass.group = group;
  return row;
}

constexpr Row draw(Action what, std::size_t arguments, const PassAccesses& uses, std::uint32_t all,
                   std::uint32_t none) {
  Row row = action(Call::Resolve, what, uses, all, none);
  row.pass.extent = Extent::Indirect;
  row.pass.arguments = static_cast<std::uint32_t>(arguments);
  return row;
}

// Where the dispatch of a class of list lengths has its arguments.
constexpr std::size_t classArguments(std::uint32_t number) {
  return offsetof(layout::VitrailControl, classes) + number * sizeof(layout::VitrailListClass) +
         offsetof(layout::VitrailListClass, groupsX);
}

constexpr std::size_t kPixelArguments = offsetof(layout::VitrailControl, pixelGroupsX);
constexpr std::size_t kPlainArguments = offsetof(layout::VitrailControl, plainGroupsX);
constexpr std::size_t kOverflowArguments = offsetof(layout::VitrailControl, overflowGroupsX);

// Every pass that a frame may have, in order. A class of list lengths is a row of the resolve.
constexpr std::array kRows = {
    action(Call::Begin, Action::Clear, kClearing),
    dispatch(Call::Begin, Kernel::ClearHeads, Extent::Heads, 0, kCompute, kClearsByCompute),
    action(Call::Draws, Action::HostDraws, shaders(kStageFragment)),

    // One invocation also writes the arguments of all that is indirect: of the build's own, else of a pass for that.
    dispatch(Call::Collected, Kernel::BuildLists, Extent::Nodes, 0, kCompute, kBuildsByCompute),
    dispatch(Call::Collected, Kernel::Prepare, Extent::One, 0, kCompute, 0, kBuildsByCompute),
    dispatch(Call::Collected, Kernel::SortFind, Extent::Indirect, kPixelArguments, kIndirect, 0, kResolvesByCompute),
    dispatch(Call::Collected, Kernel::SortLong, Extent::Indirect, classArguments(VITRAIL_CLASS_LONG), kIndirect, 0,
             kResolvesByCompute | kHostResolves),
    dispatch(Call::Collected, Kernel::SortLongWords, Extent::Indirect, classArguments(VITRAIL_CLASS_LONG), kIndirect,
             kHostResolves),

    action(Call::CopyLists, Action::BeginCopy, lists({kStageTransfer, kAccessTransferWrite}), kCopiesLists),
    dispatch(Call::CopyLists, Kernel::CopyLists, Extent::Copied, 0, kCompute, kCopiesLists),
    action(Call::CopyLists, Action::FinishCopy, lists({kStageTransfer, kAccessTransferRead}), kCopiesLists),

    action(Call::Resolve, Action::HostReads,
           lists({kStageFragment | kStageCompute, kAccessUniformRead | kAccessShaderRead})),
    dispatch(Call::Resolve, Kernel::Resolve, Extent::Indirect, kPixelArguments, kPicture, kResolvesByCompute),
    dispatch(Call::Resolve, Kernel::ResolveMedium, Extent::Indirect, classArguments(VITRAIL_CLASS_MEDIUM), kPicture,
             kResolvesByCompute | kNetworks, kCapped),
    dispatch(Call::Resolve, Kernel::ResolveGroup, Extent::Indirect, classArguments(VITRAIL_CLASS_LONG), kPicture,
             kResolvesByCompute | kNetworks, kCapped, 4),
    dispatch(Call::Resolve, Kernel::ResolveGroup, Extent::Indirect, classArguments(VITRAIL_CLASS_LONGEST), kPicture,
             kResolvesByCompute | kNetworks, kCapped, 8),
    dispatch(Call::Resolve, Kernel::ResolveLong, Extent::Indirect, classArguments(VITRAIL_CLASS_LONG), kPicture,
             kResolvesByCompute, kNetworks | kCapped),
    dispatch(Call::Resolve, Kernel::ResolveOverflow, Extent::Indirect, kOverflowArguments, kPicture,
             kResolvesByCompute | kKeepsSums, kNetworks), // by networks the first kernel does it
    dispatch(Call::Resolve, Kernel::ResolvePlain, Extent::Indirect, kPlainArguments, kPicture,
             kResolvesByCompute | kAveragesSamples),
    draw(Action::Draw, offsetof(layout::VitrailControl, drawVertices), kTriangle, 0,
         kResolvesByCompute | kHostResolves),
    draw(Action::DrawPlain, offsetof(layout::VitrailControl, plainVertices), kPlainTriangle, kAveragesSamples,
         kResolvesByCompute),

    // A fragment resolve only reads the sums, several times a pixel where it runs per sample.
    dispatch(Call::End, Kernel::ClearSums, Extent::Indirect, kOverflowArguments, kIndirect, kKeepsSums,
             kResolvesByCompute),
    action(Call::End, Action::CopyStatistics, kCopying),
    action(Call::End, Action::FinishStatistics, kTagging),
    action(Call::End, Action::HostReads, {Accesses{}, Accesses{kStageHost, kAccessHostRead}, {}}),
};

// ---- Barriers

constexpr std::uint32_t kWrites = kAccessShaderWrite | kAccessTransferWrite;
constexpr std::uint32_t kDeviceStages = ~std::uint32_t{kStageHost}; // the host waits by itself, and tells by the tag

// `before` counts as source with its stages and writes.
Barrier barrierBetween(const Accesses& before, const Accesses& after) {
  const bool hazard = ((before.accesses | after.accesses) & kWrites) != 0; // reads do not wait for reads
  if (!hazard || (before.stages & kDeviceStages) == 0 || after.stages == 0) return {};
  return {{before.stages & kDeviceStages, before.accesses & kWrites}, after};
}

// The barrier before each pass of a call, on what the call's own passes did since the last one. Draws have none: they
// are in the host's rendering scope, and only one of them draws anything. Nor do the host's own reads make anything
// wait here: they are not within the call.
void deriveWithin(std::vector<Pass>& passes, Call call) {
  PassAccesses since{};
  for (Pass& pass : passes) {
    if (pass.call != call || pass.action == Action::Draw || pass.action == Action::DrawPlain) continue;
    for (std::uint32_t r = 0; r < kResources; ++r) {
      pass.before[r] = barrierBetween(since[r], pass.uses[r]);
      if (pass.before[r].after.stages != 0) since[r] = {};
      if (pass.action != Action::HostReads) since[r] |= pass.uses[r];
    }
  }
}

PassAccesses usesOf(const std::vector<Pass>& passes, Call first, Call last) {
  PassAccesses uses{};
  for (const Pass& pass : passes) {
    if (pass.call < first || pass.call > last) continue;
    for (std::uint32_t r = 0; r < kResources; ++r) uses[r] |= pass.uses[r];
  }
  return uses;
}

} // namespace

std::uint32_t planFacts(const DeviceLimits& limits, const TargetInfo& info) {
  std::uint32_t facts = 0;
  if (info.listBuild == VITRAIL_LIST_BUILD_COMPUTE) facts |= kBuildsByCompute;
  if (info.resolve == VITRAIL_RESOLVE_COMPUTE) facts |= kResolvesByCompute;
  if (limits.networks && limits.exchangesInGroups) facts |= kNetworks;
  if (info.hostResolves()) facts |= kHostResolves;
  if (info.maxLayers != 0 && info.maxLayers <= layout::VITRAIL_SHORT_LIST) facts |= kCapped;
  if (info.keepsSums()) facts |= kKeepsSums;
  if (info.perPixel()) facts |= kAveragesSamples;
  if (info.copyLayers != 0) facts |= kCopiesLists;
  if (limits.fillsSlowly) facts |= kClearsByCompute;
  return facts;
}

FragmentResolve fragmentResolve(const TargetInfo& info, bool dual) {
  if (info.samples == 1) return dual ? FragmentResolve::SingleDual : FragmentResolve::Single;
  if (info.perPixel()) return FragmentResolve::PerPixel;
  if (info.testsDepth()) return dual ? FragmentResolve::PerSampleDualDepth : FragmentResolve::PerSampleDepth;
  return dual ? FragmentResolve::PerSampleDual : FragmentResolve::PerSample;
}

FramePlan::FramePlan(std::uint32_t facts) {
  for (const Row& row : kRows) {
    if ((facts & row.all) == row.all && (facts & row.none) == 0) passes_.push_back(row.pass);
  }
  for (std::uint32_t number = 0; number < kCalls; ++number) {
    const auto call = static_cast<Call>(number);
    deriveWithin(passes_, call);
    // Of a frame's calls any may be missing that come before this one; of the frame before it, too, which the first
    // call waits for, and the draws, whose writes go to other places than the first call's.
    PassAccesses earlier =
        usesOf(passes_, Call::Begin, call <= Call::Draws ? Call::End : static_cast<Call>(number - 1));
    if (call == Call::CopyLists) earlier = usesOf(passes_, Call::Begin, Call::Resolve); // any number of them, anywhere
    const PassAccesses here = usesOf(passes_, call, call);
    for (std::uint32_t r = 0; r < kResources; ++r) {
      if (static_cast<Resource>(r) == Resource::Picture) continue; // the host's images: the host's barriers
      boundaries_[number][r] = barrierBetween(earlier[r], here[r]);
    }
  }
}

} // namespace vitrail
