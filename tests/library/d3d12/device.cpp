#ifndef _WIN32
#define INITGUID // the interfaces' numbers of vkd3d's headers
#endif
#include "device.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <thread>

namespace vitrail::tests::d3d12 {

void check(HRESULT result, const char* call) {
  if (FAILED(result)) {
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "%s failed: 0x%08lx", call, static_cast<unsigned long>(result));
    throw HostError(text.data());
  }
}

CommandList::CommandList() {
  constexpr auto kType = D3D12_COMMAND_LIST_TYPE_DIRECT;
  check(device().get()->CreateCommandAllocator(kType, VITRAIL_TEST_ID(ID3D12CommandAllocator), outOf(allocator_)),
        "CreateCommandAllocator");
  check(device().get()->CreateCommandList(0, kType, allocator_.get(), nullptr,
                                          VITRAIL_TEST_ID(ID3D12GraphicsCommandList), outOf(list_)),
        "CreateCommandList");
  check(device().get()->CreateFence(0, D3D12_FENCE_FLAG_NONE, VITRAIL_TEST_ID(ID3D12Fence), outOf(fence_)),
        "CreateFence");
}

void CommandList::submit() {
  check(list_->Close(), "ID3D12GraphicsCommandList::Close");
  ID3D12CommandList* const lists[] = {list_.get()};
  device().queue()->ExecuteCommandLists(1, lists);
  check(device().queue()->Signal(fence_.get(), ++value_), "ID3D12CommandQueue::Signal");
}

