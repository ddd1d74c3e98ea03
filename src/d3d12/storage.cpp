#include "storage.h"

#include <algorithm>

namespace vitrail {

namespace {

constexpr auto kNoState = D3D12_RESOURCE_STATE_COMMON;

D3D12_RESOURCE_DESC bufferDesc(std::uint64_t bytes, bool written) {
  D3D12_RESOURCE_DESC desc{};
  desc.Dimension = D3D12_RESOURCE_DIMENSION_BUFFER;
  desc.Width = bytes;
  desc.Height = 1;
  desc.DepthOrArraySize = 1;
  desc.MipLevels = 1;
  desc.SampleDesc.Count = 1;
  desc.Layout = D3D12_TEXTURE_LAYOUT_ROW_MAJOR;
  desc.Flags = written ? D3D12_RESOURCE_FLAG_ALLOW_UNORDERED_ACCESS : D3D12_RESOURCE_FLAG_NONE;
  return desc;
}

VitrailResult noMemory(const VitrailD3d12Context_T& context, const char* what, std::uint64_t bytes, HRESULT result) {
  return context.log.fail(VITRAIL_ERROR_OUT_OF_MEMORY,
                          "no memory for %s: %llu bytes, Direct3D says 0x%08lx: use a smaller nodeCapacity or "
                          "memoryBudget",
                          what, static_cast<unsigned long long>(bytes), static_cast<unsigned long>(result));
}

VitrailResult createBuffers(const VitrailD3d12Context_T& context, const D3d12StorageInfo& info, D3d12Storage& storage) {
  constexpr std::array<const char*, kD3d12Parts> kNames = {"constants", "counters", "fragment lists"};
  const std::array<std::uint64_t, kD3d12Parts> sizes = {kConstantsBytes, sizeof(layout::VitrailControl),
                                                        listsBytes(storage.layout)};
  for (std::size_t i = 0; i < kD3d12Parts; ++i) {
    Com<ID3D12Resource>& buffer = storage.buffers.at(i);
    if (info.heap == nullptr) {
      const VitrailResult result =
          createBuffer(context, D3D12_HEAP_TYPE_DEFAULT, sizes.at(i), info.debugName, kNames.at(i), buffer);
      if (result != VITRAIL_SUCCESS) return result;
      continue;
    }
    const D3D12_RESOURCE_DESC desc = bufferDesc(sizes.at(i), true);
    const std::uint64_t place = info.heapOffset + kHeapOffsets.at(i);
    const HRESULT result = context.device->CreatePlacedResource(info.heap, place, &desc, kNoState, nullptr,
                                                                kGuid<ID3D12Resource>, outOf(buffer));
    if (FAILED(result)) {
      return context.log.fail(VITRAIL_ERROR_INVALID, "the heap has no place for %s at %llu: Direct3D says 0x%08lx",
                              kNames.at(i), static_cast<unsigned long long>(place), static_cast<unsigned long>(result));
    }
    nameObject(buffer.get(), info.debugName, kNames.at(i));
  }
  storage.states.fill(kNoState);
  return VITRAIL_SUCCESS;
}

// The texture that a compute resolve of one sample reads what is behind from.
VitrailResult createBehind(const VitrailD3d12Context_T& context, const D3d12StorageInfo& info, D3d12Storage& storage) {
  if (info.width == 0) return VITRAIL_SUCCESS;
  D3D12_HEAP_PROPERTIES heap{};
  heap.Type = D3D12_HEAP_TYPE_DEFAULT;
  D3D12_RESOURCE_DESC desc{};
  desc.Dimension = D3D12_RESOURCE_DIMENSION_TEXTURE2D;
  desc.Width = info.width;
  desc.Height = info.height;
  desc.DepthOrArraySize = 1;
  desc.MipLevels = 1;
  desc.Format = info.colorFormat;
  desc.SampleDesc.Count = 1;
  storage.behindBytes = std::uint64_t{info.width} * info.height * bytesOfPixel(info.colorFormat);
  const HRESULT result = context.device->CreateCommittedResource(&heap, D3D12_HEAP_FLAG_NONE, &desc,
                                                                 D3D12_RESOURCE_STATE_NON_PIXEL_SHADER_RESOURCE,
                                                                 nullptr, kGuid<ID3D12Resource>, outOf(storage.behind));
  if (FAILED(result)) return noMemory(context, "the opaque colour", storage.behindBytes, result);
  nameObject(storage.behind.get(), info.debugName, "opaque colour");
  return VITRAIL_SUCCESS;
}

VitrailResult takeDescriptors(const VitrailD3d12Context_T& context, D3d12Descriptors& descriptors, const char* name,
                              D3d12Storage& storage) {
  if (descriptors.heap) {
    const auto free = std::find(descriptors.taken.begin(), descriptors.taken.end(), false);
    if (free == descriptors.taken.end()) {
      return context.log.fail(VITRAIL_ERROR_OUT_OF_MEMORY,
                              "all descriptors of the host's range are in use: frames in flight keep theirs");
    }
    *free = true;
    storage.ownHeap = false;
    storage.heap = descriptors.heap;
    storage.set = static_cast<std::uint32_t>(free - descriptors.taken.begin());
    storage.first = descriptors.first + storage.set * kSetDescriptors;
    return VITRAIL_SUCCESS;
  }
  D3D12_DESCRIPTOR_HEAP_DESC desc{};
  desc.Type = D3D12_DESCRIPTOR_HEAP_TYPE_CBV_SRV_UAV;
  desc.NumDescriptors = kBufferDescriptors + std::max(storage.viewCount, 1U) * VITRAIL_VIEW_BINDINGS;
  desc.Flags = D3D12_DESCRIPTOR_HEAP_FLAG_SHADER_VISIBLE;
  const HRESULT result = context.device->CreateDescriptorHeap(&desc, kGuid<ID3D12DescriptorHeap>, outOf(storage.heap));
  if (FAILED(result)) {
    return context.log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "no heap for %u descriptors: Direct3D says 0x%08lx",
                            desc.NumDescriptors, static_cast<unsigned long>(result));
  }
  nameObject(storage.heap.get(), name, "descriptors");
  return VITRAIL_SUCCESS;
}

D3D12_CPU_DESCRIPTOR_HANDLE placeOf(const VitrailD3d12Context_T& context, const D3d12Storage& storage,
                                    std::uint32_t number) {
  D3D12_CPU_DESCRIPTOR_HANDLE place = storage.heap->GetCPUDescriptorHandleForHeapStart();
  place.ptr += std::size_t{storage.first + number} * context.descriptorBytes;
  return place;
}

// A null texture gives a view of nothing.
void writeReadView(const VitrailD3d12Context_T& context, ID3D12Resource* texture, bool several, DXGI_FORMAT unseen,
                   D3D12_CPU_DESCRIPTOR_HANDLE place) {
  const bool isThere = texture != nullptr;
  D3D12_SHADER_RESOURCE_VIEW_DESC desc{};
  desc.Format = isThere ? readableFormat(D3D12_RESOURCE_DESC(texture->GetDesc()).Format) : unseen;
  desc.Shader4ComponentMapping = D3D12_DEFAULT_SHADER_4_COMPONENT_MAPPING;
  desc.ViewDimension = several && isThere ? D3D12_SRV_DIMENSION_TEXTURE2DMS : D3D12_SRV_DIMENSION_TEXTURE2D;
  if (desc.ViewDimension == D3D12_SRV_DIMENSION_TEXTURE2D) desc.Texture2D.MipLevels = 1;
  context.device->CreateShaderResourceView(texture, &desc, place);
}

void writeImageViews(const VitrailD3d12Context_T& context, const D3d12StorageInfo& info, const D3d12Storage& storage) {
  const bool several = info.samples > 1;
  const DXGI_FORMAT format =
      info.colorFormat != DXGI_FORMAT_UNKNOWN ? readableFormat(info.colorFormat) : DXGI_FORMAT_R16G16B16A16_FLOAT;
  D3D12_UNORDERED_ACCESS_VIEW_DESC written{};
  written.Format = format;
  written.ViewDimension = D3D12_UAV_DIMENSION_TEXTURE2D;
  for (std::uint32_t i = 0; i < std::max(storage.viewCount, 1U); ++i) {
    const D3d12View view = i < storage.viewCount ? info.views->at(i) : D3d12View{};
    ID3D12Resource* opaque = storage.behind ? storage.behind.get() : view.opaque;
    // Shaders name both, and do not look at the one that there is not: the other is of its kind.
    ID3D12Resource* depth = view.depth != nullptr ? view.depth : view.opaque;
    if (opaque == nullptr) opaque = view.depth;
    const std::uint32_t first = kBufferDescriptors + i * VITRAIL_VIEW_BINDINGS;
    context.device->CreateUnorderedAccessView(view.color, nullptr, &written,
                                              placeOf(context, storage, first + VITRAIL_VIEW_BINDING_COLOR));
    writeReadView(context, opaque, several, format, placeOf(context, storage, first + VITRAIL_VIEW_BINDING_OPAQUE));
    writeReadView(context, depth, several, DXGI_FORMAT_R32_FLOAT,
                  placeOf(context, storage, first + VITRAIL_VIEW_BINDING_DEPTH));
  }
}

struct Place {
  D3d12Part buffer;
  std::uint64_t offset;
  std::uint64_t bytes;
};

Place placeOfBinding(const D3d12Storage& storage, std::uint32_t binding) {
  constexpr std::array<StoragePart StorageLayout::*, VITRAIL_BINDINGS> kParts = {
      &StorageLayout::parameters, &StorageLayout::control,     &StorageLayout::heads,     &StorageLayout::nodes,
      &StorageLayout::sums,       &StorageLayout::mediumLists, &StorageLayout::longLists, &StorageLayout::copy};
  static_assert(VITRAIL_BINDING_PARAMETERS == 0 && VITRAIL_BINDING_CONTROL == 1 && VITRAIL_BINDING_HEADS == 2 &&
                VITRAIL_BINDING_NODES == 3 && VITRAIL_BINDING_SUMS == 4 && VITRAIL_BINDING_MEDIUM_LISTS == 5 &&
                VITRAIL_BINDING_LONG_LISTS == 6 && VITRAIL_BINDING_COPY == 7);
  const StoragePart& part = storage.layout.*kParts.at(binding);
  if (binding == VITRAIL_BINDING_PARAMETERS) return {D3d12Part::Constants, 0, part.size};
  if (binding == VITRAIL_BINDING_CONTROL) return {D3d12Part::Control, 0, part.size};
  return {D3d12Part::Lists, offsetInLists(storage.layout, part), part.size};
}

} // namespace

