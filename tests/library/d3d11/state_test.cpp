// What the calls leave of a context's state: all of it, but for what they say.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "point_host.h"

namespace vitrail::tests::d3d11 {
namespace {

// Everything that the library sets, as it is.
struct State {
  std::vector<const void*> bound;
  std::vector<UINT> numbers;
  bool operator==(const State&) const = default;
};

template <class Interface>
void note(State& state, Interface* one) {
  state.bound.push_back(one);
  if (one != nullptr) one->Release(); // the Get call took one
}

template <class Array>
void noteAll(State& state, const Array& interfaces) {
  for (auto* one : interfaces) note(state, one);
}

void noteShaders(State& state, ID3D11DeviceContext* commands) {
  ID3D11VertexShader* vertex = nullptr;
  ID3D11HullShader* hull = nullptr;
  ID3D11DomainShader* domain = nullptr;
  ID3D11GeometryShader* geometry = nullptr;
  ID3D11PixelShader* pixel = nullptr;
  ID3D11ComputeShader* compute = nullptr;
  commands->VSGetShader(&vertex, nullptr, nullptr);
  commands->HSGetShader(&hull, nullptr, nullptr);
  commands->DSGetShader(&domain, nullptr, nullptr);
  commands->GSGetShader(&geometry, nullptr, nullptr);
  commands->PSGetShader(&pixel, nullptr, nullptr);
  commands->CSGetShader(&compute, nullptr, nullptr);
  note(state, vertex);
  note(state, hull);
  note(state, domain);
  note(state, geometry);
  note(state, pixel);
  note(state, compute);
}

void noteResources(State& state, ID3D11DeviceContext* commands) {
  std::array<ID3D11Buffer*, D3D11_COMMONSHADER_CONSTANT_BUFFER_API_SLOT_COUNT> constants{};
  constexpr auto kConstants = static_cast<UINT>(constants.size());
  for (auto get : {&ID3D11DeviceContext::VSGetConstantBuffers, &ID3D11DeviceContext::PSGetConstantBuffers,
                   &ID3D11DeviceContext::CSGetConstantBuffers}) {
    (commands->*get)(0, kConstants, constants.data());
    noteAll(state, constants);
  }
  std::array<ID3D11ShaderResourceView*, D3D11_COMMONSHADER_INPUT_RESOURCE_SLOT_COUNT> resources{};
  constexpr auto kResources = static_cast<UINT>(resources.size());
  for (auto get : {&ID3D11DeviceContext::PSGetShaderResources, &ID3D11DeviceContext::CSGetShaderResources}) {
    (commands->*get)(0, kResources, resources.data());
    noteAll(state, resources);
  }
  std::array<ID3D11UnorderedAccessView*, D3D11_PS_CS_UAV_REGISTER_COUNT> views{};
  commands->CSGetUnorderedAccessViews(0, views.size(), views.data());
  noteAll(state, views);
}

void noteFixedFunction(State& state, ID3D11DeviceContext* commands) {
  ID3D11InputLayout* layout = nullptr;
  commands->IAGetInputLayout(&layout);
  note(state, layout);
  D3D11_PRIMITIVE_TOPOLOGY topology{};
  commands->IAGetPrimitiveTopology(&topology);
  ID3D11RasterizerState* raster = nullptr;
  commands->RSGetState(&raster);
  note(state, raster);
  std::array<D3D11_VIEWPORT, 16> viewports{};
  UINT viewportCount = viewports.size();
  commands->RSGetViewports(&viewportCount, viewports.data());
  std::array<D3D11_RECT, 16> scissors{};
  UINT scissorCount = scissors.size();
  commands->RSGetScissorRects(&scissorCount, scissors.data());
  ID3D11BlendState* blend = nullptr;
  std::array<FLOAT, 4> factor{};
  UINT mask = 0;
  commands->OMGetBlendState(&blend, factor.data(), &mask);
  note(state, blend);
  ID3D11DepthStencilState* depth = nullptr;
  UINT reference = 0;
  commands->OMGetDepthStencilState(&depth, &reference);
  note(state, depth);
  ID3D11Predicate* predicate = nullptr;
  BOOL value = FALSE;
  commands->GetPredication(&predicate, &value);
  note(state, predicate);
  state.numbers = {static_cast<UINT>(topology),
                   viewportCount,
                   static_cast<UINT>(viewports[0].Width),
                   static_cast<UINT>(viewports[1].Width),
                   scissorCount,
                   static_cast<UINT>(scissors[0].right),
                   static_cast<UINT>(scissors[1].bottom),
                   mask,
                   reference,
                   static_cast<UINT>(factor[1] * 256.0F),
                   static_cast<UINT>(value)};
}

State stateOf(ID3D11DeviceContext* commands, bool pixelViews) {
  State state;
  noteShaders(state, commands);
  noteResources(state, commands);
  noteFixedFunction(state, commands);
  std::array<ID3D11RenderTargetView*, 1> targets{};
  ID3D11DepthStencilView* depth = nullptr;
  std::array<ID3D11UnorderedAccessView*, 7> views{};
  commands->OMGetRenderTargetsAndUnorderedAccessViews(1, targets.data(), &depth, 1, views.size(), views.data());
  noteAll(state, targets);
  note(state, depth);
  if (pixelViews) {
    noteAll(state, views);
  } else {
    State ignored;
    noteAll(ignored, views);
  }
  return state;
}

// As words, for messages: which of the bound objects, or numbers, differ.
std::string differences(const State& before, const State& after) {
  std::string text;
  for (std::size_t i = 0; i < before.bound.size(); ++i) {
    if (before.bound[i] != after.bound[i]) text += " object " + std::to_string(i);
  }
  for (std::size_t i = 0; i < before.numbers.size(); ++i) {
    if (before.numbers[i] != after.numbers[i]) text += " number " + std::to_string(i);
  }
  return text;
}

void expectSame(const State& before, const State& after, const char* call) {
  EXPECT_TRUE(before == after) << call << " changes" << differences(before, after);
}

// What a host might have set, in every place.
class HostileState {
 public:
  explicit HostileState(const HostDesc& desc, PointTextures& textures) {
    ID3D11DeviceContext* commands = device().immediate();
    ID3D11Device* on = device().get();
    constants_ = device().makeBuffer(256, D3D11_BIND_CONSTANT_BUFFER, 0);
    constexpr UINT kRaw = D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS;
    read_ = device().makeBuffer(256, D3D11_BIND_SHADER_RESOURCE, kRaw);
    D3D11_SHADER_RESOURCE_VIEW_DESC seen{};
    seen.Format = DXGI_FORMAT_R32_TYPELESS;
    seen.ViewDimension = D3D11_SRV_DIMENSION_BUFFEREX;
    seen.BufferEx.NumElements = 64;
    seen.BufferEx.Flags = D3D11_BUFFEREX_SRV_FLAG_RAW;
    check(on->CreateShaderResourceView(read_.get(), &seen, readView_.out()), "CreateShaderResourceView");
    for (std::size_t i = 0; i < written_.size(); ++i) {
      written_.at(i) = device().makeBuffer(256, D3D11_BIND_UNORDERED_ACCESS, kRaw);
      writtenViews_.at(i) = device().makeRawView(written_.at(i).get(), 256);
    }
    D3D11_QUERY_DESC query{D3D11_QUERY_OCCLUSION_PREDICATE, 0};
    check(on->CreatePredicate(&query, predicate_.out()), "CreatePredicate");
    commands->Begin(predicate_.get());
    commands->End(predicate_.get()); // nothing was drawn: commands under it are left out
    set(commands, desc, textures);
  }

