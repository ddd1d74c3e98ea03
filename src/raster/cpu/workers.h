// The threads that work on a frame: the context's, or the host's.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "vitrail/cpu.h"

namespace vitrail::raster {

class Workers {
 public:
  // Throws std::bad_alloc or std::system_error.
  Workers(std::uint32_t threads, VitrailCpuParallel parallel, void* user);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  std::uint32_t count() const { return count_; }

  // Calls work(i) for each i below count(), on as many threads as there are; returns when all have returned. An
  // exception of one is thrown again once all are done.
  void run(const std::function<void(std::uint32_t worker)>& work);

 private:
  class Threads;
  std::uint32_t count_;
  VitrailCpuParallel parallel_;
  void* user_;
  std::unique_ptr<Threads> threads_;
};

// How many processors this process may run on.
std::uint32_t processorCount();

} // namespace vitrail::raster