std::uint64_t bytesOfPixel(DXGI_FORMAT format) { return format == DXGI_FORMAT_R32G32B32A32_FLOAT ? 16 : 8; }

DXGI_FORMAT readableFormat(DXGI_FORMAT format) {
  switch (format) {
    case DXGI_FORMAT_R32G32B32A32_TYPELESS:
      return DXGI_FORMAT_R32G32B32A32_FLOAT;
    case DXGI_FORMAT_R16G16B16A16_TYPELESS:
      return DXGI_FORMAT_R16G16B16A16_FLOAT;
    case DXGI_FORMAT_R8G8B8A8_TYPELESS:
      return DXGI_FORMAT_R8G8B8A8_UNORM_SRGB; // linear light is what is blended
    case DXGI_FORMAT_B8G8R8A8_TYPELESS:
      return DXGI_FORMAT_B8G8R8A8_UNORM_SRGB;
    case DXGI_FORMAT_D32_FLOAT:
    case DXGI_FORMAT_R32_TYPELESS:
      return DXGI_FORMAT_R32_FLOAT;
    case DXGI_FORMAT_D16_UNORM:
    case DXGI_FORMAT_R16_TYPELESS:
      return DXGI_FORMAT_R16_UNORM;
    case DXGI_FORMAT_D24_UNORM_S8_UINT:
    case DXGI_FORMAT_R24G8_TYPELESS:
      return DXGI_FORMAT_R24_UNORM_X8_TYPELESS;
    case DXGI_FORMAT_D32_FLOAT_S8X24_UINT:
    case DXGI_FORMAT_R32G8X24_TYPELESS:
      return DXGI_FORMAT_R32_FLOAT_X8X24_TYPELESS;
    default:
      return format;
  }
}

