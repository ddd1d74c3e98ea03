// Creation and destruction of a context: reads limits, makes root signatures, keeps pipelines.
#include "context.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <new>

#include "bytecode/root_compute.h"
#include "bytecode/root_draw.h"
#include "bytecode/root_words.h"
#include "bytecode/words.h"
#include "core/target_rules.h"

namespace vitrail {

namespace {

// The sum of 1, 2, 4 and 8, as far as textures of that format have them.
std::uint32_t sampleCountsOf(ID3D12Device* device, DXGI_FORMAT format) {
  std::uint32_t sum = 1;
  for (const std::uint32_t samples : {2U, 4U, 8U}) {
    D3D12_FEATURE_DATA_MULTISAMPLE_QUALITY_LEVELS levels{};
    levels.Format = format;
    levels.SampleCount = samples;
    const HRESULT result =
        device->CheckFeatureSupport(D3D12_FEATURE_MULTISAMPLE_QUALITY_LEVELS, &levels, sizeof(levels));
    if (SUCCEEDED(result) && levels.NumQualityLevels > 0) sum |= samples;
  }
  return sum;
}

// Bytes that one resource can have.
std::uint64_t addressable(ID3D12Device* device) {
  constexpr UINT kBits = 40;
  D3D12_FEATURE_DATA_GPU_VIRTUAL_ADDRESS_SUPPORT support{};
  const HRESULT result =
      device->CheckFeatureSupport(D3D12_FEATURE_GPU_VIRTUAL_ADDRESS_SUPPORT, &support, sizeof(support));
  const UINT bits = SUCCEEDED(result) && support.MaxGPUVirtualAddressBitsPerResource > 0
                        ? support.MaxGPUVirtualAddressBitsPerResource
                        : kBits;
  return std::uint64_t{1} << std::min(bits, kBits);
}

void readLimits(VitrailD3d12Context_T& context, std::uint64_t memoryBytes) {
  ID3D12Device* device = context.device.get();
  DeviceLimits& limits = context.limits;
  constexpr unsigned kTexelBits = 27; // D3D12_REQ_BUFFER_RESOURCE_TEXEL_COUNT_2_TO_EXP, which not all headers have
  limits.storageBufferRange = (std::uint64_t{1} << kTexelBits) * 4;
  limits.heapSize = addressable(device);
  if (memoryBytes != 0) limits.heapSize = std::min(limits.heapSize, memoryBytes);
  limits.allocationSize = limits.heapSize;
  limits.alignment = D3D12_CONSTANT_BUFFER_DATA_PLACEMENT_ALIGNMENT;
  limits.sampleCounts =
      sampleCountsOf(device, DXGI_FORMAT_R16G16B16A16_FLOAT) & sampleCountsOf(device, DXGI_FORMAT_D32_FLOAT);
  limits.networks = false; // the kernels for this API sort by insertion
  limits.dualSourceBlending = true;
  limits.sampleShading = true;
  context.descriptorBytes = device->GetDescriptorHandleIncrementSize(D3D12_DESCRIPTOR_HEAP_TYPE_CBV_SRV_UAV);
}

VitrailResult refused(const VitrailD3d12Context_T& context, const char* name, HRESULT result) {
  return context.log.fail(VITRAIL_ERROR_UNSUPPORTED, "%s: the device does not take it: 0x%08lx", name,
                          static_cast<unsigned long>(result));
}

template <std::size_t Bytes>
VitrailResult createRoot(const VitrailD3d12Context_T& context, const unsigned char (&code)[Bytes], const char* name,
                         Com<ID3D12RootSignature>& root) {
  const HRESULT result = context.device->CreateRootSignature(0, code, Bytes, kGuid<ID3D12RootSignature>, outOf(root));
  if (FAILED(result)) return refused(context, name, result);
  nameObject(root.get(), "vitrail", name);
  return VITRAIL_SUCCESS;
}

VitrailResult createSignature(const VitrailD3d12Context_T& context, D3D12_INDIRECT_ARGUMENT_TYPE type, UINT bytes,
                              const char* name, Com<ID3D12CommandSignature>& signature) {
  D3D12_INDIRECT_ARGUMENT_DESC argument{};
  argument.Type = type;
  D3D12_COMMAND_SIGNATURE_DESC desc{};
  desc.ByteStride = bytes;
  desc.NumArgumentDescs = 1;
  desc.pArgumentDescs = &argument;
  const HRESULT result =
      context.device->CreateCommandSignature(&desc, nullptr, kGuid<ID3D12CommandSignature>, outOf(signature));
  if (FAILED(result)) return refused(context, name, result);
  nameObject(signature.get(), "vitrail", name);
  return VITRAIL_SUCCESS;
}

VitrailResult createPipeline(const VitrailD3d12Context_T& context, ID3D12RootSignature* root, Bytecode code,
                             const char* name, Com<ID3D12PipelineState>& pipeline) {
  D3D12_COMPUTE_PIPELINE_STATE_DESC desc{};
  desc.pRootSignature = root;
  desc.CS = {code.data(), code.size()};
  const HRESULT result = context.device->CreateComputePipelineState(&desc, kGuid<ID3D12PipelineState>, outOf(pipeline));
  if (FAILED(result)) return refused(context, name, result);
  nameObject(pipeline.get(), "vitrail", name);
  return VITRAIL_SUCCESS;
}

VitrailResult createObjects(VitrailD3d12Context_T& context) {
  using namespace bytecode;
  VitrailResult result = createRoot(context, root_words, "root signature of words", context.wordsRoot);
  if (result == VITRAIL_SUCCESS) {
    result = createRoot(context, root_compute, "root signature of kernels", context.computeRoot);
  }
  if (result == VITRAIL_SUCCESS) result = createRoot(context, root_draw, "root signature of draws", context.drawRoot);
  if (result == VITRAIL_SUCCESS) {
    result = createSignature(context, D3D12_INDIRECT_ARGUMENT_TYPE_DISPATCH, sizeof(D3D12_DISPATCH_ARGUMENTS),
                             "dispatches", context.dispatches);
  }
  if (result == VITRAIL_SUCCESS) {
    result = createSignature(context, D3D12_INDIRECT_ARGUMENT_TYPE_DRAW, sizeof(D3D12_DRAW_ARGUMENTS), "draws",
                             context.draws);
  }
  if (result == VITRAIL_SUCCESS) {
    result = createPipeline(context, context.wordsRoot.get(), Bytecode(words), "words", context.words);
  }
  return result;
}

} // namespace

void nameObject(ID3D12Object* object, const char* prefix, const char* what) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%.40s %s", prefix, what);
  std::array<WCHAR, 96> name{};
  std::copy(text.begin(), text.end(), name.begin());
  object->SetName(name.data());
}