 private:
  void set(ID3D11DeviceContext* commands, const HostDesc& desc, PointTextures& textures) {
    ID3D11Device* on = device().get();
    std::array<ID3D11Buffer*, D3D11_COMMONSHADER_CONSTANT_BUFFER_API_SLOT_COUNT> constants{};
    constants.fill(constants_.get());
    commands->VSSetConstantBuffers(0, constants.size(), constants.data());
    commands->PSSetConstantBuffers(0, constants.size(), constants.data());
    commands->CSSetConstantBuffers(0, constants.size(), constants.data());
    std::array<ID3D11ShaderResourceView*, D3D11_COMMONSHADER_INPUT_RESOURCE_SLOT_COUNT> resources{};
    resources.fill(readView_.get());
    commands->PSSetShaderResources(0, resources.size(), resources.data());
    commands->CSSetShaderResources(0, resources.size(), resources.data());
    std::array<ID3D11UnorderedAccessView*, 7> views{};
    for (std::size_t i = 0; i < views.size(); ++i) views.at(i) = writtenViews_.at(i).get();
    commands->CSSetUnorderedAccessViews(0, views.size(), views.data(), nullptr);
    commands->VSSetShader(backend().vertexShader("points"), nullptr, 0);
    commands->PSSetShader(backend().pixelShader("opaque"), nullptr, 0);
    commands->CSSetShader(backend().computeShader("walk"), nullptr, 0);
    commands->IASetInputLayout(backend().pointLayout());
    commands->IASetPrimitiveTopology(D3D11_PRIMITIVE_TOPOLOGY_LINESTRIP);
    D3D11_RASTERIZER_DESC raster{};
    raster.FillMode = D3D11_FILL_WIREFRAME;
    raster.CullMode = D3D11_CULL_FRONT;
    raster.DepthClipEnable = FALSE;
    check(on->CreateRasterizerState(&raster, raster_.out()), "CreateRasterizerState");
    commands->RSSetState(raster_.get());
    const std::array<D3D11_VIEWPORT, 2> viewports = {{{0, 0, 3, 2, 0.5F, 0.6F}, {0, 0, 5, 4, 0, 1}}};
    commands->RSSetViewports(viewports.size(), viewports.data());
    const std::array<D3D11_RECT, 2> scissors = {{{0, 0, 1, 1}, {0, 0, 2, 2}}};
    commands->RSSetScissorRects(scissors.size(), scissors.data());
    D3D11_BLEND_DESC blend{};
    blend.RenderTarget[0] = {TRUE,
                             D3D11_BLEND_BLEND_FACTOR,
                             D3D11_BLEND_DEST_COLOR,
                             D3D11_BLEND_OP_MAX,
                             D3D11_BLEND_ZERO,
                             D3D11_BLEND_ZERO,
                             D3D11_BLEND_OP_MIN,
                             1};
    check(on->CreateBlendState(&blend, blend_.out()), "CreateBlendState");
    constexpr std::array<FLOAT, 4> kFactor = {0.25F, 0.5F, 0.75F, 1.0F};
    commands->OMSetBlendState(blend_.get(), kFactor.data(), 0x2);
    D3D11_DEPTH_STENCIL_DESC depth{};
    depth.DepthEnable = TRUE;
    depth.DepthFunc = D3D11_COMPARISON_NEVER;
    check(on->CreateDepthStencilState(&depth, depth_.out()), "CreateDepthStencilState");
    commands->OMSetDepthStencilState(depth_.get(), 7);
    commands->SetPredication(predicate_.get(), FALSE);
    ID3D11RenderTargetView* const target = textures.colorTarget.get();
    const bool draws = desc.resolve == VITRAIL_RESOLVE_FRAGMENT;
    commands->OMSetRenderTargetsAndUnorderedAccessViews(draws ? 1 : 0, draws ? &target : nullptr, nullptr, 7, 1,
                                                        &views[6], nullptr);
    commands->CSSetUnorderedAccessViews(0, 6, views.data(), nullptr);
  }

