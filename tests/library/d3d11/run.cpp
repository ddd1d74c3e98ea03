#include "../direct3d/run.h"

#include "device.h"

namespace vitrail::tests::direct3d {

std::vector<std::byte> runByDirect3d(std::span<const unsigned char> code, std::span<const std::uint32_t> input,
                                     std::size_t bytes, std::uint32_t groups) {
  using d3d11::check;
  using d3d11::Com;
  d3d11::Device& on = d3d11::device();
  constexpr UINT kRaw = D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS;
  const auto read = on.makeBuffer(input.size_bytes(), D3D11_BIND_SHADER_RESOURCE, kRaw, input.data());
  const std::vector<std::byte> zeros(bytes);
  const auto written = on.makeBuffer(bytes, D3D11_BIND_UNORDERED_ACCESS, kRaw, zeros.data());
  const auto writtenView = on.makeRawView(written.get(), bytes);
  D3D11_SHADER_RESOURCE_VIEW_DESC desc{};
  desc.Format = DXGI_FORMAT_R32_TYPELESS;
  desc.ViewDimension = D3D11_SRV_DIMENSION_BUFFEREX;
  desc.BufferEx.NumElements = static_cast<UINT>(input.size());
  desc.BufferEx.Flags = D3D11_BUFFEREX_SRV_FLAG_RAW;
  Com<ID3D11ShaderResourceView> readView;
  check(on.get()->CreateShaderResourceView(read.get(), &desc, readView.out()), "CreateShaderResourceView");
  Com<ID3D11ComputeShader> shader;
  check(on.get()->CreateComputeShader(code.data(), code.size(), nullptr, shader.out()), "CreateComputeShader");
  ID3D11DeviceContext* context = on.immediate();
  ID3D11ShaderResourceView* views = readView.get();
  ID3D11UnorderedAccessView* target = writtenView.get();
  context->CSSetShader(shader.get(), nullptr, 0);
  context->CSSetShaderResources(0, 1, &views);
  context->CSSetUnorderedAccessViews(1, 1, &target, nullptr);
  context->Dispatch(groups, 1, 1);
  context->ClearState();
  return on.read(written.get(), bytes);
}

} // namespace vitrail::tests::direct3d
