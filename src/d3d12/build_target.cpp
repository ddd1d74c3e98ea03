// What a target is made of: pipelines of its plan, statistics.
#include <algorithm>
#include <new>

#include "target.h"

namespace vitrail {

namespace {

KernelConstants constantsOf(const TargetInfo& info) {
  return {info.samples, info.depthOrder == VITRAIL_DEPTH_NEAREST_IS_ONE ? 1U : 0U, info.maxLayers,
          info.testsDepth() ? 1U : 0U};
}

// C + T * d: one alpha for all channels, or a transmittance of their own. What is written whole is not blended, and of
// other render targets no channel is written.
D3D12_BLEND_DESC blendOf(const TargetInfo& info, bool dual) {
  D3D12_BLEND_DESC blend{};
  blend.IndependentBlendEnable = TRUE;
  for (D3D12_RENDER_TARGET_BLEND_DESC& one : blend.RenderTarget) {
    one.SrcBlend = one.SrcBlendAlpha = D3D12_BLEND_ONE;
    one.DestBlend = one.DestBlendAlpha = D3D12_BLEND_ZERO;
    one.BlendOp = one.BlendOpAlpha = D3D12_BLEND_OP_ADD;
    one.LogicOp = D3D12_LOGIC_OP_NOOP;
  }
  D3D12_RENDER_TARGET_BLEND_DESC& first = blend.RenderTarget[0];
  first.RenderTargetWriteMask = D3D12_COLOR_WRITE_ENABLE_ALL;
  if (info.perPixel()) return blend;
  first.BlendEnable = TRUE;
  first.DestBlend = dual ? D3D12_BLEND_SRC1_COLOR : D3D12_BLEND_INV_SRC_ALPHA;
  first.DestBlendAlpha = dual ? D3D12_BLEND_SRC1_ALPHA : D3D12_BLEND_INV_SRC_ALPHA;
  return blend;
}

D3D12_DEPTH_STENCIL_DESC testOf(const VitrailD3d12TargetDesc& desc, const TargetInfo& info) {
  constexpr UINT8 kAllBits = 0xff;
  D3D12_DEPTH_STENCIL_DESC test{};
  test.DepthFunc = D3D12_COMPARISON_FUNC_ALWAYS;
  test.StencilEnable = info.stencilMark ? TRUE : FALSE;
  test.StencilReadMask = desc.stencilMask != 0 ? static_cast<UINT8>(desc.stencilMask) : kAllBits;
  test.FrontFace = {D3D12_STENCIL_OP_KEEP, D3D12_STENCIL_OP_KEEP, D3D12_STENCIL_OP_KEEP,
                    D3D12_COMPARISON_FUNC_NOT_EQUAL};
  test.BackFace = test.FrontFace;
  return test;
}

void setTargets(const VitrailD3d12TargetDesc& desc, const VitrailD3d12Target_T& target,
                D3D12_GRAPHICS_PIPELINE_STATE_DESC& pipeline) {
  pipeline.NumRenderTargets = 1;
  pipeline.RTVFormats[0] = target.colorFormat;
  if (desc.severalRenderTargets != 0) {
    for (const std::uint32_t format : desc.otherFormats) {
      if (format == 0) break;
      pipeline.RTVFormats[pipeline.NumRenderTargets++] = static_cast<DXGI_FORMAT>(format);
    }
  }
  pipeline.DSVFormat = static_cast<DXGI_FORMAT>(desc.depthStencilFormat);
  pipeline.SampleDesc.Count = target.info.perPixel() ? 1 : target.info.samples;
}

VitrailResult createDraw(const VitrailD3d12Target_T& target, const VitrailD3d12TargetDesc& desc, bool plain,
                         Com<ID3D12PipelineState>& made) {
  const VitrailD3d12Context_T& context = *target.context;
  const TargetInfo& info = target.info;
  const bool dual = desc.severalRenderTargets == 0;
  const FragmentResolve resolve = plain ? FragmentResolve::Plain : fragmentResolve(info, dual);
  const Bytecode vertex = vertexBytecode();
  const Bytecode pixel = pixelBytecode(resolve, info.nodeFormat);
  D3D12_GRAPHICS_PIPELINE_STATE_DESC pipeline{};
  pipeline.pRootSignature = context.drawRoot.get();
  pipeline.VS = {vertex.data(), vertex.size()};
  pipeline.PS = {pixel.data(), pixel.size()};
  pipeline.BlendState = blendOf(info, dual);
  pipeline.SampleMask = UINT32_MAX;
  pipeline.RasterizerState.FillMode = D3D12_FILL_MODE_SOLID;
  pipeline.RasterizerState.CullMode = D3D12_CULL_MODE_NONE;
  pipeline.RasterizerState.DepthClipEnable = TRUE;
  pipeline.RasterizerState.MultisampleEnable = info.perSample() ? TRUE : FALSE;
  pipeline.DepthStencilState = testOf(desc, info);
  pipeline.PrimitiveTopologyType = D3D12_PRIMITIVE_TOPOLOGY_TYPE_TRIANGLE;
  setTargets(desc, target, pipeline);
  const HRESULT result =
      context.device->CreateGraphicsPipelineState(&pipeline, kGuid<ID3D12PipelineState>, outOf(made));
  if (FAILED(result)) {
    return context.log.fail(VITRAIL_ERROR_UNSUPPORTED,
                            "the device takes no pipeline for the resolve with colorFormat %d, depthStencilFormat %u "
                            "and %u samples: 0x%08lx",
                            static_cast<int>(target.colorFormat), desc.depthStencilFormat, pipeline.SampleDesc.Count,
                            static_cast<unsigned long>(result));
  }
  nameObject(made.get(), target.debugName.c_str(), "fragment resolve");
  return VITRAIL_SUCCESS;
}

VitrailResult findPipelines(VitrailD3d12Target_T& target, const VitrailD3d12TargetDesc& desc) {
  for (const Pass& pass : target.plan.passes()) {
    Com<ID3D12PipelineState>& pipeline = target.pipelines.emplace_back();
    VitrailResult result = VITRAIL_SUCCESS;
    if (pass.action == Action::Dispatch) {
      const bool several = pass.call == Call::Resolve && target.info.samples > 1;
      result = findPipeline(*target.context, kernelBytecode(pass.kernel, several, target.info.nodeFormat),
                            kernelName(pass.kernel), pipeline);
    } else if (pass.action == Action::Draw || pass.action == Action::DrawPlain) {
      result = createDraw(target, desc, pass.action == Action::DrawPlain, pipeline);
    }
    if (result != VITRAIL_SUCCESS) return result;
  }
  return VITRAIL_SUCCESS;
}

VitrailResult createStats(VitrailD3d12Target_T& target) {
  const std::uint64_t bytes = statisticsBytes(target.info.framesInFlight);
  const VitrailResult result = createBuffer(*target.context, D3D12_HEAP_TYPE_READBACK, bytes, target.debugName.c_str(),
                                            "statistics", target.stats);
  if (result != VITRAIL_SUCCESS) return result;
  void* mapped = nullptr; // as long as the buffer is there
  const HRESULT status = target.stats->Map(0, nullptr, &mapped);
  if (FAILED(status)) {
    return target.context->log.fail(VITRAIL_ERROR_OUT_OF_MEMORY,
                                    "the buffer for statistics cannot be mapped: Direct3D says 0x%08lx",
                                    static_cast<unsigned long>(status));
  }
  target.mapped = static_cast<StatsSlot*>(mapped);
  for (StatsSlot& slot : target.slots()) new (&slot) StatsSlot{};
  return VITRAIL_SUCCESS;
}

} // namespace

VitrailResult buildTarget(VitrailD3d12Target_T& target, const VitrailD3d12TargetDesc& desc) {
  target.constants = constantsOf(target.info);
  target.plan = FramePlan(planFacts(target.context->limits, target.info));
  const VitrailResult result = findPipelines(target, desc);
  return result == VITRAIL_SUCCESS ? createStats(target) : result;
}

} // namespace vitrail
