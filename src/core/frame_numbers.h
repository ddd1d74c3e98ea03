// The numbers of a target's frames, and when memory that they use is free again. The host says by beginning frame n
// that frame n - framesInFlight has finished; the library waits for nothing.
#pragma once

#include <cstdint>

namespace vitrail {

class FrameNumbers {
 public:
  // The number that a frame has for which the host says `given`: 0 is the one after the last, and first 0.
  [[nodiscard]] std::uint64_t numberOf(std::uint64_t given) const {
    return given != 0 ? given : any_ ? newest_ + 1 : 0;
  }

  // Begins a frame. `open`: the last one was not ended. True: this one has the number of the last one, which was
  // dropped: the host says so by giving its own number a second time, or leaves the number of an open frame to the
  // library.
  bool begin(std::uint64_t given, bool open) {
    const bool reused = any_ && given == 0 && open;
    const std::uint64_t number = reused ? newest_ : numberOf(given);
    const bool again = reused || (any_ && given != 0 && newestWasGiven_ && number == newest_);
    any_ = true;
    if (!again) ++begun_;
    newestWasGiven_ = given != 0;
    given_ = given_ || given != 0;
    newest_ = number;
    return again;
  }

  [[nodiscard]] bool any() const { return any_; }
  // Frames that were begun, without those that were dropped and begun again: the last one has this place among them.
  [[nodiscard]] std::uint64_t begun() const { return begun_; }
  [[nodiscard]] std::uint64_t newest() const { return newest_; }
  // Whether the host numbers frames itself: where it does not, 0 names none of them.
  [[nodiscard]] bool areGiven() const { return given_; }

 private:
  std::uint64_t newest_ = 0;
  std::uint64_t begun_ = 0;
  bool any_ = false;
  bool given_ = false;
  bool newestWasGiven_ = false; // by the host: numbers of the library's own are never dropped and given again
};

// Which frames some memory was used by, by their places among those that were begun.
class FrameUse {
 public:
  void add(std::uint64_t place) {
    if (used_ && place == last_) return;
    before_ = last_;
    usedBefore_ = used_;
    last_ = place;
    used_ = true;
  }

  // That frame was recorded and never submitted.
  void drop(std::uint64_t place) {
    if (!used_ || place != last_) return;
    last_ = before_;
    used_ = usedBefore_;
    usedBefore_ = false;
  }

  // Whether no frame uses it any more, when the host records the frame at place `now`.
  [[nodiscard]] bool isFree(std::uint64_t now, std::uint32_t framesInFlight) const {
    return !used_ || (now >= framesInFlight && last_ <= now - framesInFlight);
  }

 private:
  std::uint64_t last_ = 0;
  std::uint64_t before_ = 0; // the one before the last
  bool used_ = false;
  bool usedBefore_ = false;
};

} // namespace vitrail
