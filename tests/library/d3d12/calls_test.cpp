// What only Direct3D 12's calls have: command lists, heaps, descriptors, tables, textures, null and order.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "../expected.h"
#include "point_host.h"

extern "C" VitrailResult contextFromC(ID3D12Device* device, VitrailD3d12Context* context); // plain_c.c

namespace vitrail::tests::d3d12 {
namespace {

class CallsTest : public D3d12Test {};

VitrailD3d12TargetDesc smallTarget() {
  VitrailD3d12TargetDesc desc{};
  desc.width = 8;
  desc.height = 8;
  desc.nodeCapacity = 16;
  desc.resolve = VITRAIL_RESOLVE_FRAGMENT;
  return desc;
}

const std::vector<Point> kPoints = {{1, 1, 0.5F, {1.0F, 0.5F, 0.25F, 0.5F}}, {2, 1, 0.5F, {0.0F, 0.5F, 1.0F, 0.25F}}};

void expectRefused(const VitrailD3d12TargetDesc& desc, VitrailResult result, const char* word) {
  VitrailD3d12Target target = nullptr;
  EXPECT_EQ(vitrailD3d12CreateTarget(backend().context(), &desc, &target), result) << word;
  EXPECT_EQ(target, nullptr);
  expectOneLine(word);
}

// ---- Command lists

// A frame in several command lists, which are executed at once: the calls in some, the host's draws in another.
TEST_F(CallsTest, AFrameMayLieInSeveralCommandLists) {
  for (const VitrailResolve resolve : {VITRAIL_RESOLVE_COMPUTE, VITRAIL_RESOLVE_FRAGMENT}) {
    HostDesc desc;
    desc.resolve = resolve;
    const std::vector<Point> points = randomLists(desc, {0, 1, 2, 16, 17, 40, 200}, 3);
    desc.capacity = static_cast<std::uint32_t>(points.size());
    const PointResult expected = D3d12Host(backend(), desc).draw(points);
    D3d12Host host(backend(), desc);
    PointTextures& textures = host.texturesOf(0);
    std::array<CommandList, 4> lists;
    host.drawOpaque(lists[0].get(), textures);
    host.begin(lists[0].get(), 0, {});
    host.drawPoints(lists[1].get(), lists[1], textures, points);
    vitrailD3d12Collected(host.target(), lists[2].get());
    host.resolve(lists[3].get(), textures, 0);
    vitrailD3d12End(host.target(), lists[3].get());
    std::array<ID3D12CommandList*, 4> all{};
    for (std::size_t i = 0; i < lists.size(); ++i) {
      check(lists.at(i)->Close(), "Close");
      all.at(i) = lists.at(i).get();
    }
    device().queue()->ExecuteCommandLists(all.size(), all.data());
    CommandList last;
    last.run(); // waits for those before it
    const PointResult result = host.read(textures, 0);
    EXPECT_TRUE(result.pixels == expected.pixels);
    EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), kTolerance);
    EXPECT_EQ(result.stats.complete, 1U);
  }
}

// A command list that is executed again draws the frame again: all that the calls need is in it.
TEST_F(CallsTest, ACommandListMayBeExecutedAgain) {
  for (const VitrailResolve resolve : {VITRAIL_RESOLVE_COMPUTE, VITRAIL_RESOLVE_FRAGMENT}) {
    for (const std::uint32_t missing : {0U, 30U}) { // nodes
      HostDesc desc;
      desc.resolve = resolve;
      const std::vector<Point> points = randomLists(desc, {0, 1, 2, 16, 17, 40, 200}, 3);
      desc.capacity = static_cast<std::uint32_t>(points.size()) - missing;
      const PointResult expected = D3d12Host(backend(), desc).draw(points);
      D3d12Host host(backend(), desc);
      PointTextures& textures = host.texturesOf(0);
      CommandList list;
      host.drawOpaque(list.get(), textures);
      host.begin(list.get(), 0, {});
      host.drawPoints(list.get(), list, textures, points);
      vitrailD3d12Collected(host.target(), list.get());
      host.resolve(list.get(), textures, 0);
      vitrailD3d12End(host.target(), list.get());
      textures.color.to(list.get(), D3D12_RESOURCE_STATE_RENDER_TARGET); // as the list finds it
      check(list->Close(), "Close");
      ID3D12CommandList* const one = list.get();
      for (int time = 0; time < 3; ++time) device().queue()->ExecuteCommandLists(1, &one);
      CommandList last;
      last.run(); // waits for those before it
      const PointResult result = host.read(textures, 0);
      EXPECT_TRUE(result.pixels == expected.pixels);
      EXPECT_EQ(result.stats.fragmentsMissing, missing);
      EXPECT_EQ(result.stats.complete, missing == 0 ? 1U : 0U);
    }
  }
}