void writeBufferView(const VitrailD3d12Context_T& context, const D3d12Storage& storage, std::uint32_t binding,
                     bool written, D3D12_CPU_DESCRIPTOR_HANDLE place) {
  const Place at = placeOfBinding(storage, binding);
  ID3D12Resource* buffer = storage.buffer(at.buffer);
  // As large as the part, to the word: shaders ask how many lists there is room for.
  const auto words = static_cast<UINT>(std::min(at.bytes, context.limits.storageBufferRange) / 4);
  if (written) {
    D3D12_UNORDERED_ACCESS_VIEW_DESC desc{};
    desc.Format = DXGI_FORMAT_R32_TYPELESS;
    desc.ViewDimension = D3D12_UAV_DIMENSION_BUFFER;
    desc.Buffer.FirstElement = at.offset / 4;
    desc.Buffer.NumElements = words;
    desc.Buffer.Flags = D3D12_BUFFER_UAV_FLAG_RAW;
    context.device->CreateUnorderedAccessView(buffer, nullptr, &desc, place);
    return;
  }
  D3D12_SHADER_RESOURCE_VIEW_DESC desc{};
  desc.Format = DXGI_FORMAT_R32_TYPELESS;
  desc.ViewDimension = D3D12_SRV_DIMENSION_BUFFER;
  desc.Shader4ComponentMapping = D3D12_DEFAULT_SHADER_4_COMPONENT_MAPPING;
  desc.Buffer.FirstElement = at.offset / 4;
  desc.Buffer.NumElements = words;
  desc.Buffer.Flags = D3D12_BUFFER_SRV_FLAG_RAW;
  context.device->CreateShaderResourceView(buffer, &desc, place);
}

