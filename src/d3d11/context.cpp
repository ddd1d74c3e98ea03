// Creation and destruction of a context: reads limits, keeps shaders.
#include "context.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <new>

#include "core/target_rules.h"

namespace vitrail {

namespace {

constexpr std::uint32_t kUavs = 4;  // of vitrailD3d11Bind()
constexpr std::uint32_t kLists = 3; // of vitrailD3d11BindLists()

// The sum of 1, 2, 4 and 8, as far as textures of that format have them.
std::uint32_t sampleCountsOf(ID3D11Device* device, DXGI_FORMAT format) {
  std::uint32_t sum = 1;
  for (const std::uint32_t samples : {2U, 4U, 8U}) {
    UINT levels = 0;
    if (SUCCEEDED(device->CheckMultisampleQualityLevels(format, samples, &levels)) && levels > 0) sum |= samples;
  }
  return sum;
}

std::uint64_t memoryOf(ID3D11Device* device) {
  constexpr std::uint64_t kUnknown = std::uint64_t{1} << 40U;
  Com<IDXGIDevice> dxgi;
  Com<IDXGIAdapter> adapter;
  DXGI_ADAPTER_DESC desc{};
  if (FAILED(device->QueryInterface(IID_PPV_ARGS(dxgi.out()))) || FAILED(dxgi->GetAdapter(adapter.out())) ||
      FAILED(adapter->GetDesc(&desc))) {
    return kUnknown;
  }
  const std::uint64_t bytes = std::max<std::uint64_t>(desc.DedicatedVideoMemory, desc.SharedSystemMemory);
  return bytes > 0 ? bytes : kUnknown;
}

void readLimits(VitrailD3d11Context_T& context) {
  ID3D11Device* device = context.device.get();
  DeviceLimits& limits = context.limits;
  limits.storageBufferRange = (std::uint64_t{1} << D3D11_REQ_BUFFER_RESOURCE_TEXEL_COUNT_2_TO_EXP) * 4;
  limits.heapSize = memoryOf(device);
  limits.allocationSize = limits.heapSize;
  limits.alignment = D3D11_RAW_UAV_SRV_BYTE_ALIGNMENT;
  limits.sampleCounts =
      sampleCountsOf(device, DXGI_FORMAT_R16G16B16A16_FLOAT) & sampleCountsOf(device, DXGI_FORMAT_D32_FLOAT);
  limits.networks = false; // the kernels for this API sort by insertion
  limits.dualSourceBlending = true;
  limits.sampleShading = true;
  context.uavSlots =
      device->GetFeatureLevel() >= D3D_FEATURE_LEVEL_11_1 ? D3D11_1_UAV_SLOT_COUNT : D3D11_PS_CS_UAV_REGISTER_COUNT;
}

VitrailResult checkSlots(const VitrailD3d11Context_T& context) {
  const Log& log = context.log;
  if (context.constantSlot >= D3D11_COMMONSHADER_CONSTANT_BUFFER_API_SLOT_COUNT) {
    return log.fail(VITRAIL_ERROR_INVALID, "constantSlot %u: the last one is %u", context.constantSlot,
                    D3D11_COMMONSHADER_CONSTANT_BUFFER_API_SLOT_COUNT - 1);
  }
  if (context.uavSlot + kUavs > context.uavSlots) {
    return log.fail(VITRAIL_ERROR_INVALID, "uavSlot %u: %u slots from there on are taken, the device has %u",
                    context.uavSlot, kUavs, context.uavSlots);
  }
  if (context.listSlot + kLists > D3D11_COMMONSHADER_INPUT_RESOURCE_SLOT_COUNT) {
    return log.fail(VITRAIL_ERROR_INVALID, "listSlot %u: %u slots from there on are taken, there are %u",
                    context.listSlot, kLists, D3D11_COMMONSHADER_INPUT_RESOURCE_SLOT_COUNT);
  }
  return VITRAIL_SUCCESS;
}

VitrailResult refused(const VitrailD3d11Context_T& context, const char* name, HRESULT result) {
  return context.log.fail(VITRAIL_ERROR_UNSUPPORTED, "%s: the device does not take its shader: 0x%08lx", name,
                          static_cast<unsigned long>(result));
}

} // namespace

void nameObject(ID3D11DeviceChild* object, const char* prefix, const char* what) {
  // WKPDID_D3DDebugObjectName, which is in a library of its own.
  constexpr GUID kName = {0x429b8c22, 0x9188, 0x4b0c, {0x87, 0x42, 0xac, 0xb0, 0xbf, 0x85, 0xc2, 0x00}};
  char text[96];
  const int length = std::snprintf(text, sizeof(text), "%.40s %s", prefix, what);
  object->SetPrivateData(kName, static_cast<UINT>(length), text);
}

void releaseContext(VitrailD3d11Context context) {
  if (context->owners.fetch_sub(1) > 1) return;
  delete context;
}

VitrailResult nullArgument(const VitrailD3d11Context_T* context, const char* call) {
  if (context != nullptr) context->log.error("%s: an argument is null", call);
  return VITRAIL_ERROR_INVALID;
}

VitrailResult findShader(VitrailD3d11Context_T& context, Bytecode code, const char* name,
                         Com<ID3D11ComputeShader>& shader) {
  const std::lock_guard lock(context.shadersMutex);
  Com<ID3D11ComputeShader>& kept = context.computeShaders[code.data()];
  if (!kept) {
    const HRESULT result = context.device->CreateComputeShader(code.data(), code.size(), nullptr, kept.out());
    if (FAILED(result)) return refused(context, name, result);
    nameObject(kept.get(), "vitrail", name);
  }
  shader = kept;
  return VITRAIL_SUCCESS;
}

VitrailResult findShader(VitrailD3d11Context_T& context, Bytecode code, const char* name,
                         Com<ID3D11PixelShader>& shader) {
  const std::lock_guard lock(context.shadersMutex);
  if (!context.triangle) {
    const Bytecode vertex = vertexBytecode();
    const HRESULT result =
        context.device->CreateVertexShader(vertex.data(), vertex.size(), nullptr, context.triangle.out());
    if (FAILED(result)) return refused(context, "triangle", result);
    nameObject(context.triangle.get(), "vitrail", "triangle");
  }
  Com<ID3D11PixelShader>& kept = context.pixelShaders[code.data()];
  if (!kept) {
    const HRESULT result = context.device->CreatePixelShader(code.data(), code.size(), nullptr, kept.out());
    if (FAILED(result)) return refused(context, name, result);
    nameObject(kept.get(), "vitrail", name);
  }
  shader = kept;
  return VITRAIL_SUCCESS;
}

} // namespace vitrail

