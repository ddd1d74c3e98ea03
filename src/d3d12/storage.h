// A target's memory: three buffers, its own or placed in the host's heap, the texture for what is behind, and the
// descriptors of kernels. A buffer has one state at a time, and the counters are read by indirect commands while
// kernels write the lists: hence three.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "context.h"
#include "core/frame_numbers.h"
#include "core/pool.h"
#include "vitrail/bindings.h"

namespace vitrail {

// The textures of one picture; null where there is none.
struct D3d12View {
  ID3D12Resource* color = nullptr;
  ID3D12Resource* opaque = nullptr;
  ID3D12Resource* depth = nullptr;
};

enum class D3d12Part : std::uint32_t {
  Constants, // what kernels and commands only read: parameters, arguments of indirect commands, what the host knows
  Control,   // the counters
  Lists      // all else
};
constexpr std::uint32_t kD3d12Parts = 3;

// What the host knows of a frame, on its way to the statistics.
struct D3d12Stamp {
  std::array<std::uint32_t, 3> facts; // FrameFacts
  std::array<std::uint32_t, 2> tag;
};

// Where things are in Constants.
constexpr std::uint64_t kArgumentsOffset = 1792;
constexpr std::uint64_t kStampOffset = 2048;
constexpr std::uint64_t kConstantsBytes = 4096;
static_assert(sizeof(layout::VitrailParameters) <= kArgumentsOffset);
static_assert(kArgumentsOffset + sizeof(layout::VitrailControl) <= kStampOffset);
static_assert(kStampOffset + sizeof(D3d12Stamp) <= kConstantsBytes);

// Where the buffers are in a heap: each where a resource may begin.
constexpr std::uint64_t kPlacement = D3D12_DEFAULT_RESOURCE_PLACEMENT_ALIGNMENT;
constexpr std::array<std::uint64_t, kD3d12Parts> kHeapOffsets = {0, kPlacement, 2 * kPlacement};

constexpr std::uint64_t listsBytes(const StorageLayout& layout) { return layout.total - layout.heads.offset; }
constexpr std::uint64_t heapBytes(const StorageLayout& layout) {
  constexpr std::uint64_t kLists = kHeapOffsets[static_cast<std::uint32_t>(D3d12Part::Lists)];
  return kLists + (listsBytes(layout) + kPlacement - 1) / kPlacement * kPlacement;
}

// A part of the lists, in their buffer.
constexpr std::uint64_t offsetInLists(const StorageLayout& layout, const StoragePart& part) {
  return part.offset - layout.heads.offset;
}

// Descriptors of one storage: the buffers of kernels from u1 on, then of each view u0, t1 and t2.
constexpr std::uint32_t kBufferDescriptors = VITRAIL_BINDINGS - 1;
constexpr std::uint32_t kSetDescriptors = kBufferDescriptors + VITRAIL_MAX_VIEWS * VITRAIL_VIEW_BINDINGS;

// Sets of descriptors: the present memory's, those of frames in flight, and one for the memory that is about to come.
constexpr std::uint32_t descriptorSets(std::uint32_t framesInFlight) { return framesInFlight + 2; }

// A range of a shader-visible heap of the host's, in sets.
struct D3d12Descriptors {
  Com<ID3D12DescriptorHeap> heap; // null: each storage makes its own
  std::uint32_t first = 0;
  std::vector<bool> taken;
};

struct D3d12StorageInfo {
  StorageNeeds needs;
  ID3D12Heap* heap = nullptr; // of the host's
  std::uint64_t heapOffset = 0;
  const std::array<D3d12View, VITRAIL_MAX_VIEWS>* views = nullptr;
  std::uint32_t viewCount = 0;
  std::uint32_t samples = 1;
  std::uint32_t width = 0; // of the texture for what is behind; 0: none is needed
  std::uint32_t height = 0;
  DXGI_FORMAT colorFormat = DXGI_FORMAT_UNKNOWN;
  const char* debugName = nullptr;
};

struct D3d12Storage {
  StorageNeeds needs;
  StorageLayout layout; // of which the sizes hold, and the places within the lists
  std::array<Com<ID3D12Resource>, kD3d12Parts> buffers;
  std::array<D3D12_RESOURCE_STATES, kD3d12Parts> states{}; // as recorded so far
  bool argumentsStale = true;                              // counters have changed since they were copied
  Com<ID3D12Resource> behind; // a compute resolve of one sample: the opaque colour, as it was before
  std::uint64_t behindBytes = 0;
  std::uint32_t viewCount = 0;
  Com<ID3D12DescriptorHeap> heap;
  std::uint32_t first = 0; // descriptor of the heap
  std::uint32_t set = 0;   // of the host's range, where the heap is the host's
  bool ownHeap = true;
  bool wholeByBinding = false;
  FrameUse use;

  [[nodiscard]] ID3D12Resource* buffer(D3d12Part part) const { return buffers[static_cast<std::uint32_t>(part)].get(); }
  [[nodiscard]] std::uint64_t address(D3d12Part part) const { return buffer(part)->GetGPUVirtualAddress(); }
  [[nodiscard]] std::uint64_t addressOf(const StoragePart& part) const {
    return address(D3d12Part::Lists) + offsetInLists(layout, part);
  }
  [[nodiscard]] std::uint64_t bytes() const {
    return kConstantsBytes + sizeof(layout::VitrailControl) + listsBytes(layout) + behindBytes;
  }

  // Logs its errors.
  VitrailResult create(const VitrailD3d12Context_T& context, D3d12Descriptors& descriptors,
                       const D3d12StorageInfo& info);
  // Gives descriptors back.
  void release(D3d12Descriptors& descriptors);
};

// The view of a target's buffer that a binding has, written or read, at a descriptor's place.
void writeBufferView(const VitrailD3d12Context_T& context, const D3d12Storage& storage, std::uint32_t binding,
                     bool written, D3D12_CPU_DESCRIPTOR_HANDLE place);

// Logs its errors.
VitrailResult createBuffer(const VitrailD3d12Context_T& context, D3D12_HEAP_TYPE type, std::uint64_t bytes,
                           const char* name, const char* what, Com<ID3D12Resource>& buffer);

// Of the formats that a compute resolve writes.
std::uint64_t bytesOfPixel(DXGI_FORMAT format);

// The format by which shaders read a texture: of a depth the depth.
DXGI_FORMAT readableFormat(DXGI_FORMAT format);

} // namespace vitrail