  Com<ID3D11Buffer> constants_;
  Com<ID3D11Buffer> read_;
  Com<ID3D11ShaderResourceView> readView_;
  std::array<Com<ID3D11Buffer>, 7> written_;
  std::array<Com<ID3D11UnorderedAccessView>, 7> writtenViews_;
  Com<ID3D11Predicate> predicate_;
  Com<ID3D11RasterizerState> raster_;
  Com<ID3D11BlendState> blend_;
  Com<ID3D11DepthStencilState> depth_;
};

class StateTest : public D3d11Test, public ::testing::WithParamInterface<VitrailResolve> {};
INSTANTIATE_TEST_SUITE_P(, StateTest,
                         ::testing::Values(VITRAIL_RESOLVE_COMPUTE, VITRAIL_RESOLVE_FRAGMENT, VITRAIL_RESOLVE_HOST));

// Under state that would ruin every pass of the library, the frame is right, and the state is as it was.
TEST_P(StateTest, IsPutBackAndDoesNotMatter) {
  HostDesc desc;
  desc.resolve = GetParam();
  desc.capacity = 100;
  desc.copyLayers = 128;
  const std::vector<Point> points = {{1, 1, 0.5F, {1.0F, 0.5F, 0.25F, 0.5F}}, {1, 1, 0.25F, {0.0F, 1.0F, 0.0F, 0.5F}}};
  const PointResult expected = D3d11Host(backend(), desc).draw(points);
  D3d11Host host(backend(), desc);
  PointTextures& textures = host.texturesOf(0);
  ID3D11DeviceContext* commands = device().immediate();
  host.drawOpaque(commands, textures);
  {
    const HostileState hostile(desc, textures);
    const State before = stateOf(commands, true);
    host.begin(commands, 0, {});
    expectSame(before, stateOf(commands, true), "vitrailD3d11Begin");
    commands->SetPredication(nullptr, FALSE); // what the host draws is its own affair
    commands->ClearState();
  }
  host.drawPoints(commands, textures, points);
  {
    const HostileState hostile(desc, textures);
    const State withoutViews = stateOf(commands, false);
    vitrailD3d11Collected(host.target(), commands); // which unbinds what vitrailD3d11Bind() bound
    expectSame(withoutViews, stateOf(commands, false), "vitrailD3d11Collected");
  }
  {
    const HostileState hostile(desc, textures);
    const State before = stateOf(commands, true);
    const auto copied = device().makeBuffer(vitrailD3d11CopySize(host.target(), 8, 8), D3D11_BIND_SHADER_RESOURCE,
                                            D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS);
    VitrailD3d11CopyInfo copy{};
    copy.area = {0, 0, 8, 8};
    copy.buffer = copied.get();
    copy.size = vitrailD3d11CopySize(host.target(), 8, 8);
    vitrailD3d11CopyLists(host.target(), commands, &copy);
    expectSame(before, stateOf(commands, true), "vitrailD3d11CopyLists");
    vitrailD3d11Resolve(host.target(), commands, nullptr);
    expectSame(before, stateOf(commands, true), "vitrailD3d11Resolve");
    vitrailD3d11End(host.target(), commands);
    expectSame(before, stateOf(commands, true), "vitrailD3d11End");
    commands->SetPredication(nullptr, FALSE);
    commands->ClearState();
  }
  const PointResult result = host.read(textures, 0);
  EXPECT_TRUE(result.pixels == expected.pixels);
  EXPECT_EQ(result.stats.complete, 1U);
  EXPECT_EQ(result.stats.fragmentsStored, 2U);
}

} // namespace
} // namespace vitrail::tests::d3d11
