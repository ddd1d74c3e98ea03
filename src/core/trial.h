// Which of several ways is the fastest: what was measured of each, and what is remembered of it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vitrail {

constexpr std::uint32_t kMostWays = 8;

// What is kept from run to run, as it lies in the host's file.
struct TrialMemory {
  std::array<char, 8> magic{};
  std::uint64_t device = 0; // and its driver
  std::uint64_t version = 0;
  std::uint64_t ways = 0;
  std::array<double, kMostWays> milliseconds{};
  std::uint64_t check = 0; // of all bytes before it
};

// What tells devices and drivers apart, as one number: 64-bit FNV-1a.
std::uint64_t hashOf(std::span<const unsigned char> bytes);

class Trial {
 public:
  // Throws std::bad_alloc; nothing else does.
  Trial(std::uint32_t ways, std::uint32_t warmUps, std::uint32_t rounds);

  [[nodiscard]] std::uint32_t ways() const { return ways_; }
  // The way of the next frame: of which the fewest were recorded, and then the fastest.
  [[nodiscard]] std::uint32_t next() const;
  void record(std::uint32_t way) { ++recorded_.at(way); }
  // A frame has taken so long. Those that come when its way has enough do not count.
  void take(std::uint32_t way, double milliseconds);

  [[nodiscard]] bool isOver() const { return isOver_; }
  [[nodiscard]] bool isRemembered() const { return isRemembered_; }
  [[nodiscard]] std::uint32_t fastest() const;
  [[nodiscard]] std::uint32_t measured(std::uint32_t way) const;
  // The median of a way; 0: there is none yet.
  [[nodiscard]] double milliseconds(std::uint32_t way) const { return medians_.at(way); }

  // Only once it is over.
  [[nodiscard]] TrialMemory memory(std::uint64_t device, std::uint64_t version) const;
  // Takes what was kept of a trial like this one, which is over with that. False: it is of another one, or damaged.
  bool remember(std::span<const unsigned char> memory, std::uint64_t device, std::uint64_t version);

 private:
  std::uint32_t ways_;
  std::uint32_t warmUps_;
  std::uint32_t rounds_;
  bool isOver_ = false;
  bool isRemembered_ = false;
  std::array<std::uint64_t, kMostWays> recorded_{};
  std::array<std::uint32_t, kMostWays> warmed_{};    // frames that did not count
  std::array<std::vector<double>, kMostWays> times_; // in ascending order
  std::array<double, kMostWays> medians_{};
};

} // namespace vitrail
