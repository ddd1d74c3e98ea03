// How long the host works on something, for passes that are its own (Frame::addHostPass).
#pragma once

#include <chrono>

namespace vitrail::tool {

class HostClock {
 public:
  // Since the clock was made.
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace vitrail::tool
