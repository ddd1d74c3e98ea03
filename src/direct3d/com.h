// A reference to an interface.
#pragma once

#include <cstdint>
#include <utility>

namespace vitrail {

// The length of an array as Direct3D takes it.
template <class Array>
constexpr std::uint32_t countOf(const Array& array) {
  return static_cast<std::uint32_t>(array.size());
}

template <class Interface>
class Com {
 public:
  Com() = default;
  explicit Com(Interface* owned) : interface_(owned) {}
  // Shares what somebody else has a reference to.
  static Com shared(Interface* other) {
    if (other != nullptr) other->AddRef();
    return Com(other);
  }
  Com(const Com& other) : interface_(other.interface_) {
    if (interface_ != nullptr) interface_->AddRef();
  }
  Com(Com&& other) noexcept : interface_(std::exchange(other.interface_, nullptr)) {}
  Com& operator=(Com other) noexcept {
    std::swap(interface_, other.interface_);
    return *this;
  }
  ~Com() {
    if (interface_ != nullptr) interface_->Release();
  }

  [[nodiscard]] Interface* get() const { return interface_; }
  Interface* operator->() const { return interface_; }
  explicit operator bool() const { return interface_ != nullptr; }
  // For calls that make one: it is empty then.
  Interface** out() {
    *this = Com();
    return &interface_;
  }

 private:
  Interface* interface_ = nullptr;
};

} // namespace vitrail
