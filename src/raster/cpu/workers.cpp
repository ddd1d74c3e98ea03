#include "raster/cpu/workers.h"

#ifdef __linux__
#include <sched.h>
#endif

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace vitrail::raster {

namespace {

// One call of run(), as threads see it.
struct Run {
  const std::function<void(std::uint32_t)>& work;
  std::mutex mutex;
  std::exception_ptr failure;

  void call(std::uint32_t i) {
    try {
      work(i);
    } catch (...) { // no exception may pass through the host's code, or end a thread
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  }
};

} // namespace

// Threads that wait from run to run. Those of oneTBB would do, but where the system refuses it a thread or memory, it
// ends the process or waits for ever.
class Workers::Threads {
 public:
  explicit Threads(std::uint32_t count) {
    threads_.reserve(count);
    try {
      for (std::uint32_t i = 0; i < count; ++i) threads_.emplace_back([this, i] { serve(i + 1); });
    } catch (...) {
      stop();
      throw;
    }
  }
  ~Threads() { stop(); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  void run(Run& run) {
    run_ = &run;
    busy_ = static_cast<std::uint32_t>(threads_.size());
    round_.fetch_add(1);
    round_.notify_all();
    run.call(0);
    for (std::uint32_t busy = busy_; busy != 0; busy = busy_) busy_.wait(busy);
  }

 private:
  void serve(std::uint32_t number) {
    for (std::uint32_t round = 0;;) {
      round_.wait(round);
      ++round;
      if (run_ == nullptr) return;
      run_->call(number);
      if (busy_.fetch_sub(1) == 1) busy_.notify_one();
    }
  }

  void stop() {
    run_ = nullptr;
    round_.fetch_add(1);
    round_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  Run* run_ = nullptr;                   // null: the threads end
  std::atomic<std::uint32_t> round_ = 0; // counts runs
  std::atomic<std::uint32_t> busy_ = 0;  // threads that are not done with this one
  std::vector<std::thread> threads_;
};

Workers::Workers(std::uint32_t threads, VitrailCpuParallel parallel, void* user)
    : count_(threads), parallel_(parallel), user_(user) {
  if (parallel == nullptr && threads > 1) threads_ = std::make_unique<Threads>(threads - 1);
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
    threads_->run(run);
  }
  if (run.failure) std::rethrow_exception(run.failure);
}

std::uint32_t processorCount() {
#ifdef __linux__
  // Of those that there are, this process may be kept to some.
  cpu_set_t allowed;
  if (::sched_getaffinity(0, sizeof(allowed), &allowed) == 0) return static_cast<std::uint32_t>(CPU_COUNT(&allowed));
#endif
  return std::max(std::thread::hardware_concurrency(), 1U);
}

} // namespace vitrail::raster
