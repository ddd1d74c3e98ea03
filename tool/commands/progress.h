// Progress of long work on a terminal.
#pragma once

#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace vitrail::tool {

// One line on the terminal that is written over and over; nothing where nobody watches.
class Progress {
 public:
  explicit Progress(bool wanted) : shown_(wanted && ::isatty(STDERR_FILENO) != 0) {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { show(""); }

  void show(const std::string& text) const {
    if (shown_) fmt::print(stderr, "\r\x1b[K{:.100}", text);
  }

 private:
  bool shown_;
};

} // namespace vitrail::tool