// Two targets by turns in one command list.
TEST_F(CallsTest, SeveralTargetsShareACommandList) {
  HostDesc desc;
  HostDesc other;
  other.resolve = VITRAIL_RESOLVE_FRAGMENT;
  other.nodes = VITRAIL_NODE_HDR;
  const std::vector<Point> points = randomLists(desc, {0, 1, 2, 16, 17, 40}, 3);
  desc.capacity = other.capacity = static_cast<std::uint32_t>(points.size());
  const PointResult expected = D3d12Host(backend(), desc).draw(points);
  const PointResult expectedOther = D3d12Host(backend(), other).draw(kPoints);
  D3d12Host host(backend(), desc);
  D3d12Host otherHost(backend(), other);
  CommandList commands;
  PointTextures& textures = host.texturesOf(0);
  PointTextures& otherTextures = otherHost.texturesOf(0);
  host.drawOpaque(commands.get(), textures);
  otherHost.drawOpaque(commands.get(), otherTextures);
  host.begin(commands.get(), 0, {});
  otherHost.begin(commands.get(), 0, {});
  host.drawPoints(commands.get(), commands, textures, points);
  otherHost.drawPoints(commands.get(), commands, otherTextures, kPoints);
  vitrailD3d12Collected(host.target(), commands.get());
  vitrailD3d12Collected(otherHost.target(), commands.get());
  otherHost.resolve(commands.get(), otherTextures, 0);
  host.resolve(commands.get(), textures, 0);
  vitrailD3d12End(host.target(), commands.get());
  vitrailD3d12End(otherHost.target(), commands.get());
  commands.run();
  const PointResult result = host.read(textures, 0);
  EXPECT_TRUE(result.pixels == expected.pixels);
  EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), kTolerance);
  EXPECT_TRUE(otherHost.read(otherTextures, 0).pixels == expectedOther.pixels);
}

// As many frames in flight as the target was made for: the host waits for the one that is that far back only.
TEST_F(CallsTest, FramesInFlightKeepTheirStatistics) {
  constexpr std::uint64_t kFlight = 3;
  HostDesc desc;
  desc.capacity = 64;
  D3d12Host host(backend(), desc, [](VitrailD3d12TargetDesc& target) { target.framesInFlight = kFlight; });
  std::array<CommandList, kFlight> lists;
  const auto fragments = [](std::uint64_t frame) { return static_cast<std::size_t>(frame % 7); };
  constexpr std::uint64_t kFrames = 12;
  const std::vector<Point> points(7, kPoints[0]);
  for (std::uint64_t frame = 0; frame < kFrames + kFlight; ++frame) {
    CommandList& list = lists.at(frame % kFlight);
    if (frame >= kFlight) {
      const std::uint64_t done = frame - kFlight;
      list.wait();
      ASSERT_TRUE(host.stats(done)) << "frame " << done;
      EXPECT_EQ(host.stats(done)->fragmentsStored, fragments(done));
      EXPECT_EQ(host.stats(done)->complete, 1U);
    }
    if (frame >= kFrames) continue;
    PointTextures& textures = host.texturesOf(frame);
    host.drawOpaque(list.get(), textures);
    host.begin(list.get(), frame, {});
    host.drawPoints(list.get(), list, textures, std::span(points).first(fragments(frame)));
    vitrailD3d12Collected(host.target(), list.get());
    host.resolve(list.get(), textures, frame % PointHost::kFramesTogether);
    vitrailD3d12End(host.target(), list.get());
    list.submit();
  }
}

