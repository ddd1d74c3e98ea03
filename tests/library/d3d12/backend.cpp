#include "backend.h"

#include <array>
#include <utility>

#include "point_host.h"
#include "test_shaders.h"

namespace vitrail::tests::d3d12 {

namespace {

const Registered<D3d12Backend> registered;

// What the build has compiled: every shader that a test asks for.
std::span<const unsigned char> shader(const std::string& name) {
  for (const auto& [known, code] : kTestShaders) {
    if (known == name) return code;
  }
  throw HostError("the build has not compiled " + name + ": name it in tests/library/d3d12/CMakeLists.txt");
}

template <class Desc>
void setCode(Desc& bytecode, const std::string& name) {
  const auto code = shader(name);
  bytecode = {code.data(), code.size()};
}

D3D12_BLEND_DESC writing(bool color) {
  D3D12_BLEND_DESC blend{};
  for (auto& one : blend.RenderTarget) {
    one.SrcBlend = one.SrcBlendAlpha = D3D12_BLEND_ONE;
    one.DestBlend = one.DestBlendAlpha = D3D12_BLEND_ZERO;
    one.BlendOp = one.BlendOpAlpha = D3D12_BLEND_OP_ADD;
    one.LogicOp = D3D12_LOGIC_OP_NOOP;
    one.RenderTargetWriteMask = color ? UINT8{D3D12_COLOR_WRITE_ENABLE_ALL} : UINT8{0};
  }
  return blend;
}

D3D12_DEPTH_STENCIL_DESC testing(const PointsKind& kind) {
  D3D12_DEPTH_STENCIL_DESC test{};
  test.DepthEnable = kind.depth != DXGI_FORMAT_UNKNOWN ? TRUE : FALSE;
  test.DepthWriteMask = kind.opaque ? D3D12_DEPTH_WRITE_MASK_ALL : D3D12_DEPTH_WRITE_MASK_ZERO;
  test.DepthFunc = kind.opaque ? D3D12_COMPARISON_FUNC_ALWAYS : kind.passes;
  test.StencilEnable = kind.stencil && !kind.opaque ? TRUE : FALSE;
  test.StencilReadMask = 0xff;
  test.StencilWriteMask = 0xff;
  test.FrontFace = {D3D12_STENCIL_OP_KEEP, D3D12_STENCIL_OP_KEEP, D3D12_STENCIL_OP_INCR_SAT,
                    D3D12_COMPARISON_FUNC_ALWAYS};
  test.BackFace = test.FrontFace;
  return test;
}

std::string keyOf(const PointsKind& kind) {
  std::string key = kind.opaque ? "opaque" : kind.shader;
  for (const unsigned number :
       {kind.samples, unsigned{kind.mask}, static_cast<unsigned>(kind.color), static_cast<unsigned>(kind.depth),
        static_cast<unsigned>(kind.passes), kind.stencil ? 1U : 0U}) {
    key += " " + std::to_string(number);
  }
  return key;
}

} // namespace

const Features& D3d12Backend::features() {
  if (open_) return features_;
  open_ = true;
  features_.dualSourceBlending = true;
  features_.sampleRateShading = true;
  features_.stencil = true;
  features_.bindingBytes = std::uint64_t{1} << 29U;
  for (const std::uint32_t count : {2U, 4U, 8U}) {
    const auto has = [&](DXGI_FORMAT format) {
      D3D12_FEATURE_DATA_MULTISAMPLE_QUALITY_LEVELS levels{};
      levels.Format = format;
      levels.SampleCount = count;
      return SUCCEEDED(device().get()->CheckFeatureSupport(D3D12_FEATURE_MULTISAMPLE_QUALITY_LEVELS, &levels,
                                                           sizeof(levels))) &&
             levels.NumQualityLevels > 0;
    };
    if (has(DXGI_FORMAT_R32G32B32A32_FLOAT) && has(DXGI_FORMAT_D32_FLOAT)) features_.multisampled.push_back(count);
  }
  return features_;
}

VitrailD3d12ContextDesc D3d12Backend::contextDesc() {
  VitrailD3d12ContextDesc desc{};
  desc.device = device().get();
  desc.log = [](VitrailLogSeverity severity, const char* message, void* self) {
    static_cast<D3d12Backend*>(self)->log_.push_back({severity, message});
  };
  desc.logUser = this;
  return desc;
}

VitrailD3d12Context D3d12Backend::context() {
  if (context_ != nullptr) return context_;
  const VitrailD3d12ContextDesc desc = contextDesc();
  if (vitrailD3d12CreateContext(&desc, &context_) != VITRAIL_SUCCESS) throw HostError("vitrailD3d12CreateContext");
  return context_;
}

std::unique_ptr<PointHost> D3d12Backend::makeHost(const HostDesc& desc) {
  return std::make_unique<D3d12Host>(*this, desc);
}

VitrailTileLimits D3d12Backend::tileLimits(VitrailNodeFormat format, std::uint32_t samples) {
  VitrailTileLimits limits{};
  if (vitrailD3d12TileLimits(context(), format, samples, &limits) != VITRAIL_SUCCESS) {
    throw HostError("vitrailD3d12TileLimits");
  }
  return limits;
}

std::vector<LogLine> D3d12Backend::takeLog() { return std::exchange(log_, {}); }

std::vector<std::string> D3d12Backend::takeErrors() {
  std::vector<std::string> errors;
  for (const LogLine& line : takeLog()) errors.push_back("the library's log: " + line.text);
  if (open_ && FAILED(device().get()->GetDeviceRemovedReason())) errors.emplace_back("the device was removed");
  return errors;
}

void D3d12Backend::close() {
  pipelines_.clear();
  pointsRoot_ = {};
  opaqueRoot_ = {};
  walkRoot_ = {};
  vitrailD3d12DestroyContext(std::exchange(context_, nullptr));
}

ID3D12RootSignature* D3d12Backend::pointsRoot() {
  if (!pointsRoot_) {
    const std::array parameters = {
        rootDescriptor(D3D12_ROOT_PARAMETER_TYPE_CBV, 13), rootDescriptor(D3D12_ROOT_PARAMETER_TYPE_UAV, 1),
        rootDescriptor(D3D12_ROOT_PARAMETER_TYPE_UAV, 2), rootDescriptor(D3D12_ROOT_PARAMETER_TYPE_UAV, 3),
        rootDescriptor(D3D12_ROOT_PARAMETER_TYPE_UAV, 4)};
    pointsRoot_ = device().makeRoot(parameters);
  }
  return pointsRoot_.get();
}

ID3D12RootSignature* D3d12Backend::opaqueRoot() {
  if (!opaqueRoot_) {
    const std::array parameters = {rootConstants(0, 8)};
    opaqueRoot_ = device().makeRoot(parameters);
  }
  return opaqueRoot_.get();
}

ID3D12RootSignature* D3d12Backend::walkRoot() {
  if (!walkRoot_) {
    const std::array parameters = {rootConstants(0, 8),
                                   rootDescriptor(D3D12_ROOT_PARAMETER_TYPE_UAV, 0),
                                   rootDescriptor(D3D12_ROOT_PARAMETER_TYPE_CBV, 13),
                                   rootDescriptor(D3D12_ROOT_PARAMETER_TYPE_SRV, 120),
                                   rootDescriptor(D3D12_ROOT_PARAMETER_TYPE_SRV, 121),
                                   rootDescriptor(D3D12_ROOT_PARAMETER_TYPE_SRV, 122)};
    walkRoot_ = device().makeRoot(parameters);
  }
  return walkRoot_.get();
}

ID3D12PipelineState* D3d12Backend::points(const PointsKind& kind) {
  Com<ID3D12PipelineState>& kept = pipelines_[keyOf(kind)];
  if (kept) return kept.get();
  constexpr UINT kNext = D3D12_APPEND_ALIGNED_ELEMENT;
  constexpr auto kVertex = D3D12_INPUT_CLASSIFICATION_PER_VERTEX_DATA;
  constexpr std::array<D3D12_INPUT_ELEMENT_DESC, 4> kElements = {{
      {"POSITION", 0, DXGI_FORMAT_R32G32B32_FLOAT, 0, 0, kVertex, 0},
      {"COLOR", 0, DXGI_FORMAT_R32G32B32A32_FLOAT, 0, kNext, kVertex, 0},
      {"BLEND", 0, DXGI_FORMAT_R32_UINT, 0, kNext, kVertex, 0},
      {"WORD", 0, DXGI_FORMAT_R32_UINT, 0, kNext, kVertex, 0},
  }};
  D3D12_GRAPHICS_PIPELINE_STATE_DESC desc{};
  desc.pRootSignature = kind.opaque ? opaqueRoot() : pointsRoot();
  if (kind.root != nullptr) desc.pRootSignature = kind.root;
  setCode(desc.VS, kind.opaque ? "opaque_place" : "points_place");
  setCode(desc.PS, kind.opaque ? "opaque" : kind.shader);
  desc.BlendState = writing(kind.opaque);
  desc.SampleMask = kind.mask;
  desc.RasterizerState.FillMode = D3D12_FILL_MODE_SOLID;
  desc.RasterizerState.CullMode = D3D12_CULL_MODE_NONE;
  desc.RasterizerState.DepthClipEnable = TRUE;
  desc.RasterizerState.MultisampleEnable = kind.samples > 1 ? TRUE : FALSE;
  desc.DepthStencilState = testing(kind);
  if (!kind.opaque) desc.InputLayout = {kElements.data(), countOf(kElements)};
  desc.PrimitiveTopologyType =
      kind.opaque ? D3D12_PRIMITIVE_TOPOLOGY_TYPE_TRIANGLE : D3D12_PRIMITIVE_TOPOLOGY_TYPE_POINT;
  desc.NumRenderTargets = 1;
  desc.RTVFormats[0] = kind.color;
  desc.DSVFormat = kind.depth;
  desc.SampleDesc.Count = kind.samples;
  check(device().get()->CreateGraphicsPipelineState(&desc, VITRAIL_TEST_ID(ID3D12PipelineState), outOf(kept)),
        "CreateGraphicsPipelineState");
  return kept.get();
}

ID3D12PipelineState* D3d12Backend::walk(const std::string& shader) {
  Com<ID3D12PipelineState>& kept = pipelines_[shader];
  if (kept) return kept.get();
  D3D12_COMPUTE_PIPELINE_STATE_DESC desc{};
  desc.pRootSignature = walkRoot();
  setCode(desc.CS, shader);
  check(device().get()->CreateComputePipelineState(&desc, VITRAIL_TEST_ID(ID3D12PipelineState), outOf(kept)),
        "CreateComputePipelineState");
  return kept.get();
}

D3d12Backend& backend() { return Registered<D3d12Backend>::get(); }

void D3d12Test::TearDown() {
  for (const std::string& error : backend().takeErrors()) ADD_FAILURE() << error;
}

} // namespace vitrail::tests::d3d12
