#include "progress.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace vitrail::tool {

namespace {

constexpr std::chrono::milliseconds kStep(200);
constexpr std::size_t kBarWidth = 24;

std::string barOf(std::uint64_t done, std::uint64_t all) {
  const auto filled = static_cast<std::size_t>(kBarWidth * done / all);
  return fmt::format(" [{}{}]", std::string(filled, '#'), std::string(kBarWidth - filled, '.'));
}

} // namespace

Progress::Progress(bool wanted, Shown shown) : isWatched_(wanted && ::isatty(STDERR_FILENO) != 0), shown_(shown) {}

Progress::~Progress() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Progress::show(const std::string& text, std::uint64_t done, std::uint64_t all) const {
  if (!isWatched_) return;
  const std::lock_guard lock(mutex_);
  text_ = text;
  done_ = done;
  all_ = all;
  if (!thread_.joinable()) thread_ = std::thread([this] { keepShowing(); });
  write();
}

// Lets the seconds go on while the work says nothing.
void Progress::keepShowing() const {
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, kStep, [this] { return ends_; })) write();
  text_.clear();
  write();
}

// With the mutex held.
void Progress::write() const {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - start_).count();
  const bool isDue = !text_.empty() && (shown_ == Shown::AtOnce || seconds >= 1);
  if (!isDue && !isWritten_) return;
  if (isDue) {
    const std::string bar = all_ > 0 ? barOf(done_, all_) : "";
    fmt::print(stderr, "\r\x1b[K{:.80}{}{}", text_, bar, seconds >= 1 ? fmt::format("  {} s", seconds) : "");
  } else {
    fmt::print(stderr, "\r\x1b[K");
  }
  std::fflush(stderr);
  isWritten_ = isDue;
}

} // namespace vitrail::tool
