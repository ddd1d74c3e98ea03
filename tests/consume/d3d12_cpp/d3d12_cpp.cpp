// Makes a context and a target with the installed library, and records a frame without fragments.
#define WIDL_EXPLICIT_AGGREGATE_RETURNS
#define INITGUID
#include <vkd3d.h>
#include <vkd3d_utils.h>

#include <cstdio>

#include <vitrail/d3d12.h>

int main() {
  ID3D12Device* device = nullptr;
  ID3D12CommandAllocator* allocator = nullptr;
  ID3D12GraphicsCommandList* commands = nullptr;
  const auto kDirect = D3D12_COMMAND_LIST_TYPE_DIRECT;
  if (FAILED(D3D12CreateDevice(nullptr, D3D_FEATURE_LEVEL_11_0, IID_ID3D12Device, (void**)&device)) ||
      FAILED(device->CreateCommandAllocator(kDirect, IID_ID3D12CommandAllocator, (void**)&allocator)) ||
      FAILED(device->CreateCommandList(0, kDirect, allocator, nullptr, IID_ID3D12GraphicsCommandList,
                                       (void**)&commands))) {
    return 1;
  }
  VitrailD3d12ContextDesc contextDesc{};
  contextDesc.device = device;
  contextDesc.log = [](VitrailLogSeverity, const char* text, void*) { std::fprintf(stderr, "%s\n", text); };
  VitrailD3d12Context context = nullptr;
  if (vitrailD3d12CreateContext(&contextDesc, &context) != VITRAIL_SUCCESS) return 2;
  VitrailD3d12TargetDesc desc{};
  desc.width = desc.height = 16;
  desc.nodeCapacity = 1000;
  desc.resolve = VITRAIL_RESOLVE_HOST;
  VitrailD3d12Target target = nullptr;
  if (vitrailD3d12CreateTarget(context, &desc, &target) != VITRAIL_SUCCESS) return 3;
  vitrailD3d12Begin(target, commands, nullptr);
  vitrailD3d12Collected(target, commands);
  vitrailD3d12Resolve(target, commands, nullptr);
  vitrailD3d12End(target, commands);
  const bool closed = SUCCEEDED(commands->Close());
  vitrailD3d12DestroyTarget(target);
  vitrailD3d12DestroyContext(context);
  commands->Release();
  allocator->Release();
  device->Release();
  return closed ? 0 : 4;
}
