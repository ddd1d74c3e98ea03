// The one Direct3D 12 device of a test program, its queue, and small helpers.
#pragma once

#if !defined(_WIN32) && !defined(WIDL_EXPLICIT_AGGREGATE_RETURNS)
#define WIDL_EXPLICIT_AGGREGATE_RETURNS
#endif
#ifndef _WIN32
#include <vkd3d.h>
#include <vkd3d_utils.h>
#undef max
#undef min
#endif

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../host.h"
#include "d3d12/api.h"

#ifdef _WIN32
#define VITRAIL_TEST_ID(Interface) __uuidof(Interface)
#else
#define VITRAIL_TEST_ID(Interface) IID_##Interface
#endif

namespace vitrail::tests::d3d12 {

// Throws HostError where a call has failed.
void check(HRESULT result, const char* call);

// A command list that is executed piece by piece, and what it needs until it has run.
class CommandList {
 public:
  CommandList();

  [[nodiscard]] ID3D12GraphicsCommandList* get() const { return list_.get(); }
  ID3D12GraphicsCommandList* operator->() const { return list_.get(); }
  void keep(Com<ID3D12Resource> resource) { kept_.push_back(std::move(resource)); }
  // Executes what was recorded since, and waits for it.
  void run();
  // The same in two steps: no more is recorded between them.
  void submit();
  void wait();

 private:
  Com<ID3D12CommandAllocator> allocator_;
  Com<ID3D12GraphicsCommandList> list_;
  Com<ID3D12Fence> fence_;
  std::uint64_t value_ = 0;
  std::vector<Com<ID3D12Resource>> kept_;
};

class Device {
 public:
  Device();

  [[nodiscard]] ID3D12Device* get() const { return device_.get(); }
  [[nodiscard]] ID3D12CommandQueue* queue() const { return queue_.get(); }
  [[nodiscard]] Com<ID3D12Resource> makeBuffer(std::size_t bytes, D3D12_HEAP_TYPE type,
                                               D3D12_RESOURCE_FLAGS flags = D3D12_RESOURCE_FLAG_NONE) const;
  // A buffer that holds these bytes, for the GPU to read.
  [[nodiscard]] Com<ID3D12Resource> upload(std::span<const std::byte> bytes) const;
  // What a buffer holds that no GPU writes to any more; in COMMON or decayed to it.
  [[nodiscard]] std::vector<std::byte> read(ID3D12Resource* buffer, std::size_t bytes) const;
  [[nodiscard]] Com<ID3D12DescriptorHeap> makeHeap(D3D12_DESCRIPTOR_HEAP_TYPE type, UINT count,
                                                   bool visible = false) const;
  [[nodiscard]] Com<ID3D12RootSignature> makeRoot(std::span<const D3D12_ROOT_PARAMETER> parameters) const;

 private:
  Com<ID3D12Device> device_;
  Com<ID3D12CommandQueue> queue_;
};

Device& device();

// Of a resource, all of it.
void transition(ID3D12GraphicsCommandList* commands, ID3D12Resource* resource, D3D12_RESOURCE_STATES before,
                D3D12_RESOURCE_STATES after);

// Root parameters.
D3D12_ROOT_PARAMETER rootDescriptor(D3D12_ROOT_PARAMETER_TYPE type, UINT number);
D3D12_ROOT_PARAMETER rootConstants(UINT number, UINT count);

} // namespace vitrail::tests::d3d12
