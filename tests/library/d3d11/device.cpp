#include "device.h"

#include <array>
#include <cstring>

namespace vitrail::tests::d3d11 {

void check(HRESULT result, const char* call) {
  if (FAILED(result)) {
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "%s failed: 0x%08lx", call, static_cast<unsigned long>(result));
    throw HostError(text.data());
  }
}

Device::Device() {
  constexpr std::array kLevels = {D3D_FEATURE_LEVEL_11_1, D3D_FEATURE_LEVEL_11_0};
  check(D3D11CreateDevice(nullptr, D3D_DRIVER_TYPE_HARDWARE, nullptr, 0, kLevels.data(), kLevels.size(),
                          D3D11_SDK_VERSION, device_.out(), nullptr, context_.out()),
        "D3D11CreateDevice");
}

Com<ID3D11Buffer> Device::makeBuffer(std::size_t bytes, UINT bind, UINT misc, const void* data) const {
  D3D11_BUFFER_DESC desc{};
  desc.ByteWidth = static_cast<UINT>(bytes);
  desc.Usage = D3D11_USAGE_DEFAULT;
  desc.BindFlags = bind;
  desc.MiscFlags = misc;
  D3D11_SUBRESOURCE_DATA initial{};
  initial.pSysMem = data;
  Com<ID3D11Buffer> buffer;
  check(device_->CreateBuffer(&desc, data != nullptr ? &initial : nullptr, buffer.out()), "CreateBuffer");
  return buffer;
}

Com<ID3D11UnorderedAccessView> Device::makeRawView(ID3D11Buffer* buffer, std::size_t bytes) const {
  D3D11_UNORDERED_ACCESS_VIEW_DESC desc{};
  desc.Format = DXGI_FORMAT_R32_TYPELESS;
  desc.ViewDimension = D3D11_UAV_DIMENSION_BUFFER;
  desc.Buffer.NumElements = static_cast<UINT>(bytes / 4);
  desc.Buffer.Flags = D3D11_BUFFER_UAV_FLAG_RAW;
  Com<ID3D11UnorderedAccessView> view;
  check(device_->CreateUnorderedAccessView(buffer, &desc, view.out()), "CreateUnorderedAccessView");
  return view;
}

std::vector<std::byte> Device::read(ID3D11Resource* buffer, std::size_t bytes) const {
  D3D11_BUFFER_DESC desc{};
  desc.ByteWidth = static_cast<UINT>(bytes);
  desc.Usage = D3D11_USAGE_STAGING;
  desc.CPUAccessFlags = D3D11_CPU_ACCESS_READ;
  Com<ID3D11Buffer> staging;
  check(device_->CreateBuffer(&desc, nullptr, staging.out()), "CreateBuffer");
  D3D11_BOX box{0, 0, 0, static_cast<UINT>(bytes), 1, 1};
  context_->CopySubresourceRegion(staging.get(), 0, 0, 0, 0, buffer, 0, &box);
  D3D11_MAPPED_SUBRESOURCE mapped{};
  check(context_->Map(staging.get(), 0, D3D11_MAP_READ, 0, &mapped), "Map");
  std::vector<std::byte> result(bytes);
  std::memcpy(result.data(), mapped.pData, bytes);
  context_->Unmap(staging.get(), 0);
  return result;
}

Device& device() {
  static Device one;
  return one;
}

} // namespace vitrail::tests::d3d11
