#include "state.h"

#include <algorithm>

namespace vitrail {

namespace {

// Gives back the references that a Get call has taken.
template <class Range>
void releaseAll(Range& interfaces) {
  for (auto* one : interfaces) {
    if (one != nullptr) one->Release();
  }
}

template <class Shader>
void releaseInstances(SavedShader<Shader>& saved) {
  for (UINT i = 0; i < saved.count; ++i) saved.instances.at(i)->Release();
}

} // namespace

void setPixelViews(ID3D11DeviceContext* commands, UINT slot, UINT count, ID3D11UnorderedAccessView* const* views) {
  std::array<UINT, D3D11_1_UAV_SLOT_COUNT> counters{};
  counters.fill(D3D11_KEEP_UNORDERED_ACCESS_VIEWS); // of append buffers: as they are
  commands->OMSetRenderTargetsAndUnorderedAccessViews(D3D11_KEEP_RENDER_TARGETS_AND_DEPTH_STENCIL, nullptr, nullptr,
                                                      slot, count, views, counters.data());
}

// ---- Predication

SavedPredication::SavedPredication(ID3D11DeviceContext* commands) : commands_(commands) {
  commands->GetPredication(predicate_.out(), &value_);
  if (predicate_) commands->SetPredication(nullptr, FALSE);
}

SavedPredication::~SavedPredication() {
  if (predicate_) commands_->SetPredication(predicate_.get(), value_);
}

// ---- Compute

SavedCompute::SavedCompute(ID3D11DeviceContext* commands) : commands_(commands) {
  commands->CSGetShader(shader_.shader.out(), shader_.instances.data(), &shader_.count);
  commands->CSGetConstantBuffers(0, countOf(constants_), constants_.data());
  commands->CSGetShaderResources(0, countOf(resources_), resources_.data());
  commands->CSGetUnorderedAccessViews(0, countOf(views_), views_.data());
}

SavedCompute::~SavedCompute() {
  constexpr std::array<ID3D11UnorderedAccessView*, VITRAIL_BINDINGS> kNone{};
  std::array<UINT, VITRAIL_BINDINGS> counters{};
  counters.fill(D3D11_KEEP_UNORDERED_ACCESS_VIEWS);
  commands_->CSSetUnorderedAccessViews(0, countOf(kNone), kNone.data(), counters.data());
  commands_->CSSetShader(shader_.shader.get(), shader_.instances.data(), shader_.count);
  commands_->CSSetConstantBuffers(0, countOf(constants_), constants_.data());
  commands_->CSSetShaderResources(0, countOf(resources_), resources_.data());
  commands_->CSSetUnorderedAccessViews(0, countOf(views_), views_.data(), counters.data());
  releaseInstances(shader_);
  releaseAll(constants_);
  releaseAll(resources_);
  releaseAll(views_);
}

// ---- Draws

void SavedDraw::saveShaders() {
  commands_->VSGetShader(vertex_.shader.out(), vertex_.instances.data(), &vertex_.count);
  commands_->HSGetShader(hull_.shader.out(), hull_.instances.data(), &hull_.count);
  commands_->DSGetShader(domain_.shader.out(), domain_.instances.data(), &domain_.count);
  commands_->GSGetShader(geometry_.shader.out(), geometry_.instances.data(), &geometry_.count);
  commands_->PSGetShader(pixel_.shader.out(), pixel_.instances.data(), &pixel_.count);
}

SavedDraw::SavedDraw(ID3D11DeviceContext* commands, UINT uavSlots) : commands_(commands) {
  saveShaders();
  commands->PSGetConstantBuffers(0, countOf(constants_), constants_.data());
  commands->PSGetShaderResources(0, countOf(resources_), resources_.data());
  commands->OMGetRenderTargetsAndUnorderedAccessViews(0, nullptr, nullptr, 0, uavSlots, views_.data());
  commands->IAGetInputLayout(inputLayout_.out());
  commands->IAGetPrimitiveTopology(&topology_);
  commands->RSGetState(rasterizing_.out());
  commands->RSGetViewports(&viewportCount_, viewports_.data());
  commands->RSGetScissorRects(&scissorCount_, scissors_.data());
  commands->OMGetBlendState(blending_.out(), blendFactor_.data(), &sampleMask_);
  commands->OMGetDepthStencilState(testing_.out(), &stencilReference_);
}

void SavedDraw::restoreShaders() {
  commands_->VSSetShader(vertex_.shader.get(), vertex_.instances.data(), vertex_.count);
  commands_->HSSetShader(hull_.shader.get(), hull_.instances.data(), hull_.count);
  commands_->DSSetShader(domain_.shader.get(), domain_.instances.data(), domain_.count);
  commands_->GSSetShader(geometry_.shader.get(), geometry_.instances.data(), geometry_.count);
  commands_->PSSetShader(pixel_.shader.get(), pixel_.instances.data(), pixel_.count);
  releaseInstances(vertex_);
  releaseInstances(hull_);
  releaseInstances(domain_);
  releaseInstances(geometry_);
  releaseInstances(pixel_);
}

SavedDraw::~SavedDraw() {
  restoreShaders();
  // From the first to the last: others are null then. (Wine takes no more than 8.)
  const auto isSet = [](const auto* view) { return view != nullptr; };
  const auto first = std::find_if(views_.begin(), views_.end(), isSet);
  const auto last = std::find_if(views_.rbegin(), views_.rend(), isSet).base();
  if (first != views_.end()) {
    setPixelViews(commands_, static_cast<UINT>(first - views_.begin()), static_cast<UINT>(last - first), &*first);
  } else {
    ID3D11UnorderedAccessView* const none = nullptr;
    setPixelViews(commands_, kPixelCounterSlot, 1, &none);
  }
  commands_->PSSetConstantBuffers(0, countOf(constants_), constants_.data());
  commands_->PSSetShaderResources(0, countOf(resources_), resources_.data());
  commands_->IASetInputLayout(inputLayout_.get());
  commands_->IASetPrimitiveTopology(topology_);
  commands_->RSSetState(rasterizing_.get());
  commands_->RSSetViewports(viewportCount_, viewports_.data());
  commands_->RSSetScissorRects(scissorCount_, scissors_.data());
  commands_->OMSetBlendState(blending_.get(), blendFactor_.data(), sampleMask_);
  commands_->OMSetDepthStencilState(testing_.get(), stencilReference_);
  releaseAll(constants_);
  releaseAll(resources_);
  releaseAll(views_);
}

} // namespace vitrail
