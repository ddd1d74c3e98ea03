// Divides work among threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace vitrail::tool {

// How many parts `items` things are worth dividing into: one where there are fewer than `least` for each thread.
inline std::size_t partsFor(std::size_t items, std::size_t least) {
  const std::size_t threads = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, 8);
  return std::clamp<std::size_t>(items / std::max<std::size_t>(least, 1), 1, threads);
}

// Calls `work(part)` for each part, on a thread each, and returns when all have ended. The first part's exception is
// thrown again.
template <typename Work>
void inParts(std::size_t parts, Work work) {
  std::vector<std::exception_ptr> errors(parts);
  const auto guarded = [&](std::size_t part) {
    try {
      work(part);
    } catch (...) {
      errors[part] = std::current_exception();
    }
  };
  std::vector<std::jthread> threads;
  for (std::size_t part = 1; part < parts; ++part) threads.emplace_back(guarded, part);
  guarded(0);
  threads.clear();
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

} // namespace vitrail::tool