void releaseContext(VitrailD3d12Context context) {
  if (context->owners.fetch_sub(1) > 1) return;
  delete context;
}

VitrailResult nullArgument(const VitrailD3d12Context_T* context, const char* call) {
  if (context != nullptr) context->log.error("%s: an argument is null", call);
  return VITRAIL_ERROR_INVALID;
}

VitrailResult findPipeline(VitrailD3d12Context_T& context, Bytecode code, const char* name,
                           Com<ID3D12PipelineState>& pipeline) {
  const std::lock_guard lock(context.pipelinesMutex);
  Com<ID3D12PipelineState>& kept = context.pipelines[code.data()];
  if (!kept) {
    const VitrailResult result = createPipeline(context, context.computeRoot.get(), code, name, kept);
    if (result != VITRAIL_SUCCESS) return result;
  }
  pipeline = kept;
  return VITRAIL_SUCCESS;
}

} // namespace vitrail

extern "C" VitrailResult vitrailD3d12CreateContext(const VitrailD3d12ContextDesc* desc, VitrailD3d12Context* context) {
  using namespace vitrail;
  if (context != nullptr) *context = nullptr;
  const Log log = desc != nullptr ? Log{desc->log, desc->logUser} : Log{};
  if (desc == nullptr || context == nullptr) {
    return log.fail(VITRAIL_ERROR_INVALID, "vitrailD3d12CreateContext: an argument is null");
  }
  if (checkNoNext(log, desc->next, "VitrailD3d12ContextDesc") != VITRAIL_SUCCESS) return VITRAIL_ERROR_INVALID;
  if (desc->device == nullptr) return log.fail(VITRAIL_ERROR_INVALID, "VitrailD3d12ContextDesc needs device");
  std::unique_ptr<VitrailD3d12Context_T> made(new (std::nothrow) VitrailD3d12Context_T);
  if (!made) return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "no memory for a context");
  made->device = Com<ID3D12Device>::shared(desc->device);
  made->log = log;
  readLimits(*made, desc->memoryBytes);
  const VitrailResult result = createObjects(*made);
  if (result != VITRAIL_SUCCESS) return result;
  *context = made.release();
  return VITRAIL_SUCCESS;
}

extern "C" void vitrailD3d12DestroyContext(VitrailD3d12Context context) {
  if (context == nullptr) return;
  const std::uint32_t targets = context->owners.load() - 1;
  if (targets > 0) {
    context->log.error(
        "vitrailD3d12DestroyContext: targets are left (%u): destroy them first; the context is freed with the last of "
        "them",
        targets);
  }
  vitrail::releaseContext(context);
}

extern "C" uint32_t vitrailD3d12MaxNodeCapacity(VitrailD3d12Context context, VitrailNodeFormat format,
                                                uint32_t samples) {
  if (context == nullptr) return 0;
  return vitrail::maxNodeCapacity(context->limits, format, samples, false);
}

extern "C" VitrailResult vitrailD3d12TileLimits(VitrailD3d12Context context, VitrailNodeFormat format, uint32_t samples,
                                                VitrailTileLimits* limits) {
  using namespace vitrail;
  if (limits != nullptr) clearKeepingNext(*limits);
  if (context == nullptr || limits == nullptr) return nullArgument(context, "vitrailD3d12TileLimits");
  return tileLimits(context->limits, context->log, format, samples, *limits);
}
