// What the calls record beside their passes: which state of the command list they set, as vitrail/d3d12.h says, and
// whether every buffer is in the state in which it is used.
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <vector>

#include "../expected.h"
#include "point_host.h"
#include "tapped.h"

namespace vitrail::tests::d3d12 {
namespace {

using Names = std::set<std::string>;

const Names kKernels = {"SetComputeRootSignature", "SetPipelineState"};
const Names kDraws = {"SetGraphicsRootSignature", "SetPipelineState", "IASetPrimitiveTopology", "RSSetViewports",
                      "RSSetScissorRects"};

Names with(Names names, const std::string& one) {
  names.insert(one);
  return names;
}

struct Kind {
  const char* name;
  VitrailResolve resolve;
  std::uint32_t samples = 1;
  VitrailMsaaResolve msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  VitrailListBuild listBuild = VITRAIL_LIST_BUILD_FRAGMENT;
  bool stencilMark = false;
};

constexpr std::array kKinds = {
    Kind{"Compute", VITRAIL_RESOLVE_COMPUTE},
    Kind{"ComputeOfFourSamples", VITRAIL_RESOLVE_COMPUTE, 4},
    Kind{"ComputeOfListsByCompute", VITRAIL_RESOLVE_COMPUTE, 1, VITRAIL_MSAA_RESOLVE_PER_PIXEL,
         VITRAIL_LIST_BUILD_COMPUTE},
    Kind{"Fragment", VITRAIL_RESOLVE_FRAGMENT},
    Kind{"FragmentWithStencil", VITRAIL_RESOLVE_FRAGMENT, 1, VITRAIL_MSAA_RESOLVE_PER_PIXEL,
         VITRAIL_LIST_BUILD_FRAGMENT, true},
    Kind{"FragmentPerSample", VITRAIL_RESOLVE_FRAGMENT, 4, VITRAIL_MSAA_RESOLVE_PER_SAMPLE},
    Kind{"FragmentPerPixel", VITRAIL_RESOLVE_FRAGMENT, 4},
    Kind{"Host", VITRAIL_RESOLVE_HOST},
    Kind{"HostOfListsByCompute", VITRAIL_RESOLVE_HOST, 1, VITRAIL_MSAA_RESOLVE_PER_PIXEL, VITRAIL_LIST_BUILD_COMPUTE},
};

HostDesc hostOf(const Kind& kind) {
  HostDesc desc;
  desc.resolve = kind.resolve;
  desc.samples = kind.samples;
  desc.msaaResolve = kind.msaaResolve;
  desc.listBuild = kind.listBuild;
  desc.stencilMark = kind.stencilMark;
  desc.copyLayers = 1024;
  desc.behind = {0.25F, 0.5F, 1.0F, 1.0F};
  return desc;
}

class StateTest : public D3d12Test, public ::testing::WithParamInterface<Kind> {
 protected:
  // A frame with all calls through the tapped list; expects what each sets.
  static void drawTapped(D3d12Host& host, TappedList& list, CommandList& commands, std::span<const Point> points,
                         std::uint64_t frame, ID3D12Resource* copied, bool ownHeap) {
    const Names kernels = ownHeap ? with(kKernels, "SetDescriptorHeaps") : kKernels;
    const VitrailD3d12Target target = host.target();
    PointTextures& textures = host.texturesOf(frame);
    host.drawOpaque(&list, textures);
    list.takeChanges();
    host.begin(&list, frame, {});
    EXPECT_EQ(list.takeChanges(), kKernels) << "vitrailD3d12Begin";
    host.drawPoints(&list, commands, textures, points);
    list.takeChanges();
    vitrailD3d12Bind(target, &list, 0);
    EXPECT_EQ(list.takeChanges(), Names{}) << "vitrailD3d12Bind";
    vitrailD3d12Collected(target, &list);
    EXPECT_EQ(list.takeChanges(), kernels) << "vitrailD3d12Collected";
    vitrailD3d12BindLists(target, &list, VITRAIL_D3D12_NO_PARAMETER, 0);
    for (const D3D12_RESOURCE_STATES state : list.bufferStates()) {
      EXPECT_NE(state, D3D12_RESOURCE_STATE_UNORDERED_ACCESS) << "vitrailD3d12BindLists";
    }
    vitrailD3d12UnbindLists(target, &list);
    EXPECT_EQ(list.takeChanges(), Names{}) << "vitrailD3d12BindLists";
    VitrailD3d12CopyInfo copy{};
    copy.area = {0, 0, 8, 8};
    copy.buffer = copied;
    copy.size = vitrailD3d12CopySize(target, 8, 8);
    vitrailD3d12CopyLists(target, &list, &copy);
    EXPECT_EQ(list.takeChanges(), kernels) << "vitrailD3d12CopyLists";
    host.setForResolve(&list, textures);
    list.takeChanges();
    list.takeBarriers();
    expectResolve(host, list, frame, ownHeap);
    vitrailD3d12End(target, &list);
    Names end = list.takeChanges();
    if (ownHeap) end.insert("SetDescriptorHeaps"); // where it cleans up
    EXPECT_EQ(end, kernels) << "vitrailD3d12End";
  }

  static void expectResolve(D3d12Host& host, TappedList& list, std::uint64_t frame, bool ownHeap) {
    const bool draws = GetParam().resolve == VITRAIL_RESOLVE_FRAGMENT;
    VitrailD3d12ResolveInfo info{};
    if (host.targetDesc().views.count > 0) info.view = static_cast<std::uint32_t>(frame % PointHost::kFramesTogether);
    vitrailD3d12Resolve(host.target(), &list, &info);
    Names expected = draws ? kDraws : kKernels;
    if (ownHeap) expected.insert("SetDescriptorHeaps");
    if (GetParam().stencilMark) expected.insert("OMSetStencilRef");
    if (GetParam().resolve == VITRAIL_RESOLVE_HOST) expected = {};
    EXPECT_EQ(list.takeChanges(), expected) << "vitrailD3d12Resolve";
    if (GetParam().resolve != VITRAIL_RESOLVE_COMPUTE) {
      EXPECT_EQ(list.takeBarriers(), 0U) << "a barrier where a render pass may be open";
    }
  }