VitrailResult createBuffer(const VitrailD3d12Context_T& context, D3D12_HEAP_TYPE type, std::uint64_t bytes,
                           const char* name, const char* what, Com<ID3D12Resource>& buffer) {
  D3D12_HEAP_PROPERTIES heap{};
  heap.Type = type;
  const bool readBack = type == D3D12_HEAP_TYPE_READBACK;
  const D3D12_RESOURCE_DESC desc = bufferDesc(bytes, !readBack);
  const HRESULT result = context.device->CreateCommittedResource(&heap, D3D12_HEAP_FLAG_NONE, &desc,
                                                                 readBack ? D3D12_RESOURCE_STATE_COPY_DEST : kNoState,
                                                                 nullptr, kGuid<ID3D12Resource>, outOf(buffer));
  if (FAILED(result)) return noMemory(context, what, bytes, result);
  nameObject(buffer.get(), name, what);
  return VITRAIL_SUCCESS;
}

VitrailResult D3d12Storage::create(const VitrailD3d12Context_T& context, D3d12Descriptors& descriptors,
                                   const D3d12StorageInfo& info) {
  needs = info.needs;
  layout = layoutStorage(needs);
  viewCount = info.viewCount;
  VitrailResult result = createBuffers(context, info, *this);
  if (result == VITRAIL_SUCCESS) result = createBehind(context, info, *this);
  if (result == VITRAIL_SUCCESS) result = takeDescriptors(context, descriptors, info.debugName, *this);
  if (result != VITRAIL_SUCCESS) return result;
  for (std::uint32_t binding = 1; binding < VITRAIL_BINDINGS; ++binding) {
    writeBufferView(context, *this, binding, true, placeOf(context, *this, binding - 1));
  }
  writeImageViews(context, info, *this);
  wholeByBinding = layout.nodes.size <= context.limits.storageBufferRange;
  return VITRAIL_SUCCESS;
}

void D3d12Storage::release(D3d12Descriptors& descriptors) {
  if (!ownHeap) descriptors.taken[set] = false;
  *this = {};
}

} // namespace vitrail
