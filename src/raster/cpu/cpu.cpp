// The calls of vitrail/cpu.h.
#include "vitrail/cpu.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>

#include "core/log.h"
#include "raster/cpu/frame.h"
#include "raster/cpu/frame_rules.h"
#include "raster/cpu/workers.h"

using vitrail::Log;
namespace raster = vitrail::raster;

struct VitrailCpuContext_T {
  Log log;
  const raster::Stages* stages = nullptr;
  std::unique_ptr<raster::Workers> workers;
  // Memory that is kept from frame to frame.
  raster::Frame frame;
  std::vector<std::unique_ptr<raster::TileWorkspace>> workspaces; // one a thread
  std::uint64_t fragmentBytes = 0;                                // of the last one
};

namespace {

constexpr std::uint32_t kMaxThreads = 1024;

const raster::Stages* stagesOf(VitrailCpuInstructions instructions) {
  for (const raster::Stages* stages : raster::stagesHere()) {
    if (instructions == VITRAIL_CPU_BEST || stages->instructions == instructions) return stages;
  }
  return nullptr;
}

// Calls the function and turns exceptions into results. `advice`: where there is no memory.
template <class Function>
VitrailResult guarded(const Log& log, const char* doing, const char* advice, Function function) {
  try {
    return function();
  } catch (const std::bad_alloc&) {
    return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "no memory is left for %s%s", doing, advice);
  } catch (const std::length_error&) {
    return log.fail(VITRAIL_ERROR_OUT_OF_MEMORY, "no memory is left for %s%s", doing, advice);
  } catch (const std::system_error& error) {
    return log.fail(VITRAIL_ERROR_UNSUPPORTED, "a thread could not be started: %s: use fewer threads", error.what());
  } catch (const std::exception& error) {
    return log.fail(VITRAIL_ERROR_UNSUPPORTED, "%s failed: %s", doing, error.what());
  } catch (...) { // of the host's: a shade function, or what it runs threads with
    return log.fail(VITRAIL_ERROR_UNSUPPORTED, "%s failed: one of the host's functions threw an exception", doing);
  }
}

// Tells the host how far the frame is, one thread at a time. Whether it wants to give up.
class Progress {
 public:
  explicit Progress(const VitrailCpuFrame& info, std::uint32_t tiles) : info_(info), tiles_(tiles) {}

  bool isGivenUp() const { return isGivenUp_.load(std::memory_order_relaxed); }
  void tileDone() {
    if (info_.progress == nullptr) return;
    const std::lock_guard lock(mutex_);
    if (!isGivenUp() && info_.progress(info_.progressUser, ++done_, tiles_) != 0) isGivenUp_ = true;
  }

 private:
  const VitrailCpuFrame& info_;
  std::uint32_t tiles_;
  std::uint32_t done_ = 0;
  std::mutex mutex_;
  std::atomic<bool> isGivenUp_ = false;
};

// Hands out numbers below `count` in ascending order, until someone fails.
class Queue {
 public:
  explicit Queue(std::uint64_t count) : count_(count) {}
  bool take(std::uint64_t& i) {
    i = next_.fetch_add(1, std::memory_order_relaxed);
    return i < count_;
  }
  void stop() { next_ = count_; }

 private:
  std::uint64_t count_;
  std::atomic<std::uint64_t> next_ = 0;
};

// On at most so many of the workers.
template <class Work>
void forAll(raster::Workers& workers, std::uint32_t most, std::uint64_t count, Work work) {
  if (count == 0) return;
  Queue queue(count);
  workers.run([&](std::uint32_t worker) {
    if (worker >= most) return;
    try {
      for (std::uint64_t i = 0; queue.take(i);) work(worker, i);
    } catch (...) {
      queue.stop();
      throw;
    }
  });
}

void setStats(const raster::Frame& frame, const raster::TileCounts& counts, VitrailStats& stats) {
  void* const next = stats.next;
  stats = {};
  stats.next = next;
  stats.complete = 1;
  // Half a step of rounding, what is behind too little light, and the rounding of so many sums and products. Where
  // surfaces hide what they add light to, roundings go either way. Where they need not, equal ones add up: at most
  // 2^-25 each, where the curve rises by 0.66.
  const float leftOut = frame.leastTransmittance > raster::kNoTransmittance ? raster::kLeftOut : 0.0F;
  const auto layers = static_cast<float>(counts.layersMax);
  stats.errorBound = 0.51F + leftOut + (frame.addsUp ? 5e-6F * layers : 2e-5F * std::sqrt(layers));
  stats.exact = stats.errorBound <= 1.0F ? 1 : 0;
  stats.fragmentsRequested = counts.fragments;
  stats.fragmentsStored = counts.fragments;
  stats.layersMax = counts.layersMax;
  stats.coveredPixels = static_cast<std::uint32_t>(counts.pixels);
}

