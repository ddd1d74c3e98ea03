// The one Direct3D 11 device of a test program, and small helpers.
#pragma once

#include <d3d11_1.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "../host.h"

namespace vitrail::tests::d3d11 {

// An interface that is released with it.
template <typename Interface>
class Com {
 public:
  Com() = default;
  explicit Com(Interface* owned) : interface_(owned) {}
  Com(Com&& other) noexcept : interface_(std::exchange(other.interface_, nullptr)) {}
  Com& operator=(Com&& other) noexcept {
    std::swap(interface_, other.interface_);
    return *this;
  }
  Com(const Com&) = delete;
  Com& operator=(const Com&) = delete;
  ~Com() {
    if (interface_ != nullptr) interface_->Release();
  }

  [[nodiscard]] Interface* get() const { return interface_; }
  Interface* operator->() const { return interface_; }
  explicit operator bool() const { return interface_ != nullptr; }
  // For calls that make one.
  Interface** out() {
    if (interface_ != nullptr) std::exchange(interface_, nullptr)->Release();
    return &interface_;
  }

 private:
  Interface* interface_ = nullptr;
};

// Throws HostError where a call has failed.
void check(HRESULT result, const char* call);

class Device {
 public:
  Device();

  [[nodiscard]] ID3D11Device* get() const { return device_.get(); }
  [[nodiscard]] ID3D11DeviceContext* immediate() const { return context_.get(); }

  // A buffer of raw words; `data` null: anything.
  [[nodiscard]] Com<ID3D11Buffer> makeBuffer(std::size_t bytes, UINT bind, UINT misc, const void* data = nullptr) const;
  [[nodiscard]] Com<ID3D11UnorderedAccessView> makeRawView(ID3D11Buffer* buffer, std::size_t bytes) const;
  // What a buffer holds, once all before has run.
  [[nodiscard]] std::vector<std::byte> read(ID3D11Resource* buffer, std::size_t bytes) const;

 private:
  Com<ID3D11Device> device_;
  Com<ID3D11DeviceContext> context_;
};

Device& device();

} // namespace vitrail::tests::d3d11
