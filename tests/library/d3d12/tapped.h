// A command list that records into another one and watches what is recorded: which state of the list is set, and
// whether resources are in the state that they are used in. It stands in for Direct3D 12's debug layer.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "device.h"

namespace vitrail::tests::d3d12 {

class TappedList : public ID3D12GraphicsCommandList {
 public:
  explicit TappedList(ID3D12GraphicsCommandList* list) : list_(list) {}
  TappedList(const TappedList&) = delete;
  TappedList& operator=(const TappedList&) = delete;
  virtual ~TappedList() = default;

  // The calls that have set state of the list since the last look, but for arguments of root parameters.
  std::set<std::string> takeChanges();
  std::size_t takeBarriers();
  // What was wrong, one text each.
  [[nodiscard]] const std::vector<std::string>& errors() const { return errors_; }
  // The state that a resource was left in; COMMON where no barrier has named it.
  [[nodiscard]] D3D12_RESOURCE_STATES stateOf(ID3D12Resource* resource) const;
  // Resources that barriers have named, which tests know by what they were in last.
  [[nodiscard]] std::vector<D3D12_RESOURCE_STATES> bufferStates() const;

  // For negative controls: barriers of unordered access, or transitions, are left out.
  bool dropsWaits = false;
  bool dropsTransitions = false;

  // ---- IUnknown, ID3D12Object, ID3D12DeviceChild, ID3D12CommandList: nobody asks much of them

  HRESULT STDMETHODCALLTYPE QueryInterface(REFIID /*id*/, void** object) override {
    *object = nullptr;
    return E_NOINTERFACE;
  }
  ULONG STDMETHODCALLTYPE AddRef() override { return 1; }
  ULONG STDMETHODCALLTYPE Release() override { return 1; }
  HRESULT STDMETHODCALLTYPE GetPrivateData(REFGUID /*id*/, UINT* /*size*/, void* /*data*/) override { return E_FAIL; }
  HRESULT STDMETHODCALLTYPE SetPrivateData(REFGUID /*id*/, UINT /*size*/, const void* /*data*/) override {
    return E_FAIL;
  }
  HRESULT STDMETHODCALLTYPE SetPrivateDataInterface(REFGUID /*id*/, const IUnknown* /*data*/) override {
    return E_FAIL;
  }
  HRESULT STDMETHODCALLTYPE SetName(const WCHAR* /*name*/) override { return S_OK; }
  HRESULT STDMETHODCALLTYPE GetDevice(REFIID /*id*/, void** /*device*/) override { return E_FAIL; }
  D3D12_COMMAND_LIST_TYPE STDMETHODCALLTYPE GetType() override { return list_->GetType(); }

  // ---- What the library and the point host call

  void STDMETHODCALLTYPE ResourceBarrier(UINT count, const D3D12_RESOURCE_BARRIER* barriers) override;
  void STDMETHODCALLTYPE CopyBufferRegion(ID3D12Resource* to, UINT64 toOffset, ID3D12Resource* from, UINT64 fromOffset,
                                          UINT64 bytes) override;
  void STDMETHODCALLTYPE CopyTextureRegion(const D3D12_TEXTURE_COPY_LOCATION* to, UINT x, UINT y, UINT z,
                                           const D3D12_TEXTURE_COPY_LOCATION* from, const D3D12_BOX* box) override;
  void STDMETHODCALLTYPE Dispatch(UINT x, UINT y, UINT z) override;
  void STDMETHODCALLTYPE DrawInstanced(UINT vertices, UINT instances, UINT first, UINT firstInstance) override;
  void STDMETHODCALLTYPE ExecuteIndirect(ID3D12CommandSignature* signature, UINT most, ID3D12Resource* arguments,
                                         UINT64 offset, ID3D12Resource* count, UINT64 countOffset) override;
  void STDMETHODCALLTYPE SetComputeRootSignature(ID3D12RootSignature* root) override;
  void STDMETHODCALLTYPE SetGraphicsRootSignature(ID3D12RootSignature* root) override;

#define VITRAIL_ROOT(stage, kind, state)                                                                   \
  void STDMETHODCALLTYPE Set##stage##Root##kind(UINT number, D3D12_GPU_VIRTUAL_ADDRESS address) override { \
    roots##stage##_[number] = {address, state};                                                            \
    list_->Set##stage##Root##kind(number, address);                                                        \
  }
  VITRAIL_ROOT(Compute, ConstantBufferView, D3D12_RESOURCE_STATE_VERTEX_AND_CONSTANT_BUFFER)
  VITRAIL_ROOT(Compute, ShaderResourceView, D3D12_RESOURCE_STATE_NON_PIXEL_SHADER_RESOURCE)
  VITRAIL_ROOT(Compute, UnorderedAccessView, D3D12_RESOURCE_STATE_UNORDERED_ACCESS)
  VITRAIL_ROOT(Graphics, ConstantBufferView, D3D12_RESOURCE_STATE_VERTEX_AND_CONSTANT_BUFFER)
  VITRAIL_ROOT(Graphics, ShaderResourceView, D3D12_RESOURCE_STATE_PIXEL_SHADER_RESOURCE)
  VITRAIL_ROOT(Graphics, UnorderedAccessView, D3D12_RESOURCE_STATE_UNORDERED_ACCESS)
#undef VITRAIL_ROOT

