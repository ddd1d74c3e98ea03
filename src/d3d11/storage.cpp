#include "storage.h"

#include <algorithm>

namespace vitrail {

namespace {

struct Kind {
  std::uint32_t binding;
  StoragePart StorageLayout::*part;
  const char* name;
};

// By VitrailD3d11BufferKind.
constexpr std::array<Kind, VITRAIL_D3D11_BUFFERS> kKinds = {{
    {VITRAIL_BINDING_CONTROL, &StorageLayout::control, "counters"},
    {VITRAIL_BINDING_HEADS, &StorageLayout::heads, "head pointers"},
    {VITRAIL_BINDING_NODES, &StorageLayout::nodes, "node pool"},
    {VITRAIL_BINDING_SUMS, &StorageLayout::sums, "sums"},
    {VITRAIL_BINDING_MEDIUM_LISTS, &StorageLayout::mediumLists, "medium lists"},
    {VITRAIL_BINDING_LONG_LISTS, &StorageLayout::longLists, "long lists"},
    {VITRAIL_BINDING_COPY, &StorageLayout::copy, "copied lists"},
}};

VitrailResult createViews(const VitrailD3d11Context_T& context, std::uint64_t bytes, const char* what,
                          D3d11Part& part) {
  const auto words = static_cast<UINT>(std::min(bytes, context.limits.storageBufferRange) / 4);
  D3D11_UNORDERED_ACCESS_VIEW_DESC written{};
  written.Format = DXGI_FORMAT_R32_TYPELESS;
  written.ViewDimension = D3D11_UAV_DIMENSION_BUFFER;
  written.Buffer.NumElements = words;
  written.Buffer.Flags = D3D11_BUFFER_UAV_FLAG_RAW;
  D3D11_SHADER_RESOURCE_VIEW_DESC read{};
  read.Format = DXGI_FORMAT_R32_TYPELESS;
  read.ViewDimension = D3D11_SRV_DIMENSION_BUFFEREX;
  read.BufferEx.NumElements = words;
  read.BufferEx.Flags = D3D11_BUFFEREX_SRV_FLAG_RAW;
  ID3D11Device* device = context.device.get();
  HRESULT result = device->CreateUnorderedAccessView(part.buffer.get(), &written, part.written.out());
  if (SUCCEEDED(result)) result = device->CreateShaderResourceView(part.buffer.get(), &read, part.read.out());
  if (SUCCEEDED(result)) return VITRAIL_SUCCESS;
  return context.log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "no view of the buffer for %s: 0x%08lx", what,
                          static_cast<unsigned long>(result));
}

// Whether a buffer of the host's can serve.
VitrailResult checkHostBuffer(const VitrailD3d11Context_T& context, ID3D11Buffer* buffer, std::uint64_t bytes,
                              std::uint32_t kind) {
  if (buffer == nullptr) {
    return context.log.fail(VITRAIL_ERROR_INVALID, "buffers[%u] is null: all or none are the host's", kind);
  }
  D3D11_BUFFER_DESC desc{};
  buffer->GetDesc(&desc);
  constexpr UINT kBind = D3D11_BIND_UNORDERED_ACCESS | D3D11_BIND_SHADER_RESOURCE;
  if (desc.Usage != D3D11_USAGE_DEFAULT || (desc.BindFlags & kBind) != kBind ||
      (desc.MiscFlags & D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS) == 0) {
    return context.log.fail(VITRAIL_ERROR_INVALID,
                            "buffers[%u] needs D3D11_USAGE_DEFAULT, D3D11_BIND_UNORDERED_ACCESS, "
                            "D3D11_BIND_SHADER_RESOURCE and D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS",
                            kind);
  }
  if (desc.ByteWidth < bytes) {
    return context.log.fail(VITRAIL_ERROR_INVALID, "buffers[%u] has %u bytes, the target needs %llu", kind,
                            desc.ByteWidth, static_cast<unsigned long long>(bytes));
  }
  return VITRAIL_SUCCESS;
}

} // namespace

std::array<std::uint64_t, VITRAIL_D3D11_BUFFERS> bufferSizes(const StorageLayout& layout) {
  std::array<std::uint64_t, VITRAIL_D3D11_BUFFERS> sizes{};
  for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = (layout.*kKinds[i].part).size;
  return sizes;
}

VitrailResult createBuffer(const VitrailD3d11Context_T& context, const D3D11_BUFFER_DESC& desc, const void* data,
                           const char* name, const char* what, Com<ID3D11Buffer>& buffer) {
  D3D11_SUBRESOURCE_DATA initial{};
  initial.pSysMem = data;
  const HRESULT result = context.device->CreateBuffer(&desc, data != nullptr ? &initial : nullptr, buffer.out());
  if (SUCCEEDED(result)) {
    nameObject(buffer.get(), name, what);
    return VITRAIL_SUCCESS;
  }
  return context.log.fail(VITRAIL_ERROR_OUT_OF_MEMORY,
                          "no memory for %s: %u bytes, Direct3D says 0x%08lx: use a smaller nodeCapacity or "
                          "memoryBudget",
                          what, desc.ByteWidth, static_cast<unsigned long>(result));
}

VitrailResult D3d11Storage::create(const VitrailD3d11Context_T& context, const StorageNeeds& wanted,
                                   ID3D11Buffer* const* hostBuffers, const char* name) {
  needs = wanted;
  layout = layoutStorage(needs);
  const auto sizes = bufferSizes(layout);
  for (std::uint32_t i = 0; i < kKinds.size(); ++i) {
    D3d11Part& part = parts[kKinds[i].binding];
    VitrailResult result = VITRAIL_SUCCESS;
    if (hostBuffers != nullptr) {
      result = checkHostBuffer(context, hostBuffers[i], sizes[i], i);
      if (result != VITRAIL_SUCCESS) return result;
      part.buffer = Com<ID3D11Buffer>::shared(hostBuffers[i]);
    } else {
      D3D11_BUFFER_DESC desc{};
      desc.ByteWidth = static_cast<UINT>(std::min<std::uint64_t>(sizes[i], UINT32_MAX));
      desc.BindFlags = D3D11_BIND_UNORDERED_ACCESS | D3D11_BIND_SHADER_RESOURCE;
      desc.MiscFlags = D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS;
      result = createBuffer(context, desc, nullptr, name, kKinds[i].name, part.buffer);
      if (result != VITRAIL_SUCCESS) return result;
    }
    // As large as the part, to the word: shaders ask how many lists there is room for.
    result = createViews(context, (layout.*kKinds[i].part).size, kKinds[i].name, part);
    if (result != VITRAIL_SUCCESS) return result;
  }
  D3D11_BUFFER_DESC desc{};
  desc.ByteWidth = sizeof(layout::VitrailParameters);
  desc.BindFlags = D3D11_BIND_CONSTANT_BUFFER;
  VitrailResult result = createBuffer(context, desc, nullptr, name, "parameters", parameters);
  if (result != VITRAIL_SUCCESS) return result;
  desc.ByteWidth = sizeof(layout::VitrailControl);
  desc.BindFlags = D3D11_BIND_SHADER_RESOURCE; // of which there must be one
  desc.MiscFlags = D3D11_RESOURCE_MISC_DRAWINDIRECT_ARGS | D3D11_RESOURCE_MISC_BUFFER_ALLOW_RAW_VIEWS;
  result = createBuffer(context, desc, nullptr, name, "arguments", arguments);
  wholeByBinding = layout.nodes.size <= context.limits.storageBufferRange;
  return result;
}

} // namespace vitrail