extern "C" VitrailResult vitrailD3d11CreateContext(const VitrailD3d11ContextDesc* desc, VitrailD3d11Context* context) {
  using namespace vitrail;
  if (context != nullptr) *context = nullptr;
  const Log log = desc != nullptr ? Log{desc->log, desc->logUser} : Log{};
  if (desc == nullptr || context == nullptr) {
    return log.fail(VITRAIL_ERROR_INVALID, "vitrailD3d11CreateContext: an argument is null");
  }
  if (checkNoNext(log, desc->next, "VitrailD3d11ContextDesc") != VITRAIL_SUCCESS) return VITRAIL_ERROR_INVALID;
  if (desc->device == nullptr) return log.fail(VITRAIL_ERROR_INVALID, "VitrailD3d11ContextDesc needs device");
  if (desc->device->GetFeatureLevel() < D3D_FEATURE_LEVEL_11_0) {
    return log.fail(VITRAIL_ERROR_UNSUPPORTED,
                    "the device has feature level 0x%x: create one with D3D_FEATURE_LEVEL_11_0 or later",
                    static_cast<unsigned>(desc->device->GetFeatureLevel()));
  }
  std::unique_ptr<VitrailD3d11Context_T> made(new (std::nothrow) VitrailD3d11Context_T);
  if (!made) return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "no memory for a context");
  made->device = Com<ID3D11Device>::shared(desc->device);
  made->log = log;
  if (desc->constantSlot != 0) made->constantSlot = desc->constantSlot;
  if (desc->uavSlot != 0) made->uavSlot = desc->uavSlot;
  if (desc->listSlot != 0) made->listSlot = desc->listSlot;
  readLimits(*made);
  const VitrailResult result = checkSlots(*made);
  if (result != VITRAIL_SUCCESS) return result;
  *context = made.release();
  return VITRAIL_SUCCESS;
}

extern "C" void vitrailD3d11DestroyContext(VitrailD3d11Context context) {
  if (context == nullptr) return;
  const std::uint32_t targets = context->owners.load() - 1;
  if (targets > 0) {
    context->log.error(
        "vitrailD3d11DestroyContext: targets are left (%u): destroy them first; the context is freed with the last of "
        "them",
        targets);
  }
  vitrail::releaseContext(context);
}

extern "C" uint32_t vitrailD3d11MaxNodeCapacity(VitrailD3d11Context context, VitrailNodeFormat format,
                                                uint32_t samples) {
  if (context == nullptr) return 0;
  return vitrail::maxNodeCapacity(context->limits, format, samples, false);
}

extern "C" VitrailResult vitrailD3d11TileLimits(VitrailD3d11Context context, VitrailNodeFormat format, uint32_t samples,
                                                VitrailTileLimits* limits) {
  using namespace vitrail;
  if (limits != nullptr) clearKeepingNext(*limits);
  if (context == nullptr || limits == nullptr) return nullArgument(context, "vitrailD3d11TileLimits");
  return tileLimits(context->limits, context->log, format, samples, *limits);
}
