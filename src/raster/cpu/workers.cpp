#include "raster/cpu/workers.h"

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <exception>
#include <mutex>

namespace vitrail::raster {

struct Workers::Arena {
  tbb::task_arena arena;
};

namespace {

// One call of run(), as the host's threads see it.
struct Run {
  const std::function<void(std::uint32_t)>& work;
  std::mutex mutex;
  std::exception_ptr failure;

  void call(std::uint32_t i) {
    try {
      work(i);
    } catch (...) { // no exception may pass through the host's code
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  }
};

} // namespace

Workers::Workers(std::uint32_t threads, VitrailCpuParallel parallel, void* user)
    : count_(threads), parallel_(parallel), user_(user) {
  if (parallel != nullptr || threads == 1) return;
  arena_ = std::make_unique<Arena>();
  arena_->arena.initialize(static_cast<int>(threads));
}

Workers::~Workers() = default;

void Workers::run(const std::function<void(std::uint32_t)>& work) {
  Run run{work, {}, {}};
  if (count_ == 1) {
    run.call(0);
  } else if (parallel_ != nullptr) {
    parallel_(
        user_, count_, [](void* data, std::uint32_t i) { static_cast<Run*>(data)->call(i); }, &run);
  } else {
    arena_->arena.execute([&] {
      tbb::parallel_for(
          0U, count_, [&run](std::uint32_t i) { run.call(i); }, tbb::simple_partitioner());
    });
  }
  if (run.failure) std::rethrow_exception(run.failure);
}

std::uint32_t processorCount() {
  const int count = tbb::info::default_concurrency();
  return count > 0 ? static_cast<std::uint32_t>(count) : 1;
}

} // namespace vitrail::raster