// A frame that has begun takes the slot of one that is more than framesInFlight older: its statistics are gone.
TEST_F(CallsTest, AFrameThatBeginsEndsTheStatisticsOfOldOnes) {
  HostDesc desc;
  desc.capacity = 16;
  D3d12Host host(backend(), desc);
  for (int frame = 0; frame < 3; ++frame) host.draw(kPoints);
  EXPECT_TRUE(host.stats(0).has_value());
  CommandList commands;
  host.begin(commands.get(), 3, {});
  commands.run();
  EXPECT_FALSE(host.stats(0).has_value());
  EXPECT_TRUE(host.stats(1).has_value());
}

// A frame whose command list is never executed has no statistics, and does not spoil the next one.
TEST_F(CallsTest, AFrameThatIsNotExecutedHasNoStatistics) {
  HostDesc desc;
  desc.capacity = 16;
  D3d12Host host(backend(), desc);
  host.drop(kPoints);
  EXPECT_FALSE(host.stats(0).has_value());
  const PointResult result = host.draw(kPoints);
  EXPECT_EQ(result.stats.complete, 1U);
  EXPECT_EQ(result.stats.fragmentsStored, kPoints.size());
}

// Bundles have no barriers, and compute lists no draws: both are refused in one line each, and record nothing. A frame
// that one of them was meant for counts as misused; one that was not begun is none.
TEST_F(CallsTest, OtherCommandListsAreRefused) {
  for (const D3D12_COMMAND_LIST_TYPE type : {D3D12_COMMAND_LIST_TYPE_BUNDLE, D3D12_COMMAND_LIST_TYPE_COMPUTE}) {
    Com<ID3D12CommandAllocator> allocator;
    check(device().get()->CreateCommandAllocator(type, VITRAIL_TEST_ID(ID3D12CommandAllocator), outOf(allocator)),
          "CreateCommandAllocator");
    Com<ID3D12GraphicsCommandList> list;
    check(device().get()->CreateCommandList(0, type, allocator.get(), nullptr,
                                            VITRAIL_TEST_ID(ID3D12GraphicsCommandList), outOf(list)),
          "CreateCommandList");
    HostDesc desc;
    desc.capacity = 16;
    D3d12Host host(backend(), desc);
    vitrailD3d12Begin(host.target(), list.get(), nullptr);
    expectOneLine("DIRECT");
    CommandList commands;
    PointTextures& textures = host.texturesOf(0);
    host.drawOpaque(commands.get(), textures);
    host.begin(commands.get(), 0, {});
    vitrailD3d12Collected(host.target(), commands.get());
    host.resolve(commands.get(), textures, 0);
    VitrailD3d12CopyInfo copy{};
    vitrailD3d12CopyLists(host.target(), list.get(), &copy);
    expectOneLine("DIRECT");
    vitrailD3d12End(host.target(), commands.get());
    commands.run();
    ASSERT_TRUE(host.stats(0));
    EXPECT_EQ(host.stats(0)->misused, 1U);
    EXPECT_EQ(host.stats(0)->complete, 0U);
  }
}

// ---- Descriptors and registers

// Tables of the host's in place of root descriptors, in registers and a space of its own.
TEST_F(CallsTest, TablesServeAsRootDescriptorsDo) {
  HostDesc desc;
  desc.capacity = 16;
  const PointResult expected = D3d12Host(backend(), desc).draw(kPoints);
  D3D12_DESCRIPTOR_RANGE ranges[2] = {};
  ranges[0] = {D3D12_DESCRIPTOR_RANGE_TYPE_CBV, 1, 0, 3, 0};
  ranges[1] = {D3D12_DESCRIPTOR_RANGE_TYPE_UAV, 4, 0, 3, 1};
  D3D12_ROOT_PARAMETER table{};
  table.ParameterType = D3D12_ROOT_PARAMETER_TYPE_DESCRIPTOR_TABLE;
  table.DescriptorTable = {2, ranges};
  const auto root = device().makeRoot(std::span(&table, 1));
  const auto heap = device().makeHeap(D3D12_DESCRIPTOR_HEAP_TYPE_CBV_SRV_UAV, 64, /*visible=*/true);
  PointsKind kind;
  kind.shader = "points_space";
  kind.root = root.get();
  D3d12Host host(backend(), desc);
  vitrailD3d12WriteDescriptors(host.target(), heap->GetCPUDescriptorHandleForHeapStart().ptr);
  CommandList commands;
  PointTextures& textures = host.texturesOf(0);
  host.drawOpaque(commands.get(), textures);
  host.begin(commands.get(), 0, {});
  host.setPoints(commands.get(), commands, textures, kPoints);
  ID3D12DescriptorHeap* const set = heap.get();
  commands->SetDescriptorHeaps(1, &set);
  commands->SetGraphicsRootSignature(root.get());
  commands->SetGraphicsRootDescriptorTable(0, heap->GetGPUDescriptorHandleForHeapStart());
  commands->SetPipelineState(backend().points(kind));
  commands->DrawInstanced(static_cast<UINT>(kPoints.size()), 1, 0, 0);
  vitrailD3d12Collected(host.target(), commands.get());
  host.resolve(commands.get(), textures, 0);
  vitrailD3d12End(host.target(), commands.get());
  commands.run();
  const PointResult result = host.read(textures, 0);
  EXPECT_EQ(result.stats.fragmentsStored, kPoints.size());
  EXPECT_TRUE(result.pixels == expected.pixels);
}

