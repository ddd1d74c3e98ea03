// Progress of long work on a terminal.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

namespace vitrail::tool {

// One line on the terminal that is written over and over, and wiped away at the end; nothing where nobody watches.
class Progress {
 public:
  enum class Shown { AtOnce, AfterASecond };

  explicit Progress(bool wanted, Shown shown = Shown::AtOnce);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // What is done now. Empty: nothing is shown until the next call.
  void show(const std::string& text) const { show(text, 0, 0); }
  // The same with a bar: `done` parts of `all`.
  void show(const std::string& text, std::uint64_t done, std::uint64_t all) const;

 private:
  using Clock = std::chrono::steady_clock;

  void keepShowing() const;
  void write() const;

  bool isWatched_;
  Shown shown_;
  Clock::time_point start_ = Clock::now();
  // What the thread that keeps the line moving shares with the others.
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  mutable std::string text_;
  mutable std::uint64_t done_ = 0;
  mutable std::uint64_t all_ = 0;
  mutable bool ends_ = false;
  mutable bool isWritten_ = false; // there is something to wipe away
  mutable std::thread thread_;
};

} // namespace vitrail::tool