  static bool isOffered() {
    if (GetParam().samples == 1) return true;
    const auto& counts = backend().features().multisampled;
    return std::find(counts.begin(), counts.end(), GetParam().samples) != counts.end();
  }
};
INSTANTIATE_TEST_SUITE_P(, StateTest, ::testing::ValuesIn(kKinds), [](const auto& one) { return one.param.name; });

TEST_P(StateTest, IsWhatTheHeaderSays) {
  if (!isOffered()) GTEST_SKIP() << "this device has no textures of " << GetParam().samples << " samples";
  for (const bool ownHeap : {true, false}) {
    SCOPED_TRACE(ownHeap ? "descriptors of its own" : "the host's descriptors");
    HostDesc desc = hostOf(GetParam());
    const std::vector<Point> points = randomLists(desc, {0, 1, 2, 16, 17, 40, 200}, 3);
    desc.capacity = static_cast<std::uint32_t>(points.size());
    const PointResult expected = D3d12Host(backend(), desc).draw(points);
    const Com<ID3D12DescriptorHeap> heap =
        device().makeHeap(D3D12_DESCRIPTOR_HEAP_TYPE_CBV_SRV_UAV, 4096, /*visible=*/true);
    D3d12Host host(backend(), desc, [&](VitrailD3d12TargetDesc& target) {
      if (ownHeap) return;
      target.descriptorHeap = heap.get();
      target.firstDescriptor = 7;
      target.descriptorCount = 4000;
    });
    CommandList commands;
    TappedList list(commands.get());
    ID3D12DescriptorHeap* const set = heap.get();
    commands->SetDescriptorHeaps(1, &set);
    const auto copied = device().makeBuffer(vitrailD3d12CopySize(host.target(), 8, 8), D3D12_HEAP_TYPE_READBACK);
    for (std::uint64_t frame = 0; frame < 2; ++frame) { // in one command list
      drawTapped(host, list, commands, points, frame, copied.get(), ownHeap);
    }
    commands.run();
    for (const std::string& error : list.errors()) ADD_FAILURE() << error;
    for (std::uint64_t frame = 0; frame < 2; ++frame) {
      const PointResult result = host.read(host.texturesOf(frame), frame);
      EXPECT_TRUE(result.pixels == expected.pixels) << "frame " << frame;
      EXPECT_EQ(result.stats.complete, 1U);
      EXPECT_EQ(result.stats.fragmentsStored, points.size());
    }
  }
}

// A frame that was recorded halfway and is never executed leaves no state behind: the one that takes its place begins
// where the one before it has ended.
TEST_P(StateTest, OfADroppedFrameIsForgotten) {
  if (!isOffered()) GTEST_SKIP() << "this device has no textures of " << GetParam().samples << " samples";
  HostDesc desc = hostOf(GetParam());
  desc.capacity = 16;
  D3d12Host host(backend(), desc);
  const std::vector<Point> points = {{1, 1, 0.5F, {1.0F, 0.5F, 0.25F, 0.5F}}};
  CommandList commands;
  TappedList list(commands.get());
  const auto copied = device().makeBuffer(vitrailD3d12CopySize(host.target(), 8, 8), D3D12_HEAP_TYPE_READBACK);
  drawTapped(host, list, commands, points, 0, copied.get(), true);
  {
    CommandList unused;
    host.begin(unused.get(), 1, {});
    vitrailD3d12Collected(host.target(), unused.get());
    vitrailD3d12BindLists(host.target(), unused.get(), VITRAIL_D3D12_NO_PARAMETER, 0);
  }
  drawTapped(host, list, commands, points, 1, copied.get(), true);
  expectOneLine("Begin"); // over an open frame
  commands.run();
  for (const std::string& error : list.errors()) ADD_FAILURE() << error;
  EXPECT_EQ(host.read(host.texturesOf(1), 1).stats.complete, 1U);
}

// The tapped list notices what it is there for: without a barrier, or without a transition, it objects.
TEST_P(StateTest, MissingBarriersAreNoticed) {
  if (!isOffered()) GTEST_SKIP() << "this device has no textures of " << GetParam().samples << " samples";
  for (const bool waits : {true, false}) {
    HostDesc desc = hostOf(GetParam());
    desc.capacity = 16;
    D3d12Host host(backend(), desc);
    CommandList unused;
    TappedList list(unused.get());
    PointTextures& textures = host.texturesOf(0);
    host.drawOpaque(&list, textures);
    const std::vector<Point> points = {{1, 1, 0.5F, {1.0F, 0.5F, 0.25F, 0.5F}}};
    host.begin(&list, 0, {}); // names the buffers
    host.drawPoints(&list, unused, textures, points);
    list.dropsWaits = waits;
    list.dropsTransitions = !waits;
    vitrailD3d12Collected(host.target(), &list);
    list.dropsTransitions = false; // the host's own
    host.setForResolve(&list, textures);
    list.dropsTransitions = !waits;
    vitrailD3d12Resolve(host.target(), &list, nullptr);
    vitrailD3d12End(host.target(), &list);
    EXPECT_FALSE(list.errors().empty()) << (waits ? "barriers" : "transitions");
  }
}

} // namespace
} // namespace vitrail::tests::d3d12