// With descriptors of the host's the target may be resized time and again, and runs out of none.
TEST_F(CallsTest, DescriptorsOfTheHostLastAcrossResizes) {
  HostDesc desc;
  desc.capacity = 16;
  VitrailD3d12Requirements needs{};
  VitrailD3d12TargetDesc asked = smallTarget();
  ASSERT_EQ(vitrailD3d12TargetRequirements(backend().context(), &asked, &needs), VITRAIL_SUCCESS);
  EXPECT_GT(needs.size, 2 * 65536U);
  EXPECT_EQ(needs.alignment, 65536U);
  const auto heap = device().makeHeap(D3D12_DESCRIPTOR_HEAP_TYPE_CBV_SRV_UAV, needs.descriptors, /*visible=*/true);
  D3d12Host host(backend(), desc, [&](VitrailD3d12TargetDesc& target) {
    target.descriptorHeap = heap.get();
    target.descriptorCount = needs.descriptors;
  });
  host.setHeap(heap.get());
  for (std::uint32_t i = 0; i < 8; ++i) {
    const auto results = host.drawAcrossResize(kPoints, {8 + i % 3, 8}, kPoints, 16);
    EXPECT_EQ(results[0].stats.complete, 1U);
    EXPECT_EQ(results[1].stats.complete, 1U);
  }
}

// ---- Targets

TEST_F(CallsTest, AreMadeFromC) {
  VitrailD3d12Context context = nullptr;
  EXPECT_EQ(contextFromC(device().get(), &context), VITRAIL_SUCCESS);
  EXPECT_GT(vitrailD3d12MaxNodeCapacity(context, VITRAIL_NODE_STANDARD, 1), 1000000U);
  EXPECT_EQ(vitrailD3d12MaxNodeCapacity(context, VITRAIL_NODE_COMPACT, 8), 0U);
  vitrailD3d12DestroyContext(context);
}

// Targets may be destroyed after the context that they were made with.
TEST_F(CallsTest, AContextIsFreedWithTheLastOfItsTargets) {
  VitrailD3d12Context context = nullptr;
  VitrailD3d12ContextDesc contextDesc = backend().contextDesc();
  contextDesc.memoryBytes = 1 << 20U;
  ASSERT_EQ(vitrailD3d12CreateContext(&contextDesc, &context), VITRAIL_SUCCESS);
  VitrailD3d12TargetDesc desc = smallTarget();
  VitrailD3d12Target target = nullptr;
  desc.nodeCapacity = 1'000'000;
  EXPECT_EQ(vitrailD3d12CreateTarget(context, &desc, &target), VITRAIL_ERROR_OUT_OF_MEMORY);
  expectOneLine("nodeCapacity"); // memoryBytes
  desc.nodeCapacity = 16;
  ASSERT_EQ(vitrailD3d12CreateTarget(context, &desc, &target), VITRAIL_SUCCESS);
  vitrailD3d12DestroyContext(context);
  expectOneLine("targets are left");
  CommandList commands;
  vitrailD3d12Begin(target, commands.get(), nullptr);
  commands.run();
  vitrailD3d12DestroyTarget(target);
}