void CommandList::wait() {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (fence_->GetCompletedValue() < value_) {
    if (std::chrono::steady_clock::now() > end) throw HostError("a command list does not end");
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  check(allocator_->Reset(), "ID3D12CommandAllocator::Reset");
  check(list_->Reset(allocator_.get(), nullptr), "ID3D12GraphicsCommandList::Reset");
  kept_.clear();
}

void CommandList::run() {
  submit();
  wait();
}

Device::Device() {
  check(D3D12CreateDevice(nullptr, D3D_FEATURE_LEVEL_11_0, VITRAIL_TEST_ID(ID3D12Device), outOf(device_)),
        "D3D12CreateDevice");
  const D3D12_COMMAND_QUEUE_DESC desc{};
  check(device_->CreateCommandQueue(&desc, VITRAIL_TEST_ID(ID3D12CommandQueue), outOf(queue_)), "CreateCommandQueue");
}

Com<ID3D12Resource> Device::makeBuffer(std::size_t bytes, D3D12_HEAP_TYPE type, D3D12_RESOURCE_FLAGS flags) const {
  D3D12_HEAP_PROPERTIES heap{};
  heap.Type = type;
  D3D12_RESOURCE_DESC desc{};
  desc.Dimension = D3D12_RESOURCE_DIMENSION_BUFFER;
  desc.Width = bytes;
  desc.Height = 1;
  desc.DepthOrArraySize = 1;
  desc.MipLevels = 1;
  desc.SampleDesc.Count = 1;
  desc.Layout = D3D12_TEXTURE_LAYOUT_ROW_MAJOR;
  desc.Flags = flags;
  const D3D12_RESOURCE_STATES state = type == D3D12_HEAP_TYPE_UPLOAD     ? D3D12_RESOURCE_STATE_GENERIC_READ
                                      : type == D3D12_HEAP_TYPE_READBACK ? D3D12_RESOURCE_STATE_COPY_DEST
                                                                         : D3D12_RESOURCE_STATE_COMMON;
  Com<ID3D12Resource> buffer;
  check(device_->CreateCommittedResource(&heap, D3D12_HEAP_FLAG_NONE, &desc, state, nullptr,
                                         VITRAIL_TEST_ID(ID3D12Resource), outOf(buffer)),
        "CreateCommittedResource");
  return buffer;
}

Com<ID3D12Resource> Device::upload(std::span<const std::byte> bytes) const {
  Com<ID3D12Resource> buffer = makeBuffer(bytes.size(), D3D12_HEAP_TYPE_UPLOAD);
  void* mapped = nullptr;
  check(buffer->Map(0, nullptr, &mapped), "ID3D12Resource::Map");
  std::memcpy(mapped, bytes.data(), bytes.size());
  buffer->Unmap(0, nullptr);
  return buffer;
}

std::vector<std::byte> Device::read(ID3D12Resource* buffer, std::size_t bytes) const {
  CommandList commands;
  const Com<ID3D12Resource> staging = makeBuffer(bytes, D3D12_HEAP_TYPE_READBACK);
  transition(commands.get(), buffer, D3D12_RESOURCE_STATE_COMMON, D3D12_RESOURCE_STATE_COPY_SOURCE);
  commands->CopyBufferRegion(staging.get(), 0, buffer, 0, bytes);
  commands.run();
  void* mapped = nullptr;
  check(staging->Map(0, nullptr, &mapped), "ID3D12Resource::Map");
  std::vector<std::byte> result(bytes);
  std::memcpy(result.data(), mapped, bytes);
  staging->Unmap(0, nullptr);
  return result;
}

Com<ID3D12DescriptorHeap> Device::makeHeap(D3D12_DESCRIPTOR_HEAP_TYPE type, UINT count, bool visible) const {
  D3D12_DESCRIPTOR_HEAP_DESC desc{};
  desc.Type = type;
  desc.NumDescriptors = count;
  desc.Flags = visible ? D3D12_DESCRIPTOR_HEAP_FLAG_SHADER_VISIBLE : D3D12_DESCRIPTOR_HEAP_FLAG_NONE;
  Com<ID3D12DescriptorHeap> heap;
  check(device_->CreateDescriptorHeap(&desc, VITRAIL_TEST_ID(ID3D12DescriptorHeap), outOf(heap)),
        "CreateDescriptorHeap");
  return heap;
}

Com<ID3D12RootSignature> Device::makeRoot(std::span<const D3D12_ROOT_PARAMETER> parameters) const {
  D3D12_ROOT_SIGNATURE_DESC desc{};
  desc.NumParameters = static_cast<UINT>(parameters.size());
  desc.pParameters = parameters.data();
  desc.Flags = D3D12_ROOT_SIGNATURE_FLAG_ALLOW_INPUT_ASSEMBLER_INPUT_LAYOUT;
  Com<ID3DBlob> code;
  Com<ID3DBlob> said;
  check(D3D12SerializeRootSignature(&desc, D3D_ROOT_SIGNATURE_VERSION_1_0, code.out(), said.out()),
        "D3D12SerializeRootSignature");
  Com<ID3D12RootSignature> root;
  check(device_->CreateRootSignature(0, code->GetBufferPointer(), code->GetBufferSize(),
                                     VITRAIL_TEST_ID(ID3D12RootSignature), outOf(root)),
        "CreateRootSignature");
  return root;
}

Device& device() {
  static Device one;
  return one;
}

void transition(ID3D12GraphicsCommandList* commands, ID3D12Resource* resource, D3D12_RESOURCE_STATES before,
                D3D12_RESOURCE_STATES after) {
  if (before == after) return;
  D3D12_RESOURCE_BARRIER barrier{};
  barrier.Type = D3D12_RESOURCE_BARRIER_TYPE_TRANSITION;
  barrier.Transition.pResource = resource;
  barrier.Transition.Subresource = D3D12_RESOURCE_BARRIER_ALL_SUBRESOURCES;
  barrier.Transition.StateBefore = before;
  barrier.Transition.StateAfter = after;
  commands->ResourceBarrier(1, &barrier);
}

D3D12_ROOT_PARAMETER rootDescriptor(D3D12_ROOT_PARAMETER_TYPE type, UINT number) {
  D3D12_ROOT_PARAMETER parameter{};
  parameter.ParameterType = type;
  parameter.Descriptor.ShaderRegister = number;
  return parameter;
}

D3D12_ROOT_PARAMETER rootConstants(UINT number, UINT count) {
  D3D12_ROOT_PARAMETER parameter{};
  parameter.ParameterType = D3D12_ROOT_PARAMETER_TYPE_32BIT_CONSTANTS;
  parameter.Constants.ShaderRegister = number;
  parameter.Constants.Num32BitValues = count;
  return parameter;
}

} // namespace vitrail::tests::d3d12
