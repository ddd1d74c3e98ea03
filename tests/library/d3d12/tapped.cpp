#include "tapped.h"

#include <utility>

namespace vitrail::tests::d3d12 {

namespace {

bool holds(D3D12_RESOURCE_STATES present, D3D12_RESOURCE_STATES wanted) {
  return (static_cast<unsigned>(present) & static_cast<unsigned>(wanted)) == static_cast<unsigned>(wanted);
}

std::string print(D3D12_RESOURCE_STATES state) { return std::to_string(static_cast<unsigned>(state)); }

} // namespace

std::set<std::string> TappedList::takeChanges() { return std::exchange(changes_, {}); }
std::size_t TappedList::takeBarriers() { return std::exchange(barriers_, 0); }

D3D12_RESOURCE_STATES TappedList::stateOf(ID3D12Resource* resource) const {
  const auto found = known_.find(resource);
  return found != known_.end() ? found->second.state : D3D12_RESOURCE_STATE_COMMON;
}

std::vector<D3D12_RESOURCE_STATES> TappedList::bufferStates() const {
  std::vector<D3D12_RESOURCE_STATES> states;
  for (const auto& [resource, known] : known_) {
    if (known.bytes > 0) states.push_back(known.state);
  }
  return states;
}

void TappedList::ResourceBarrier(UINT count, const D3D12_RESOURCE_BARRIER* barriers) {
  for (UINT i = 0; i < count; ++i) {
    const D3D12_RESOURCE_BARRIER& barrier = barriers[i];
    const bool waits = barrier.Type == D3D12_RESOURCE_BARRIER_TYPE_UAV;
    if (waits ? dropsWaits : dropsTransitions) continue;
    ++barriers_;
    ID3D12Resource* resource = waits ? barrier.UAV.pResource : barrier.Transition.pResource;
    const auto [place, isNew] = known_.try_emplace(resource);
    Known& known = place->second;
    if (isNew) {
      known.state = waits ? D3D12_RESOURCE_STATE_UNORDERED_ACCESS : barrier.Transition.StateBefore;
      const D3D12_RESOURCE_DESC desc = resource->GetDesc();
      if (desc.Dimension == D3D12_RESOURCE_DIMENSION_BUFFER) {
        known.first = resource->GetGPUVirtualAddress();
        known.bytes = desc.Width;
      }
    }
    known.written = false;
    if (waits) {
      expectState(resource, D3D12_RESOURCE_STATE_UNORDERED_ACCESS, "a barrier of unordered access");
    } else {
      if (known.state != barrier.Transition.StateBefore) {
        error("a transition from state " + print(barrier.Transition.StateBefore) + " of a resource in state " +
              print(known.state));
      }
      known.state = barrier.Transition.StateAfter;
    }
    list_->ResourceBarrier(1, &barrier);
  }
}

void TappedList::expectState(ID3D12Resource* resource, D3D12_RESOURCE_STATES state, const std::string& what) {
  const auto found = known_.find(resource);
  if (found == known_.end() || holds(found->second.state, state)) return; // what no barrier names never changes
  error(what + ": state " + print(state) + " is needed, the resource is in state " + print(found->second.state));
}

TappedList::Known* TappedList::bufferAt(D3D12_GPU_VIRTUAL_ADDRESS address) {
  for (auto& [resource, known] : known_) {
    if (address >= known.first && address < known.first + known.bytes) return &known;
  }
  return nullptr;
}

void TappedList::checkRoots(const std::map<UINT, Root>& roots, const std::string& what) {
  for (const auto& [number, root] : roots) {
    const Known* known = bufferAt(root.address);
    if (known == nullptr || holds(known->state, root.state)) continue;
    error(what + ", root parameter " + std::to_string(number) + ": state " + print(root.state) +
          " is needed, the buffer is in state " + print(known->state));
  }
}

void TappedList::CopyBufferRegion(ID3D12Resource* to, UINT64 toOffset, ID3D12Resource* from, UINT64 fromOffset,
                                  UINT64 bytes) {
  expectState(to, D3D12_RESOURCE_STATE_COPY_DEST, "CopyBufferRegion's destination");
  expectState(from, D3D12_RESOURCE_STATE_COPY_SOURCE, "CopyBufferRegion's source");
  list_->CopyBufferRegion(to, toOffset, from, fromOffset, bytes);
}

void TappedList::CopyTextureRegion(const D3D12_TEXTURE_COPY_LOCATION* to, UINT x, UINT y, UINT z,
                                   const D3D12_TEXTURE_COPY_LOCATION* from, const D3D12_BOX* box) {
  expectState(to->pResource, D3D12_RESOURCE_STATE_COPY_DEST, "CopyTextureRegion's destination");
  expectState(from->pResource, D3D12_RESOURCE_STATE_COPY_SOURCE, "CopyTextureRegion's source");
  list_->CopyTextureRegion(to, x, y, z, from, box);
}

// A kernel reaches all of a target's buffers that it may write by tables, which cannot be looked into; what writes
// words has one root descriptor, and writes other places than the dispatches beside it.
void TappedList::dispatched(const std::string& what) {
  checkRoots(rootsCompute_, what);
  std::set<const Known*> constant;
  for (const auto& [number, root] : rootsCompute_) {
    Known* known = bufferAt(root.address);
    if (known == nullptr) continue;
    if (root.state == D3D12_RESOURCE_STATE_UNORDERED_ACCESS && !tables_) known->written = true;
    constant.insert(known);
  }
  if (!tables_) return;
  for (auto& [resource, known] : known_) {
    if (known.bytes == 0 || constant.contains(&known)) continue;
    if (!holds(known.state, D3D12_RESOURCE_STATE_UNORDERED_ACCESS)) {
      error(what + ": a kernel's buffer is in state " + print(known.state));
    }
    if (known.written) error(what + ": a kernel's buffer was written, and no barrier waits for it");
    known.written = true;
  }
}

void TappedList::Dispatch(UINT x, UINT y, UINT z) {
  dispatched("Dispatch");
  list_->Dispatch(x, y, z);
}

void TappedList::DrawInstanced(UINT vertices, UINT instances, UINT first, UINT firstInstance) {
  checkRoots(rootsGraphics_, "DrawInstanced");
  for (const auto& [number, root] : rootsGraphics_) {
    Known* known = bufferAt(root.address);
    if (known != nullptr && root.state == D3D12_RESOURCE_STATE_UNORDERED_ACCESS) known->written = true;
  }
  list_->DrawInstanced(vertices, instances, first, firstInstance);
}

void TappedList::ExecuteIndirect(ID3D12CommandSignature* signature, UINT most, ID3D12Resource* arguments, UINT64 offset,
                                 ID3D12Resource* count, UINT64 countOffset) {
  expectState(arguments, D3D12_RESOURCE_STATE_INDIRECT_ARGUMENT, "ExecuteIndirect's arguments");
  if (tables_) {
    dispatched("ExecuteIndirect");
  } else {
    checkRoots(rootsGraphics_, "ExecuteIndirect");
  }
  list_->ExecuteIndirect(signature, most, arguments, offset, count, countOffset);
}

void TappedList::SetComputeRootSignature(ID3D12RootSignature* root) {
  changes_.insert("SetComputeRootSignature");
  rootsCompute_.clear();
  rootsGraphics_.clear(); // what was drawn with them was looked at
  tables_ = false;
  list_->SetComputeRootSignature(root);
}

void TappedList::SetGraphicsRootSignature(ID3D12RootSignature* root) {
  changes_.insert("SetGraphicsRootSignature");
  rootsGraphics_.clear();
  rootsCompute_.clear();
  tables_ = false;
  list_->SetGraphicsRootSignature(root);
}

} // namespace vitrail::tests::d3d12