// A resolve by fragment writes the first render target only.
TEST_F(CallsTest, OtherRenderTargetsAreNotWritten) {
  HostDesc desc;
  desc.resolve = VITRAIL_RESOLVE_FRAGMENT;
  desc.dualSourceBlending = false; // VitrailD3d12TargetDesc::severalRenderTargets
  desc.capacity = 16;
  const PointResult alone = D3d12Host(backend(), desc).draw(kPoints);
  D3d12Host host(backend(), desc,
                 [](VitrailD3d12TargetDesc& target) { target.otherFormats[0] = DXGI_FORMAT_R32G32B32A32_FLOAT; });
  PointTextures others(desc);
  constexpr FloatColor kColor = {0.125F, 0.25F, 0.5F, 0.75F};
  CommandList commands;
  PointTextures& textures = host.texturesOf(0);
  host.drawOpaque(commands.get(), textures);
  commands->ClearRenderTargetView(others.colorTarget(), kColor.data(), 0, nullptr);
  host.begin(commands.get(), 0, {});
  host.drawPoints(commands.get(), commands, textures, kPoints);
  vitrailD3d12Collected(host.target(), commands.get());
  const std::array<D3D12_CPU_DESCRIPTOR_HANDLE, 2> targets = {textures.colorTarget(), others.colorTarget()};
  commands->OMSetRenderTargets(targets.size(), targets.data(), FALSE, nullptr);
  vitrailD3d12Resolve(host.target(), commands.get(), nullptr);
  vitrailD3d12End(host.target(), commands.get());
  commands.run();
  EXPECT_TRUE(host.read(textures, 0).pixels == alone.pixels);
  const std::vector<FloatColor> other = host.pixels(others);
  EXPECT_TRUE(std::all_of(other.begin(), other.end(), [&](const auto& color) { return color == kColor; }));
}

TEST_F(CallsTest, TexturesAndFormatsAreChecked) {
  HostDesc host;
  const PointTextures textures(host);
  host.width = 4;
  const PointTextures small(host);
  ID3D12Resource* color = textures.color.resource.get();
  VitrailD3d12TargetDesc desc = smallTarget();
  desc.resolve = VITRAIL_RESOLVE_COMPUTE;
  VitrailD3d12Target target = nullptr;
  EXPECT_NE(vitrailD3d12CreateTarget(backend().context(), &desc, &target), VITRAIL_SUCCESS);
  expectOneLine("views.color");
  desc.views.count = 1;
  desc.views.color = &color; // of 32-bit floats
  expectRefused(desc, VITRAIL_ERROR_FORMAT, "colorFormat");
  desc.colorFormat = DXGI_FORMAT_R8G8B8A8_UNORM;
  expectRefused(desc, VITRAIL_ERROR_FORMAT, "colorFormat");
  desc.colorFormat = DXGI_FORMAT_R32G32B32A32_FLOAT;
  color = small.color.resource.get();
  expectRefused(desc, VITRAIL_ERROR_INVALID, "pixels");
  const auto buffer = device().makeBuffer(4096, D3D12_HEAP_TYPE_DEFAULT);
  color = buffer.get();
  expectRefused(desc, VITRAIL_ERROR_INVALID, "not a 2D texture");
  color = nullptr;
  expectRefused(desc, VITRAIL_ERROR_INVALID, "color[0]");
  desc = smallTarget();
  desc.stencilMask = 0x100;
  expectRefused(desc, VITRAIL_ERROR_INVALID, "stencilMask");
  desc = smallTarget();
  desc.stencilMark = 1; // without a format that has a stencil
  expectRefused(desc, VITRAIL_ERROR_INVALID, "stencil");
  desc = smallTarget();
  desc.samples = 4;
  desc.views.count = 1;
  color = textures.color.resource.get();
  desc.views.opaque = &color; // of one sample
  desc.views.depth = &color;
  expectRefused(desc, VITRAIL_ERROR_INVALID, "samples");
}