VitrailResult drawFrame(VitrailCpuContext_T& context, VitrailStats* stats) {
  raster::Frame& frame = context.frame;
  raster::Workers& workers = *context.workers;
  const raster::Stages& stages = *context.stages;
  frame.bins.resize(workers.count());
  for (raster::ThreadBins& bins : frame.bins) {
    bins.opaque.reset(frame.tiles());
    bins.transparent.reset(frame.tiles());
  }
  forAll(workers, workers.count(), frame.vertexChunks.size(),
         [&](std::uint32_t /*worker*/, std::uint64_t i) { stages.placeVertices(frame, frame.vertexChunks[i]); });
  forAll(workers, workers.count(), frame.jobs.size(), [&](std::uint32_t worker, std::uint64_t i) {
    stages.binJob(frame, static_cast<std::uint32_t>(i), frame.bins[worker]);
  });

  Progress progress(frame.info, frame.tiles());
  // Those of the frame before, where they fit; where this one fails, none are kept.
  std::vector<std::unique_ptr<raster::TileWorkspace>> workspaces = std::move(context.workspaces);
  context.workspaces.clear();
  workspaces.resize(workers.count());
  for (std::unique_ptr<raster::TileWorkspace>& each : workspaces) {
    if (each != nullptr && !each->begin(frame)) each.reset();
  }
  std::vector<raster::TileCounts> counts(workers.count());
  forAll(workers, frame.tileThreads, frame.tiles(), [&](std::uint32_t worker, std::uint64_t i) {
    if (progress.isGivenUp()) return;
    if (workspaces[worker] == nullptr) workspaces[worker] = stages.makeWorkspace(frame);
    raster::TileCounts tile; // not in `counts`, whose entries lie side by side: threads would wait for each other
    stages.drawTile(frame, static_cast<std::uint32_t>(i), *workspaces[worker], tile);
    counts[worker].add(tile);
    progress.tileDone();
  });
  context.fragmentBytes = 0;
  for (const auto& workspace : workspaces) context.fragmentBytes += workspace ? workspace->fragmentBytes() : 0;
  context.workspaces = std::move(workspaces);
  if (progress.isGivenUp()) return VITRAIL_INCOMPLETE;
  raster::TileCounts all;
  for (const raster::TileCounts& each : counts) all.add(each);
  if (stats != nullptr) setStats(frame, all, *stats);
  return VITRAIL_SUCCESS;
}

VitrailResult checkContext(const Log& log, const VitrailCpuContextDesc& desc) {
  if (desc.next != nullptr) return log.fail(VITRAIL_ERROR_INVALID, "the context's next is not null");
  if (desc.threads > kMaxThreads) {
    return log.fail(VITRAIL_ERROR_INVALID, "threads is %u: at most %u work on a frame", desc.threads, kMaxThreads);
  }
  if (desc.parallel != nullptr && desc.threads == 0) {
    return log.fail(VITRAIL_ERROR_INVALID, "parallel without threads: say how many the host has");
  }
  if (desc.instructions < VITRAIL_CPU_BEST || desc.instructions > VITRAIL_CPU_BASELINE) {
    return log.fail(VITRAIL_ERROR_INVALID, "instructions is none of VitrailCpuInstructions");
  }
  if (stagesOf(desc.instructions) != nullptr) return VITRAIL_SUCCESS;
  if (desc.instructions == VITRAIL_CPU_BEST) {
    return log.fail(VITRAIL_ERROR_UNSUPPORTED,
                    "this processor lacks what the library needs: on x86 SSE4.2, AES and PCLMULQDQ (since 2010)");
  }
  return log.fail(VITRAIL_ERROR_UNSUPPORTED,
                  "this processor, or this build, does not have the %s instructions: use VITRAIL_CPU_BEST",
                  vitrailCpuInstructionsName(desc.instructions));
}

} // namespace

VitrailResult vitrailCpuCreateContext(const VitrailCpuContextDesc* desc, VitrailCpuContext* context) {
  const VitrailCpuContextDesc given = desc == nullptr ? VitrailCpuContextDesc{} : *desc;
  const Log log{given.log, given.logUser};
  if (context == nullptr) return log.fail(VITRAIL_ERROR_INVALID, "context is null");
  *context = nullptr;
  if (const VitrailResult result = checkContext(log, given); result != VITRAIL_SUCCESS) return result;
  return guarded(log, "a context", "", [&] {
    auto made = std::make_unique<VitrailCpuContext_T>();
    made->log = log;
    made->stages = stagesOf(given.instructions);
    const std::uint32_t threads = given.threads == 0 ? raster::processorCount() : given.threads;
    made->workers = std::make_unique<raster::Workers>(threads, given.parallel, given.parallelUser);
    *context = made.release();
    return VITRAIL_SUCCESS;
  });
}

void vitrailCpuDestroyContext(VitrailCpuContext context) { delete context; }

VitrailCpuInstructions vitrailCpuContextInstructions(VitrailCpuContext context) {
  return context == nullptr ? VITRAIL_CPU_BEST : context->stages->instructions;
}

uint32_t vitrailCpuContextThreads(VitrailCpuContext context) {
  return context == nullptr ? 0 : context->workers->count();
}

const char* vitrailCpuInstructionsName(VitrailCpuInstructions instructions) {
  switch (instructions) {
    case VITRAIL_CPU_BEST:
      return "best";
    case VITRAIL_CPU_SSE4:
      return "SSE4";
    case VITRAIL_CPU_AVX2:
      return "AVX2";
    case VITRAIL_CPU_AVX512:
      return "AVX-512";
    case VITRAIL_CPU_NEON:
      return "NEON";
    case VITRAIL_CPU_BASELINE:
      return "baseline";
    default:
      return "unknown";
  }
}

VitrailResult vitrailCpuRender(VitrailCpuContext context, const VitrailCpuFrame* frame, const VitrailCpuDraw* draws,
                               uint32_t drawCount, VitrailStats* stats) {
  if (stats != nullptr) {
    void* const next = stats->next;
    *stats = {};
    stats->next = next;
  }
  if (context == nullptr) return VITRAIL_ERROR_INVALID;
  if (const VitrailResult result = raster::checkFrame(context->log, frame, draws, drawCount);
      result != VITRAIL_SUCCESS) {
    return result;
  }
  return guarded(context->log, "the frame", ": a smaller memory budget takes less", [&] {
    raster::prepareFrame(context->frame, *frame, {draws, drawCount}, context->workers->count(), stats != nullptr);
    return drawFrame(*context, stats);
  });
}

uint64_t vitrailCpuFragmentBytes(VitrailCpuContext context) { return context == nullptr ? 0 : context->fragmentBytes; }
