#include "failing.h"

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace vitrail::tests::raster {
namespace {

constexpr std::uint64_t kNever = ~std::uint64_t{0};
std::atomic<std::uint64_t> allocationsLeft{kNever};
std::atomic<bool> failsAllAfter{false};
std::atomic<bool> hasFailed{false};
std::atomic<std::uint32_t> threadsLeft{~0U};

bool isRefused() {
  std::uint64_t left = allocationsLeft.load(std::memory_order_relaxed);
  if (left == kNever) return false;
  while (left != 0 && left != kNever) {
    if (allocationsLeft.compare_exchange_weak(left, left - 1)) return false;
  }
  if (left == kNever) return false;
  if (!failsAllAfter && hasFailed.exchange(true)) return false;
  hasFailed = true;
  return true;
}

void* allocate(std::size_t size, std::size_t alignment) {
  void* const memory = isRefused() ? nullptr
                       : alignment <= alignof(std::max_align_t)
                           ? std::malloc(size == 0 ? 1 : size)
                           : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

} // namespace

void failAllocation(std::uint64_t n, bool allAfter) {
  failsAllAfter = allAfter;
  hasFailed = false;
  allocationsLeft = n;
}

bool stopFailingAllocations() {
  allocationsLeft = kNever;
  return hasFailed;
}

void failThreads(std::uint32_t n) { threadsLeft = n; }

bool isThreadRefused() {
  std::uint32_t left = threadsLeft;
  while (left != 0 && left != ~0U) {
    if (threadsLeft.compare_exchange_weak(left, left - 1)) return false;
  }
  return left == 0;
}

} // namespace vitrail::tests::raster

using vitrail::tests::raster::allocate;

void* operator new(std::size_t size) { return allocate(size, 0); }
void* operator new[](std::size_t size) { return allocate(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t /*size*/) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t /*alignment*/) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}

// Sanitizers have a pthread_create of their own, which must be called.
#if !defined(VITRAIL_TEST_SANITIZED)
extern "C" [[gnu::visibility("default")]] int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                                                             void* (*start)(void*), void* data) {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  if (vitrail::tests::raster::isThreadRefused()) return EAGAIN;
  return create(thread, attributes, start, data);
}
#endif
