// What the library keeps for one device: limits, root signatures, compute pipelines.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>

#include "api.h"
#include "core/device_limits.h"
#include "core/log.h"
#include "core/structures.h"
#include "direct3d/bytecode.h"
#include "vitrail/d3d12.h"

struct VitrailD3d12Context_T {
  vitrail::Com<ID3D12Device> device;
  vitrail::Log log;
  vitrail::DeviceLimits limits;
  UINT descriptorBytes = 0; // of a heap of views
  vitrail::Com<ID3D12RootSignature> wordsRoot;
  vitrail::Com<ID3D12RootSignature> computeRoot;
  vitrail::Com<ID3D12RootSignature> drawRoot;
  vitrail::Com<ID3D12CommandSignature> dispatches;
  vitrail::Com<ID3D12CommandSignature> draws;
  vitrail::Com<ID3D12PipelineState> words; // words.hlsl
  std::mutex pipelinesMutex;               // guards `pipelines`
  // By where their code is, which is there once.
  std::map<const unsigned char*, vitrail::Com<ID3D12PipelineState>> pipelines;
  // The handle and its targets: what the context has is freed with the last of them.
  std::atomic<std::uint32_t> owners{1};
};

namespace vitrail {

// The root parameters of root.hlsl, in their order.
enum WordsRoot : UINT { kWordsConstants, kWordsBuffer };
enum ComputeRoot : UINT { kComputeParameters, kComputeConstants, kComputeBuffers, kComputeImages };
enum DrawRoot : UINT { kDrawParameters, kDrawConstants, kDrawCounters, kDrawHeads, kDrawNodes, kDrawSums, kDrawImages };

// One owner less.
void releaseContext(VitrailD3d12Context context);

// Logs that an argument of a call is null.
VitrailResult nullArgument(const VitrailD3d12Context_T* context, const char* call);

// Names an object for debuggers.
void nameObject(ID3D12Object* object, const char* prefix, const char* what);

// The compute pipeline of some bytecode, which the context keeps. Logs its errors.
VitrailResult findPipeline(VitrailD3d12Context_T& context, Bytecode code, const char* name,
                           Com<ID3D12PipelineState>& pipeline);

} // namespace vitrail