TEST_F(CallsTest, HeapsOfTheHostAreChecked) {
  D3D12_HEAP_DESC heapDesc{};
  heapDesc.SizeInBytes = 65536;
  heapDesc.Properties.Type = D3D12_HEAP_TYPE_DEFAULT;
  heapDesc.Flags = D3D12_HEAP_FLAG_ALLOW_ONLY_BUFFERS;
  Com<ID3D12Heap> heap;
  check(device().get()->CreateHeap(&heapDesc, VITRAIL_TEST_ID(ID3D12Heap), outOf(heap)), "CreateHeap");
  VitrailD3d12TargetDesc desc = smallTarget();
  desc.heap = heap.get();
  expectRefused(desc, VITRAIL_ERROR_INVALID, "heapSize");
  desc.heapOffset = 256;
  desc.heapSize = 1 << 20U;
  expectRefused(desc, VITRAIL_ERROR_INVALID, "heapOffset");
  desc = smallTarget();
  const auto hidden = device().makeHeap(D3D12_DESCRIPTOR_HEAP_TYPE_CBV_SRV_UAV, 16);
  desc.descriptorHeap = hidden.get();
  desc.descriptorCount = 16;
  expectRefused(desc, VITRAIL_ERROR_INVALID, "shader-visible");
  const auto small = device().makeHeap(D3D12_DESCRIPTOR_HEAP_TYPE_CBV_SRV_UAV, 16, /*visible=*/true);
  desc.descriptorHeap = small.get();
  desc.descriptorCount = 4096;
  expectRefused(desc, VITRAIL_ERROR_INVALID, "descriptorCount");
}

TEST_F(CallsTest, ATargetInTheHostsMemoryIsNotResized) {
  HostDesc desc;
  desc.capacity = 16;
  desc.guarded = true;
  const D3d12Host host(backend(), desc);
  VitrailD3d12ResizeInfo info{};
  info.width = info.height = 8;
  EXPECT_EQ(vitrailD3d12ResizeTarget(host.target(), &info), VITRAIL_ERROR_INVALID);
  expectOneLine("host's memory");
}

TEST_F(CallsTest, NullIsRefusedOrIgnored) {
  VitrailD3d12Target none = nullptr;
  vitrailD3d12Begin(none, nullptr, nullptr);
  vitrailD3d12Bind(none, nullptr, 0);
  vitrailD3d12WriteDescriptors(none, 0);
  vitrailD3d12Collected(none, nullptr);
  vitrailD3d12BindLists(none, nullptr, 0, 0);
  vitrailD3d12UnbindLists(none, nullptr);
  vitrailD3d12CopyLists(none, nullptr, nullptr);
  vitrailD3d12Resolve(none, nullptr, nullptr);
  vitrailD3d12End(none, nullptr);
  vitrailD3d12TilePlanTarget(nullptr, nullptr);
  vitrailD3d12DestroyTarget(none);
  vitrailD3d12DestroyContext(nullptr);
  EXPECT_EQ(vitrailD3d12CopySize(none, 1, 1), 0U);
  EXPECT_EQ(vitrailD3d12UpdateTarget(none, 0), VITRAIL_ERROR_INVALID);
  EXPECT_EQ(vitrailD3d12ReadStats(none, 0, nullptr), VITRAIL_ERROR_INVALID);
  EXPECT_EQ(vitrailD3d12CreateContext(nullptr, nullptr), VITRAIL_ERROR_INVALID);
  VitrailD3d12ContextDesc contextDesc = backend().contextDesc();
  contextDesc.device = nullptr;
  VitrailD3d12Context context = nullptr;
  EXPECT_EQ(vitrailD3d12CreateContext(&contextDesc, &context), VITRAIL_ERROR_INVALID);
  expectOneLine("device");
  EXPECT_EQ(vitrailD3d12CreateTarget(backend().context(), nullptr, nullptr), VITRAIL_ERROR_INVALID);
  expectOneLine("vitrailD3d12CreateTarget");
  VitrailD3d12TargetDesc desc = smallTarget();
  VitrailD3d12Target target = nullptr;
  ASSERT_EQ(vitrailD3d12CreateTarget(backend().context(), &desc, &target), VITRAIL_SUCCESS);
  EXPECT_EQ(vitrailD3d12TargetResolve(target), VITRAIL_RESOLVE_FRAGMENT);
  vitrailD3d12Begin(target, nullptr, nullptr);
  expectOneLine("no command list");
  vitrailD3d12DestroyTarget(target);
  desc.next = &desc;
  expectRefused(desc, VITRAIL_ERROR_INVALID, "next");
}

} // namespace
} // namespace vitrail::tests::d3d12
