/* The header in C: by itself, and beside Direct3D's own. */
#include <vitrail/d3d12.h>

#ifdef _WIN32
#define COBJMACROS
#include <d3d12.h>
#else
#include <vkd3d_windows.h>

#include <vkd3d_d3d12.h>
#endif

/* A call is made with what each of the headers declares. */
VitrailResult contextFromC(ID3D12Device* device, VitrailD3d12Context* context);
VitrailResult contextFromC(ID3D12Device* device, VitrailD3d12Context* context) {
  VitrailD3d12ContextDesc desc = {0};
  desc.device = device;
  return vitrailD3d12CreateContext(&desc, context);
}
