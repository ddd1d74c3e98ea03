// What the library keeps for one device: limits, shaders, state objects.
#pragma once

#include <d3d11_1.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>

#include "core/device_limits.h"
#include "core/log.h"
#include "core/structures.h"
#include "direct3d/bytecode.h"
#include "direct3d/com.h"
#include "vitrail/d3d11.h"

struct VitrailD3d11Context_T {
  vitrail::Com<ID3D11Device> device;
  vitrail::Log log;
  vitrail::DeviceLimits limits;
  std::uint32_t constantSlot = 13;
  std::uint32_t uavSlot = 1;
  std::uint32_t listSlot = 120;
  std::uint32_t uavSlots = 8; // that the device has
  std::mutex shadersMutex;    // guards the maps
  // By where their code is, which is there once.
  std::map<const unsigned char*, vitrail::Com<ID3D11ComputeShader>> computeShaders;
  std::map<const unsigned char*, vitrail::Com<ID3D11PixelShader>> pixelShaders;
  vitrail::Com<ID3D11VertexShader> triangle;
  // The handle and its targets: what the context has is freed with the last of them.
  std::atomic<std::uint32_t> owners{1};
};

namespace vitrail {

// One owner less.
void releaseContext(VitrailD3d11Context context);

// Logs that an argument of a call is null.
VitrailResult nullArgument(const VitrailD3d11Context_T* context, const char* call);

// Names an object for debuggers.
void nameObject(ID3D11DeviceChild* object, const char* prefix, const char* what);

// The shader of some bytecode, which the context keeps. Logs its errors.
VitrailResult findShader(VitrailD3d11Context_T& context, Bytecode code, const char* name,
                         Com<ID3D11ComputeShader>& shader);
VitrailResult findShader(VitrailD3d11Context_T& context, Bytecode code, const char* name,
                         Com<ID3D11PixelShader>& shader);

} // namespace vitrail
