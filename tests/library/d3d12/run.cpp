#include "../direct3d/run.h"

#include <array>

#include "device.h"

namespace vitrail::tests::direct3d {

std::vector<std::byte> runByDirect3d(std::span<const unsigned char> code, std::span<const std::uint32_t> input,
                                     std::size_t bytes, std::uint32_t groups) {
  using namespace d3d12;
  Device& on = device();
  const std::array parameters = {rootDescriptor(D3D12_ROOT_PARAMETER_TYPE_SRV, 0),
                                 rootDescriptor(D3D12_ROOT_PARAMETER_TYPE_UAV, 1)};
  const auto root = on.makeRoot(parameters);
  D3D12_COMPUTE_PIPELINE_STATE_DESC desc{};
  desc.pRootSignature = root.get();
  desc.CS = {code.data(), code.size()};
  Com<ID3D12PipelineState> pipeline;
  check(on.get()->CreateComputePipelineState(&desc, VITRAIL_TEST_ID(ID3D12PipelineState), outOf(pipeline)),
        "CreateComputePipelineState");
  const auto read = on.upload(std::as_bytes(input));
  const auto zeros = on.upload(std::vector<std::byte>(bytes));
  const auto written = on.makeBuffer(bytes, D3D12_HEAP_TYPE_DEFAULT, D3D12_RESOURCE_FLAG_ALLOW_UNORDERED_ACCESS);
  CommandList commands;
  transition(commands.get(), written.get(), D3D12_RESOURCE_STATE_COMMON, D3D12_RESOURCE_STATE_COPY_DEST);
  commands->CopyBufferRegion(written.get(), 0, zeros.get(), 0, bytes);
  transition(commands.get(), written.get(), D3D12_RESOURCE_STATE_COPY_DEST, D3D12_RESOURCE_STATE_UNORDERED_ACCESS);
  commands->SetComputeRootSignature(root.get());
  commands->SetPipelineState(pipeline.get());
  commands->SetComputeRootShaderResourceView(0, read->GetGPUVirtualAddress());
  commands->SetComputeRootUnorderedAccessView(1, written->GetGPUVirtualAddress());
  commands->Dispatch(groups, 1, 1);
  commands.run();
  return on.read(written.get(), bytes);
}

} // namespace vitrail::tests::direct3d
