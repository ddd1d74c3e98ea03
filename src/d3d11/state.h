// Puts back what a call changes of a device context's state.
#pragma once

#include <d3d11_1.h>

#include <array>
#include <cstddef>

#include "direct3d/bytecode.h"
#include "direct3d/com.h"
#include "vitrail/bindings.h"

namespace vitrail {

// While it lives, commands run whatever the host's predicate says.
class SavedPredication {
 public:
  explicit SavedPredication(ID3D11DeviceContext* commands);
  ~SavedPredication();
  SavedPredication(const SavedPredication&) = delete;
  SavedPredication& operator=(const SavedPredication&) = delete;

 private:
  ID3D11DeviceContext* commands_;
  Com<ID3D11Predicate> predicate_;
  BOOL value_ = FALSE;
};

constexpr UINT kKernelConstants = 2;      // b0 and b1
constexpr UINT kMostClassInstances = 256; // of a shader
using ClassInstances = std::array<ID3D11ClassInstance*, kMostClassInstances>;

// A shader stage's shader with its class instances.
template <class Shader>
struct SavedShader {
  Com<Shader> shader;
  ClassInstances instances{};
  UINT count = kMostClassInstances;
};

// What compute kernels set.
class SavedCompute {
 public:
  explicit SavedCompute(ID3D11DeviceContext* commands);
  ~SavedCompute();
  SavedCompute(const SavedCompute&) = delete;
  SavedCompute& operator=(const SavedCompute&) = delete;

 private:
  ID3D11DeviceContext* commands_;
  SavedShader<ID3D11ComputeShader> shader_;
  std::array<ID3D11Buffer*, kKernelConstants> constants_{};
  std::array<ID3D11ShaderResourceView*, VITRAIL_VIEW_BINDINGS> resources_{};
  std::array<ID3D11UnorderedAccessView*, VITRAIL_BINDINGS> views_{};
};

// What the full-screen triangle sets. Render targets and the depth-stencil view stay.
class SavedDraw {
 public:
  // `uavSlots`: of the device.
  SavedDraw(ID3D11DeviceContext* commands, UINT uavSlots);
  ~SavedDraw();
  SavedDraw(const SavedDraw&) = delete;
  SavedDraw& operator=(const SavedDraw&) = delete;

  // Shader resource views of pixel shaders that are saved: t0 to t12.
  static constexpr UINT kResources = kPixelBufferSlot + VITRAIL_BINDING_SUMS + 1;

 private:
  void saveShaders();
  void restoreShaders();

  ID3D11DeviceContext* commands_;
  SavedShader<ID3D11VertexShader> vertex_;
  SavedShader<ID3D11HullShader> hull_;
  SavedShader<ID3D11DomainShader> domain_;
  SavedShader<ID3D11GeometryShader> geometry_;
  SavedShader<ID3D11PixelShader> pixel_;
  std::array<ID3D11Buffer*, kKernelConstants> constants_{};
  std::array<ID3D11ShaderResourceView*, kResources> resources_{};
  std::array<ID3D11UnorderedAccessView*, D3D11_1_UAV_SLOT_COUNT> views_{};
  Com<ID3D11InputLayout> inputLayout_;
  D3D11_PRIMITIVE_TOPOLOGY topology_ = D3D11_PRIMITIVE_TOPOLOGY_UNDEFINED;
  Com<ID3D11RasterizerState> rasterizing_;
  std::array<D3D11_VIEWPORT, D3D11_VIEWPORT_AND_SCISSORRECT_OBJECT_COUNT_PER_PIPELINE> viewports_{};
  UINT viewportCount_ = D3D11_VIEWPORT_AND_SCISSORRECT_OBJECT_COUNT_PER_PIPELINE;
  std::array<D3D11_RECT, D3D11_VIEWPORT_AND_SCISSORRECT_OBJECT_COUNT_PER_PIPELINE> scissors_{};
  UINT scissorCount_ = D3D11_VIEWPORT_AND_SCISSORRECT_OBJECT_COUNT_PER_PIPELINE;
  Com<ID3D11BlendState> blending_;
  std::array<FLOAT, 4> blendFactor_{};
  UINT sampleMask_ = 0;
  Com<ID3D11DepthStencilState> testing_;
  UINT stencilReference_ = 0;
};

// Unordered access views behind the render targets that are set, which stay; null in the slots before and behind.
void setPixelViews(ID3D11DeviceContext* commands, UINT slot, UINT count, ID3D11UnorderedAccessView* const* views);

} // namespace vitrail
