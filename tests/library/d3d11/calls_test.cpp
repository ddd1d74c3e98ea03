// What only Direct3D 11's calls have: deferred contexts, slots, views, buffers of the host's, null and order.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "../expected.h"
#include "point_host.h"

extern "C" VitrailResult contextFromC(ID3D11Device* device, VitrailD3d11Context* context); // plain_c.c

namespace vitrail::tests::d3d11 {
namespace {

class CallsTest : public D3d11Test {};

VitrailD3d11TargetDesc smallTarget() {
  VitrailD3d11TargetDesc desc{};
  desc.width = 8;
  desc.height = 8;
  desc.nodeCapacity = 16;
  desc.resolve = VITRAIL_RESOLVE_FRAGMENT;
  return desc;
}

TEST_F(CallsTest, DeferredContextsGiveTheSameBits) {
  for (const VitrailResolve resolve : {VITRAIL_RESOLVE_COMPUTE, VITRAIL_RESOLVE_FRAGMENT}) {
    for (const VitrailListBuild build : {VITRAIL_LIST_BUILD_FRAGMENT, VITRAIL_LIST_BUILD_COMPUTE}) {
      HostDesc desc;
      desc.resolve = resolve;
      desc.listBuild = build;
      desc.behind = {0.25F, 0.5F, 1.0F, 1.0F};
      const std::vector<Point> points = randomLists(desc, {0, 1, 2, 16, 17, 40, 200}, 3);
      desc.capacity = static_cast<std::uint32_t>(points.size());
      const PointResult immediate = D3d11Host(backend(), desc).draw(points);
      D3d11Host host(backend(), desc, true);
      for (const PointResult& deferred : host.drawTogether({points, points})) {
        EXPECT_TRUE(deferred.pixels == immediate.pixels);
        EXPECT_EQ(deferred.stats.complete, 1U);
        EXPECT_EQ(deferred.stats.fragmentsStored, points.size());
      }
    }
  }
}

// A frame whose command list is never executed has no statistics, and does not spoil the next one.
TEST_F(CallsTest, AFrameThatIsNotExecutedHasNoStatistics) {
  HostDesc desc;
  desc.capacity = 16;
  D3d11Host host(backend(), desc);
  const std::vector<Point> points = {{1, 1, 0.5F, {1.0F, 0.5F, 0.25F, 0.5F}}};
  host.drop(points);
  EXPECT_FALSE(host.stats(0).has_value());
  const PointResult result = host.draw(points);
  EXPECT_EQ(result.stats.complete, 1U);
  EXPECT_EQ(result.stats.fragmentsStored, 1U);
}

// Reading never waits: where the GPU has not run a frame, there is nothing; once it has, its statistics. A long frame
// is recorded, and asked for at once.
TEST_F(CallsTest, ReadingStatisticsDoesNotWait) {
  HostDesc desc = squareHost();
  const std::vector<Point> points = manyLists(desc, 600, 3);
  desc.capacity = static_cast<std::uint32_t>(points.size());
  D3d11Host host(backend(), desc);
  host.draw(points); // shaders are made
  PointTextures& textures = host.texturesOf(1);
  ID3D11DeviceContext* commands = device().immediate();
  host.drawOpaque(commands, textures);
  host.begin(commands, 1, {});
  host.drawPoints(commands, textures, points);
  vitrailD3d11Collected(host.target(), commands);
  vitrailD3d11Resolve(host.target(), commands, nullptr);
  vitrailD3d11End(host.target(), commands);
  EXPECT_FALSE(host.stats(1).has_value()) << "lists of " << points.size() << " fragments were done at once";
  EXPECT_EQ(host.read(textures, 1).stats.fragmentsStored, points.size()); // waits for the picture
}

TEST_F(CallsTest, AreMadeFromC) {
  VitrailD3d11Context context = nullptr;
  EXPECT_EQ(contextFromC(device().get(), &context), VITRAIL_SUCCESS);
  EXPECT_GT(vitrailD3d11MaxNodeCapacity(context, VITRAIL_NODE_STANDARD, 1), 1000000U);
  EXPECT_EQ(vitrailD3d11MaxNodeCapacity(context, VITRAIL_NODE_COMPACT, 8), 0U);
  vitrailD3d11DestroyContext(context);
}

// Targets may be destroyed after the context that they were made with.
TEST_F(CallsTest, AContextIsFreedWithTheLastOfItsTargets) {
  VitrailD3d11Context context = nullptr;
  const VitrailD3d11ContextDesc contextDesc = backend().contextDesc();
  ASSERT_EQ(vitrailD3d11CreateContext(&contextDesc, &context), VITRAIL_SUCCESS);
  const VitrailD3d11TargetDesc desc = smallTarget();
  VitrailD3d11Target target = nullptr;
  ASSERT_EQ(vitrailD3d11CreateTarget(context, &desc, &target), VITRAIL_SUCCESS);
  vitrailD3d11DestroyContext(context);
  expectOneLine("targets are left");
  vitrailD3d11Begin(target, device().immediate(), nullptr);
  vitrailD3d11DestroyTarget(target);
}

// A resolve by fragment writes the first render target only.
TEST_F(CallsTest, OtherRenderTargetsAreNotWritten) {
  HostDesc desc;
  desc.resolve = VITRAIL_RESOLVE_FRAGMENT;
  desc.dualSourceBlending = false; // VitrailD3d11TargetDesc::severalRenderTargets
  desc.capacity = 16;
  const std::vector<Point> points = {{1, 1, 0.5F, {1.0F, 0.5F, 0.25F, 0.5F}}, {2, 1, 0.5F, {0.0F, 0.5F, 1.0F, 0.25F}}};
  const PointResult alone = D3d11Host(backend(), desc).draw(points);
  D3d11Host host(backend(), desc);
  const PointTextures others(desc);
  constexpr FloatColor kColor = {0.125F, 0.25F, 0.5F, 0.75F};
  ID3D11DeviceContext* commands = device().immediate();
  PointTextures& textures = host.texturesOf(0);
  host.drawOpaque(commands, textures);
  commands->ClearRenderTargetView(others.colorTarget.get(), kColor.data());
  host.begin(commands, 0, {});
  host.drawPoints(commands, textures, points);
  vitrailD3d11Collected(host.target(), commands);
  const std::array<ID3D11RenderTargetView*, 2> targets = {textures.colorTarget.get(), others.colorTarget.get()};
  commands->OMSetRenderTargets(targets.size(), targets.data(), nullptr);
  vitrailD3d11Resolve(host.target(), commands, nullptr);
  vitrailD3d11End(host.target(), commands);
  EXPECT_TRUE(host.read(textures, 0).pixels == alone.pixels);
  const PointResult other = host.read(others, 0);
  EXPECT_TRUE(
      std::all_of(other.pixels.begin(), other.pixels.end(), [&](const auto& color) { return color == kColor; }));
}

TEST_F(CallsTest, SlotsAreChecked) {
  VitrailD3d11ContextDesc desc = backend().contextDesc();
  VitrailD3d11Context context = nullptr;
  desc.constantSlot = D3D11_COMMONSHADER_CONSTANT_BUFFER_API_SLOT_COUNT;
  EXPECT_EQ(vitrailD3d11CreateContext(&desc, &context), VITRAIL_ERROR_INVALID);
  expectOneLine("constantSlot");
  desc = backend().contextDesc();
  desc.uavSlot = D3D11_1_UAV_SLOT_COUNT - 3;
  EXPECT_EQ(vitrailD3d11CreateContext(&desc, &context), VITRAIL_ERROR_INVALID);
  expectOneLine("uavSlot");
  desc = backend().contextDesc();
  desc.listSlot = D3D11_COMMONSHADER_INPUT_RESOURCE_SLOT_COUNT - 2;
  EXPECT_EQ(vitrailD3d11CreateContext(&desc, &context), VITRAIL_ERROR_INVALID);
  expectOneLine("listSlot");
  desc = backend().contextDesc();
  desc.device = nullptr;
  EXPECT_EQ(vitrailD3d11CreateContext(&desc, &context), VITRAIL_ERROR_INVALID);
  expectOneLine("device");
  EXPECT_EQ(context, nullptr);
}

TEST_F(CallsTest, ViewsAndFormatsAreChecked) {
  HostDesc host;
  const PointTextures textures(host);
  ID3D11UnorderedAccessView* color = textures.colorWritten.get();
  VitrailD3d11TargetDesc desc = smallTarget();
  VitrailD3d11Target target = nullptr;
  desc.resolve = VITRAIL_RESOLVE_COMPUTE;
  EXPECT_NE(vitrailD3d11CreateTarget(backend().context(), &desc, &target), VITRAIL_SUCCESS);
  expectOneLine("views.color");
  desc.views.count = 1;
  desc.views.color = &color; // of 32-bit floats
  EXPECT_EQ(vitrailD3d11CreateTarget(backend().context(), &desc, &target), VITRAIL_ERROR_FORMAT);
  expectOneLine("colorFormat");
  desc.colorFormat = DXGI_FORMAT_R8G8B8A8_UNORM;
  EXPECT_EQ(vitrailD3d11CreateTarget(backend().context(), &desc, &target), VITRAIL_ERROR_FORMAT);
  expectOneLine("colorFormat");
  desc.colorFormat = DXGI_FORMAT_R32G32B32A32_FLOAT;
  desc.width = 9;
  EXPECT_EQ(vitrailD3d11CreateTarget(backend().context(), &desc, &target), VITRAIL_ERROR_INVALID);
  expectOneLine("pixels");
  EXPECT_EQ(target, nullptr);
}

TEST_F(CallsTest, BuffersOfTheHostAreChecked) {
  VitrailD3d11TargetDesc desc = smallTarget();
  VitrailD3d11Target target = nullptr;
  std::array<ID3D11Buffer*, VITRAIL_D3D11_BUFFERS> buffers{};
  desc.buffers = buffers.data();
  EXPECT_EQ(vitrailD3d11CreateTarget(backend().context(), &desc, &target), VITRAIL_ERROR_INVALID);
  expectOneLine("buffers[0]");
  const auto small = device().makeBuffer(16, D3D11_BIND_UNORDERED_ACCESS | D3D11_BIND_SHADER_RESOURCE,
                                         D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS);
  buffers.fill(small.get());
  EXPECT_EQ(vitrailD3d11CreateTarget(backend().context(), &desc, &target), VITRAIL_ERROR_INVALID);
  expectOneLine("bytes");
  const auto other = device().makeBuffer(4096, D3D11_BIND_VERTEX_BUFFER, 0);
  buffers.fill(other.get());
  EXPECT_EQ(vitrailD3d11CreateTarget(backend().context(), &desc, &target), VITRAIL_ERROR_INVALID);
  expectOneLine("D3D11_BIND_UNORDERED_ACCESS");
}

TEST_F(CallsTest, NullIsRefusedOrIgnored) {
  VitrailD3d11Target none = nullptr;
  vitrailD3d11Begin(none, nullptr, nullptr);
  vitrailD3d11Bind(none, nullptr);
  vitrailD3d11Collected(none, nullptr);
  vitrailD3d11BindLists(none, nullptr);
  vitrailD3d11UnbindLists(none, nullptr);
  vitrailD3d11CopyLists(none, nullptr, nullptr);
  vitrailD3d11Resolve(none, nullptr, nullptr);
  vitrailD3d11End(none, nullptr);
  vitrailD3d11DestroyTarget(none);
  vitrailD3d11DestroyContext(nullptr);
  EXPECT_EQ(vitrailD3d11UpdateTarget(none, 0), VITRAIL_ERROR_INVALID);
  EXPECT_EQ(vitrailD3d11ReadStats(none, 0, nullptr), VITRAIL_ERROR_INVALID);
  EXPECT_EQ(vitrailD3d11CreateContext(nullptr, nullptr), VITRAIL_ERROR_INVALID);
  EXPECT_EQ(vitrailD3d11CreateTarget(backend().context(), nullptr, nullptr), VITRAIL_ERROR_INVALID);
  expectOneLine("vitrailD3d11CreateTarget");
  VitrailD3d11TargetDesc desc = smallTarget();
  VitrailD3d11Target target = nullptr;
  ASSERT_EQ(vitrailD3d11CreateTarget(backend().context(), &desc, &target), VITRAIL_SUCCESS);
  vitrailD3d11Begin(target, nullptr, nullptr);
  expectOneLine("no device context");
  vitrailD3d11DestroyTarget(target);
}

// Calls that are left out or come twice are said once, and the frame counts as misused.
TEST_F(CallsTest, OutOfOrderIsSaidAndCounts) {
  HostDesc desc;
  desc.capacity = 16;
  D3d11Host host(backend(), desc);
  ID3D11DeviceContext* commands = device().immediate();
  vitrailD3d11Resolve(host.target(), commands, nullptr);
  expectOneLine("vitrailD3d11");
  host.begin(commands, 0, {});
  vitrailD3d11Collected(host.target(), commands);
  vitrailD3d11Collected(host.target(), commands);
  expectOneLine("vitrailD3d11Collected");
  vitrailD3d11Resolve(host.target(), commands, nullptr);
  vitrailD3d11End(host.target(), commands);
  const PointResult result = host.read(host.texturesOf(0), 0);
  EXPECT_EQ(result.stats.misused, 1U);
  EXPECT_EQ(result.stats.complete, 0U);
}

// Slots that the host chooses: the shader's registers are the same.
TEST_F(CallsTest, RegistersAreTheHostsChoice) {
  VitrailD3d11ContextDesc contextDesc = backend().contextDesc();
  contextDesc.constantSlot = 3;
  contextDesc.uavSlot = 2;
  VitrailD3d11Context context = nullptr;
  ASSERT_EQ(vitrailD3d11CreateContext(&contextDesc, &context), VITRAIL_SUCCESS);
  VitrailD3d11TargetDesc desc = smallTarget();
  desc.resolve = VITRAIL_RESOLVE_HOST;
  VitrailD3d11Target target = nullptr;
  ASSERT_EQ(vitrailD3d11CreateTarget(context, &desc, &target), VITRAIL_SUCCESS);
  ID3D11PixelShader* shader = backend().pixelShader(
      "points", {"VITRAIL_REGISTER_PARAMETERS=b3", "VITRAIL_REGISTER_CONTROL=u2", "VITRAIL_REGISTER_HEADS=u3",
                 "VITRAIL_REGISTER_NODES=u4", "VITRAIL_REGISTER_SUMS=u5"});
  HostDesc hostDesc;
  hostDesc.capacity = 16;
  D3d11Host host(backend(), hostDesc); // lends what is to be drawn with
  ID3D11DeviceContext* commands = device().immediate();
  vitrailD3d11Begin(target, commands, nullptr);
  host.setForPoints(commands, host.texturesOf(0));
  vitrailD3d11Bind(target, commands);
  commands->PSSetShader(shader, nullptr, 0);
  const auto vertices = host.setVertices(commands, std::vector<Point>{{1, 1, 0.5F, {1.0F, 0.5F, 0.25F, 0.5F}}});
  commands->Draw(1, 0);
  vitrailD3d11Collected(target, commands);
  vitrailD3d11Resolve(target, commands, nullptr);
  vitrailD3d11End(target, commands);
  commands->ClearState();
  EXPECT_EQ(device().read(vertices.get(), 4).size(), 4U); // waits
  VitrailStats stats{};
  EXPECT_EQ(vitrailD3d11ReadStats(target, 0, &stats), VITRAIL_SUCCESS);
  EXPECT_EQ(stats.fragmentsStored, 1U);
  vitrailD3d11DestroyTarget(target);
  vitrailD3d11DestroyContext(context);
}

} // namespace
} // namespace vitrail::tests::d3d11
