// A complete host with Direct3D 12 (d3d12 PICTURE.ppm): the cube of glass panes that examples/minimal draws with
// Vulkan, without a window. What concerns Vitrail is in glass.hlsl, root.hlsl, drawFrame() and draw().
#ifndef _MSC_VER
#define WIDL_EXPLICIT_AGGREGATE_RETURNS // as Microsoft's compiler returns structures
#endif
#ifdef _WIN32
#include <d3d12.h>
#define ID_OF(Interface) __uuidof(Interface)
#else // libvkd3d
#define INITGUID
#include <vkd3d.h>
#include <vkd3d_utils.h>
#undef max
#undef min
#define ID_OF(Interface) IID_##Interface
#endif

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include <vitrail/d3d12.h>

#include "bytecode/floor_pixel.h"
#include "bytecode/floor_vertex.h"
#include "bytecode/glass_pixel.h"
#include "bytecode/glass_vertex.h"
#include "bytecode/root.h"

namespace {
constexpr int kWidth = 1600, kHeight = 1200; // four pixels make one of the file
constexpr DXGI_FORMAT kColor = DXGI_FORMAT_R32G32B32A32_FLOAT, kDepth = DXGI_FORMAT_D32_FLOAT;
constexpr UINT kPitch = kWidth * 4 * sizeof(float); // a multiple of D3D12_TEXTURE_DATA_PITCH_ALIGNMENT

void check(bool well, const std::string& what) {
  if (!well) throw std::runtime_error(what);
}
void checkCall(HRESULT result, const char* call) { check(SUCCEEDED(result), std::string(call) + " failed"); }

// What the host draws with. The process ends with it: nothing is released before.
struct Host {
  ID3D12Device* device = nullptr;
  ID3D12CommandQueue* queue = nullptr;
  ID3D12CommandAllocator* allocator = nullptr;
  ID3D12GraphicsCommandList* commands = nullptr;
  ID3D12Fence* fence = nullptr;
  ID3D12Resource *color = nullptr, *depth = nullptr, *read = nullptr;
  ID3D12DescriptorHeap *targets = nullptr, *depths = nullptr;
  ID3D12RootSignature* root = nullptr;
  ID3D12PipelineState *floor = nullptr, *glass = nullptr;
};

// The last two arguments of calls that make an interface.
#define MAKES(Interface, pointer) ID_OF(Interface), reinterpret_cast<void**>(&(pointer))

ID3D12Resource* createTexture(const Host& host, DXGI_FORMAT format, D3D12_RESOURCE_FLAGS flags,
                              D3D12_RESOURCE_STATES state) {
  D3D12_HEAP_PROPERTIES heap{};
  heap.Type = D3D12_HEAP_TYPE_DEFAULT;
  D3D12_RESOURCE_DESC desc{};
  desc.Dimension = D3D12_RESOURCE_DIMENSION_TEXTURE2D;
  desc.Width = kWidth;
  desc.Height = kHeight;
  desc.DepthOrArraySize = 1;
  desc.MipLevels = 1;
  desc.Format = format;
  desc.SampleDesc.Count = 1;
  desc.Flags = flags;
  ID3D12Resource* texture = nullptr;
  checkCall(host.device->CreateCommittedResource(&heap, D3D12_HEAP_FLAG_NONE, &desc, state, nullptr,
                                                 MAKES(ID3D12Resource, texture)),
            "CreateCommittedResource");
  return texture;
}

void createResources(Host& host) {
  const auto flags = D3D12_RESOURCE_FLAG_ALLOW_RENDER_TARGET | D3D12_RESOURCE_FLAG_ALLOW_UNORDERED_ACCESS;
  host.color = createTexture(host, kColor, flags, D3D12_RESOURCE_STATE_RENDER_TARGET);
  host.depth = createTexture(host, kDepth, D3D12_RESOURCE_FLAG_ALLOW_DEPTH_STENCIL, D3D12_RESOURCE_STATE_DEPTH_WRITE);
  D3D12_DESCRIPTOR_HEAP_DESC heap{};
  heap.NumDescriptors = 1;
  heap.Type = D3D12_DESCRIPTOR_HEAP_TYPE_RTV;
  checkCall(host.device->CreateDescriptorHeap(&heap, MAKES(ID3D12DescriptorHeap, host.targets)),
            "CreateDescriptorHeap");
  heap.Type = D3D12_DESCRIPTOR_HEAP_TYPE_DSV;
  checkCall(host.device->CreateDescriptorHeap(&heap, MAKES(ID3D12DescriptorHeap, host.depths)), "CreateDescriptorHeap");
  host.device->CreateRenderTargetView(host.color, nullptr, host.targets->GetCPUDescriptorHandleForHeapStart());
  host.device->CreateDepthStencilView(host.depth, nullptr, host.depths->GetCPUDescriptorHandleForHeapStart());
  D3D12_HEAP_PROPERTIES memory{};
  memory.Type = D3D12_HEAP_TYPE_READBACK;
  D3D12_RESOURCE_DESC desc{};
  desc.Dimension = D3D12_RESOURCE_DIMENSION_BUFFER;
  desc.Width = UINT64{kPitch} * kHeight;
  desc.Height = desc.DepthOrArraySize = desc.MipLevels = 1;
  desc.SampleDesc.Count = 1;
  desc.Layout = D3D12_TEXTURE_LAYOUT_ROW_MAJOR;
  checkCall(host.device->CreateCommittedResource(&memory, D3D12_HEAP_FLAG_NONE, &desc, D3D12_RESOURCE_STATE_COPY_DEST,
                                                 nullptr, MAKES(ID3D12Resource, host.read)),
            "CreateCommittedResource");
}

template <size_t VertexBytes, size_t PixelBytes>
ID3D12PipelineState* createPipeline(const Host& host, const unsigned char (&vertex)[VertexBytes],
                                    const unsigned char (&pixel)[PixelBytes], bool opaque) {
  D3D12_GRAPHICS_PIPELINE_STATE_DESC desc{};
  desc.pRootSignature = host.root;
  desc.VS = {vertex, VertexBytes};
  desc.PS = {pixel, PixelBytes};
  D3D12_RENDER_TARGET_BLEND_DESC& blend = desc.BlendState.RenderTarget[0];
  blend.SrcBlend = blend.SrcBlendAlpha = D3D12_BLEND_ONE;
  blend.DestBlend = blend.DestBlendAlpha = D3D12_BLEND_ZERO;
  blend.BlendOp = blend.BlendOpAlpha = D3D12_BLEND_OP_ADD;
  blend.RenderTargetWriteMask = opaque ? D3D12_COLOR_WRITE_ENABLE_ALL : 0; // glass goes on lists alone
  desc.SampleMask = 0xffffffff;
  desc.RasterizerState.FillMode = D3D12_FILL_MODE_SOLID;
  desc.RasterizerState.CullMode = D3D12_CULL_MODE_NONE;
  desc.RasterizerState.DepthClipEnable = TRUE;
  desc.DepthStencilState.DepthEnable = TRUE;
  desc.DepthStencilState.DepthFunc = D3D12_COMPARISON_FUNC_LESS;
  desc.DepthStencilState.DepthWriteMask = opaque ? D3D12_DEPTH_WRITE_MASK_ALL : D3D12_DEPTH_WRITE_MASK_ZERO;
  desc.PrimitiveTopologyType = D3D12_PRIMITIVE_TOPOLOGY_TYPE_TRIANGLE;
  desc.NumRenderTargets = 1;
  desc.RTVFormats[0] = kColor;
  desc.DSVFormat = kDepth;
  desc.SampleDesc.Count = 1;
  ID3D12PipelineState* pipeline = nullptr;
  checkCall(host.device->CreateGraphicsPipelineState(&desc, MAKES(ID3D12PipelineState, pipeline)),
            "CreateGraphicsPipelineState");
  return pipeline;
}

Host createHost() {
  using namespace example::bytecode;
  Host host;
  const auto kDirect = D3D12_COMMAND_LIST_TYPE_DIRECT;
  void** const device = reinterpret_cast<void**>(&host.device);
  checkCall(D3D12CreateDevice(nullptr, D3D_FEATURE_LEVEL_11_0, ID_OF(ID3D12Device), device), "D3D12CreateDevice");
  const D3D12_COMMAND_QUEUE_DESC queue{};
  checkCall(host.device->CreateCommandQueue(&queue, MAKES(ID3D12CommandQueue, host.queue)), "CreateCommandQueue");
  checkCall(host.device->CreateCommandAllocator(kDirect, MAKES(ID3D12CommandAllocator, host.allocator)),
            "CreateCommandAllocator");
  checkCall(host.device->CreateCommandList(0, kDirect, host.allocator, nullptr,
                                           MAKES(ID3D12GraphicsCommandList, host.commands)),
            "CreateCommandList");
  checkCall(host.device->CreateFence(0, D3D12_FENCE_FLAG_NONE, MAKES(ID3D12Fence, host.fence)), "CreateFence");
  checkCall(host.device->CreateRootSignature(0, root, sizeof(root), MAKES(ID3D12RootSignature, host.root)),
            "CreateRootSignature");
  createResources(host);
  host.floor = createPipeline(host, floor_vertex, floor_pixel, true);
  host.glass = createPipeline(host, glass_vertex, glass_pixel, false);
  return host;
}

void transition(const Host& host, D3D12_RESOURCE_STATES before, D3D12_RESOURCE_STATES after) {
  D3D12_RESOURCE_BARRIER barrier{};
  barrier.Transition.pResource = host.color;
  barrier.Transition.StateBefore = before;
  barrier.Transition.StateAfter = after;
  host.commands->ResourceBarrier(1, &barrier);
}

// After vitrailD3d12Begin() a host sets its own again: heaps, root signature, pipeline.
void setForDrawing(const Host& host, ID3D12PipelineState* pipeline) {
  host.commands->SetGraphicsRootSignature(host.root);
  host.commands->SetPipelineState(pipeline);
}

void drawFrame(const Host& host, VitrailD3d12Target target) {
  ID3D12GraphicsCommandList* commands = host.commands;
  const D3D12_VIEWPORT viewport{0, 0, kWidth, kHeight, 0, 1};
  const D3D12_RECT scissor{0, 0, kWidth, kHeight};
  const D3D12_CPU_DESCRIPTOR_HANDLE color = host.targets->GetCPUDescriptorHandleForHeapStart();
  const D3D12_CPU_DESCRIPTOR_HANDLE depth = host.depths->GetCPUDescriptorHandleForHeapStart();
  const float horizon[] = {0.70F, 0.77F, 0.84F, 1.0F};
  commands->ClearRenderTargetView(color, horizon, 0, nullptr);
  commands->ClearDepthStencilView(depth, D3D12_CLEAR_FLAG_DEPTH, 1.0F, 0, 0, nullptr);
  commands->IASetPrimitiveTopology(D3D_PRIMITIVE_TOPOLOGY_TRIANGLESTRIP);
  commands->RSSetViewports(1, &viewport);
  commands->RSSetScissorRects(1, &scissor);
  commands->OMSetRenderTargets(1, &color, FALSE, &depth);
  setForDrawing(host, host.floor);
  commands->DrawInstanced(4, 1, 0, 0);
  vitrailD3d12Begin(target, commands, nullptr);
  setForDrawing(host, host.glass);
  vitrailD3d12Bind(target, commands, 0);
  commands->DrawInstanced(4, 9, 0, 0); // nine panes, in any order
  vitrailD3d12Collected(target, commands);
  transition(host, D3D12_RESOURCE_STATE_RENDER_TARGET, D3D12_RESOURCE_STATE_UNORDERED_ACCESS);
  vitrailD3d12Resolve(target, commands, nullptr);
  vitrailD3d12End(target, commands);
  transition(host, D3D12_RESOURCE_STATE_UNORDERED_ACCESS, D3D12_RESOURCE_STATE_COPY_SOURCE);
  D3D12_TEXTURE_COPY_LOCATION from{}, to{};
  from.pResource = host.color;
  from.Type = D3D12_TEXTURE_COPY_TYPE_SUBRESOURCE_INDEX;
  to.pResource = host.read;
  to.Type = D3D12_TEXTURE_COPY_TYPE_PLACED_FOOTPRINT;
  to.PlacedFootprint.Footprint = {kColor, kWidth, kHeight, 1, kPitch};
  commands->CopyTextureRegion(&to, 0, 0, 0, &from, nullptr);
  checkCall(commands->Close(), "Close");
  ID3D12CommandList* const lists[] = {commands};
  host.queue->ExecuteCommandLists(1, lists);
  checkCall(host.queue->Signal(host.fence, 1), "Signal");
  while (host.fence->GetCompletedValue() < 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void save(const Host& host, const char* path) {
  void* mapped = nullptr;
  checkCall(host.read->Map(0, nullptr, &mapped), "Map");
  const size_t pitch = kPitch / sizeof(float);
  std::ofstream file(path, std::ios::binary);
  file << "P6 " << kWidth / 2 << ' ' << kHeight / 2 << " 255\n";
  for (size_t y = 0; y < kHeight; y += 2) {
    for (size_t i = 0; i < kWidth / 2 * 3; ++i) {
      const float* p = static_cast<const float*>(mapped) + y * pitch + 8 * (i / 3) + i % 3;
      const float mean = std::fmin((p[0] + p[4] + p[pitch] + p[pitch + 4]) / 4, 1.0F);
      const float curve = mean <= 0.0031308F ? 12.92F * mean : 1.055F * std::pow(mean, 1 / 2.4F) - 0.055F; // sRGB
      file.put(static_cast<char>(std::lround(255 * curve)));
    }
  }
  check(static_cast<bool>(file.flush()), std::string("cannot write ") + path);
}

void draw(const char* path) {
  const Host host = createHost();
  std::string reason;
  VitrailD3d12ContextDesc contextDesc{};
  contextDesc.device = host.device;
  contextDesc.log = [](VitrailLogSeverity, const char* text, void* user) { *static_cast<std::string*>(user) = text; };
  contextDesc.logUser = &reason;
  VitrailD3d12Context context = nullptr;
  check(vitrailD3d12CreateContext(&contextDesc, &context) == VITRAIL_SUCCESS, reason);
  VitrailD3d12TargetDesc desc{};
  desc.width = kWidth;
  desc.height = kHeight;
  desc.nodeCapacity = 8'000'000;
  desc.colorFormat = kColor;
  desc.views.count = 1;
  desc.views.color = &host.color;
  VitrailD3d12Target target = nullptr;
  check(vitrailD3d12CreateTarget(context, &desc, &target) == VITRAIL_SUCCESS, reason);
  drawFrame(host, target);
  save(host, path);
  VitrailStats stats{};
  check(vitrailD3d12ReadStats(target, 0, &stats) == VITRAIL_SUCCESS && stats.complete, "the node pool is too small");
  vitrailD3d12DestroyTarget(target);
  vitrailD3d12DestroyContext(context);
}
} // namespace

int main(int argc, char** argv) {
  try {
    check(argc == 2, std::string("usage: d3d12 PICTURE.ppm"));
    draw(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "d3d12: error: %s\n", error.what());
    return 1;
  }
}
