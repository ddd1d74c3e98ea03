// Memory for pictures that are written once. To touch fresh memory page by page takes longer than to draw into it, so
// large pages are asked for.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

#include <sys/mman.h>

namespace vitrail::tool {

class LargeArray {
 public:
  // Has at least so many floats, of no particular values; what was in it is gone. Throws std::bad_alloc.
  float* atLeast(std::size_t count) {
    if (count <= count_) return floats_.get();
    count_ = 0;
    floats_ = nullptr; // the old ones and the new ones need not fit together
    const std::size_t bytes = (count * sizeof(float) + kPage - 1) / kPage * kPage;
    floats_.reset(static_cast<float*>(std::aligned_alloc(kPage, bytes)));
    if (!floats_) throw std::bad_alloc();
    ::madvise(floats_.get(), bytes, MADV_HUGEPAGE); // a wish: what it cannot have is as it was
    count_ = count;
    return floats_.get();
  }

 private:
  static constexpr std::size_t kPage = std::size_t{1} << 21U;
  struct Free {
    void operator()(float* floats) const { std::free(floats); }
  };

  std::unique_ptr<float, Free> floats_;
  std::size_t count_ = 0;
};

} // namespace vitrail::tool