  void STDMETHODCALLTYPE SetComputeRootDescriptorTable(UINT number, D3D12_GPU_DESCRIPTOR_HANDLE table) override {
    tables_ = true;
    list_->SetComputeRootDescriptorTable(number, table);
  }

  // ---- The rest is handed on

#define VITRAIL_FORWARD(name, parameters, arguments) \
  void STDMETHODCALLTYPE name parameters override { list_->name arguments; }
#define VITRAIL_NOTED(name, parameters, arguments)  \
  void STDMETHODCALLTYPE name parameters override { \
    changes_.insert(#name);                         \
    list_->name arguments;                          \
  }
  HRESULT STDMETHODCALLTYPE Close() override { return list_->Close(); }
  HRESULT STDMETHODCALLTYPE Reset(ID3D12CommandAllocator* allocator, ID3D12PipelineState* state) override {
    return list_->Reset(allocator, state);
  }
  HRESULT STDMETHODCALLTYPE ClearState(ID3D12PipelineState* state) override {
    changes_.insert("ClearState");
    return list_->ClearState(state);
  }
  VITRAIL_NOTED(IASetPrimitiveTopology, (D3D12_PRIMITIVE_TOPOLOGY a), (a))
  VITRAIL_NOTED(RSSetViewports, (UINT a, const D3D12_VIEWPORT* b), (a, b))
  VITRAIL_NOTED(RSSetScissorRects, (UINT a, const D3D12_RECT* b), (a, b))
  VITRAIL_NOTED(OMSetBlendFactor, (const FLOAT a[4]), (a))
  VITRAIL_NOTED(OMSetStencilRef, (UINT a), (a))
  VITRAIL_NOTED(SetPipelineState, (ID3D12PipelineState * a), (a))
  VITRAIL_NOTED(SetDescriptorHeaps, (UINT a, ID3D12DescriptorHeap* const* b), (a, b))
  VITRAIL_NOTED(IASetIndexBuffer, (const D3D12_INDEX_BUFFER_VIEW* a), (a))
  VITRAIL_NOTED(IASetVertexBuffers, (UINT a, UINT b, const D3D12_VERTEX_BUFFER_VIEW* c), (a, b, c))
  VITRAIL_NOTED(SOSetTargets, (UINT a, UINT b, const D3D12_STREAM_OUTPUT_BUFFER_VIEW* c), (a, b, c))
  VITRAIL_NOTED(OMSetRenderTargets,
                (UINT a, const D3D12_CPU_DESCRIPTOR_HANDLE* b, BOOL c, const D3D12_CPU_DESCRIPTOR_HANDLE* d),
                (a, b, c, d))
  VITRAIL_NOTED(SetPredication, (ID3D12Resource * a, UINT64 b, D3D12_PREDICATION_OP c), (a, b, c))
  VITRAIL_FORWARD(DrawIndexedInstanced, (UINT a, UINT b, UINT c, INT d, UINT e), (a, b, c, d, e))
  VITRAIL_FORWARD(CopyResource, (ID3D12Resource * a, ID3D12Resource* b), (a, b))
  VITRAIL_FORWARD(CopyTiles,
                  (ID3D12Resource * a, const D3D12_TILED_RESOURCE_COORDINATE* b, const D3D12_TILE_REGION_SIZE* c,
                   ID3D12Resource* d, UINT64 e, D3D12_TILE_COPY_FLAGS f),
                  (a, b, c, d, e, f))
  VITRAIL_FORWARD(ResolveSubresource, (ID3D12Resource * a, UINT b, ID3D12Resource* c, UINT d, DXGI_FORMAT e),
                  (a, b, c, d, e))
  VITRAIL_FORWARD(ExecuteBundle, (ID3D12GraphicsCommandList * a), (a))
  VITRAIL_FORWARD(SetGraphicsRootDescriptorTable, (UINT a, D3D12_GPU_DESCRIPTOR_HANDLE b), (a, b))
  VITRAIL_FORWARD(SetComputeRoot32BitConstant, (UINT a, UINT b, UINT c), (a, b, c))
  VITRAIL_FORWARD(SetGraphicsRoot32BitConstant, (UINT a, UINT b, UINT c), (a, b, c))
  VITRAIL_FORWARD(SetComputeRoot32BitConstants, (UINT a, UINT b, const void* c, UINT d), (a, b, c, d))
  VITRAIL_FORWARD(SetGraphicsRoot32BitConstants, (UINT a, UINT b, const void* c, UINT d), (a, b, c, d))
  VITRAIL_FORWARD(ClearDepthStencilView,
                  (D3D12_CPU_DESCRIPTOR_HANDLE a, D3D12_CLEAR_FLAGS b, FLOAT c, UINT8 d, UINT e, const D3D12_RECT* f),
                  (a, b, c, d, e, f))
  VITRAIL_FORWARD(ClearRenderTargetView, (D3D12_CPU_DESCRIPTOR_HANDLE a, const FLOAT b[4], UINT c, const D3D12_RECT* d),
                  (a, b, c, d))
  VITRAIL_FORWARD(ClearUnorderedAccessViewUint,
                  (D3D12_GPU_DESCRIPTOR_HANDLE a, D3D12_CPU_DESCRIPTOR_HANDLE b, ID3D12Resource* c, const UINT d[4],
                   UINT e, const D3D12_RECT* f),
                  (a, b, c, d, e, f))
  VITRAIL_FORWARD(ClearUnorderedAccessViewFloat,
                  (D3D12_GPU_DESCRIPTOR_HANDLE a, D3D12_CPU_DESCRIPTOR_HANDLE b, ID3D12Resource* c, const float d[4],
                   UINT e, const D3D12_RECT* f),
                  (a, b, c, d, e, f))
  VITRAIL_FORWARD(DiscardResource, (ID3D12Resource * a, const D3D12_DISCARD_REGION* b), (a, b))
  VITRAIL_FORWARD(BeginQuery, (ID3D12QueryHeap * a, D3D12_QUERY_TYPE b, UINT c), (a, b, c))
  VITRAIL_FORWARD(EndQuery, (ID3D12QueryHeap * a, D3D12_QUERY_TYPE b, UINT c), (a, b, c))
  VITRAIL_FORWARD(ResolveQueryData,
                  (ID3D12QueryHeap * a, D3D12_QUERY_TYPE b, UINT c, UINT d, ID3D12Resource* e, UINT64 f),
                  (a, b, c, d, e, f))
  VITRAIL_FORWARD(SetMarker, (UINT a, const void* b, UINT c), (a, b, c))
  VITRAIL_FORWARD(BeginEvent, (UINT a, const void* b, UINT c), (a, b, c))
  VITRAIL_FORWARD(EndEvent, (), ())
#undef VITRAIL_NOTED
#undef VITRAIL_FORWARD

 private:
  struct Root {
    D3D12_GPU_VIRTUAL_ADDRESS address = 0;
    D3D12_RESOURCE_STATES state = D3D12_RESOURCE_STATE_COMMON;
  };
  struct Known {
    D3D12_RESOURCE_STATES state = D3D12_RESOURCE_STATE_COMMON;
    D3D12_GPU_VIRTUAL_ADDRESS first = 0; // of buffers
    UINT64 bytes = 0;
    bool written = false; // without a barrier since
  };

  void error(const std::string& text) { errors_.push_back(text); }
  void expectState(ID3D12Resource* resource, D3D12_RESOURCE_STATES state, const std::string& what);
  void checkRoots(const std::map<UINT, Root>& roots, const std::string& what);
  void dispatched(const std::string& what);
  Known* bufferAt(D3D12_GPU_VIRTUAL_ADDRESS address);

  ID3D12GraphicsCommandList* list_;
  std::set<std::string> changes_;
  std::size_t barriers_ = 0;
  std::vector<std::string> errors_;
  std::map<ID3D12Resource*, Known> known_; // that barriers have named
  std::map<UINT, Root> rootsCompute_;
  std::map<UINT, Root> rootsGraphics_;
  bool tables_ = false; // of the compute root signature
};

} // namespace vitrail::tests::d3d12
