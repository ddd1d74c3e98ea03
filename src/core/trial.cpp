#include "trial.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace vitrail {

namespace {

constexpr std::array<char, 8> kTrialMagic = {'v', 'i', 't', 'r', 'a', 'i', 'l', '1'};

std::uint64_t checkOf(const TrialMemory& memory) {
  std::array<unsigned char, offsetof(TrialMemory, check)> bytes{};
  std::memcpy(bytes.data(), &memory, bytes.size());
  return hashOf(bytes);
}

} // namespace

std::uint64_t hashOf(std::span<const unsigned char> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3U;
  return hash;
}

Trial::Trial(std::uint32_t ways, std::uint32_t warmUps, std::uint32_t rounds)
    : ways_(ways), warmUps_(warmUps), rounds_(rounds) {
  for (std::uint32_t way = 0; way < ways; ++way) times_.at(way).reserve(rounds);
}

std::uint32_t Trial::next() const {
  if (isOver_) return fastest();
  const auto* const least = std::min_element(recorded_.begin(), recorded_.begin() + ways_);
  return static_cast<std::uint32_t>(least - recorded_.begin());
}

void Trial::take(std::uint32_t way, double milliseconds) {
  if (isOver_) return;
  if (warmed_.at(way) < warmUps_) {
    ++warmed_.at(way);
    return;
  }
  std::vector<double>& times = times_.at(way);
  if (times.size() == rounds_) return;
  times.insert(std::upper_bound(times.begin(), times.end(), milliseconds), milliseconds);
  const std::size_t middle = times.size() / 2;
  medians_.at(way) = times.size() % 2 != 0 ? times[middle] : 0.5 * (times[middle - 1] + times[middle]);
  isOver_ = std::all_of(times_.begin(), times_.begin() + ways_, [&](const auto& of) { return of.size() == rounds_; });
}

std::uint32_t Trial::fastest() const {
  std::uint32_t best = 0;
  for (std::uint32_t way = 1; way < ways_; ++way) {
    const bool isKnown = isRemembered_ || !times_.at(way).empty();
    const bool isBestKnown = isRemembered_ || !times_.at(best).empty();
    if (isKnown && (!isBestKnown || medians_.at(way) < medians_.at(best))) best = way;
  }
  return best;
}

std::uint32_t Trial::measured(std::uint32_t way) const { return static_cast<std::uint32_t>(times_.at(way).size()); }

TrialMemory Trial::memory(std::uint64_t device, std::uint64_t version) const {
  TrialMemory memory;
  memory.magic = kTrialMagic;
  memory.device = device;
  memory.version = version;
  memory.ways = ways_;
  memory.milliseconds = medians_;
  memory.check = checkOf(memory);
  return memory;
}

bool Trial::remember(std::span<const unsigned char> memory, std::uint64_t device, std::uint64_t version) {
  TrialMemory kept;
  if (memory.size() != sizeof(kept)) return false;
  std::memcpy(&kept, memory.data(), sizeof(kept));
  if (kept.magic != kTrialMagic || kept.device != device || kept.version != version || kept.ways != ways_) return false;
  if (kept.check != checkOf(kept)) return false;
  if (!std::ranges::all_of(kept.milliseconds, [](double ms) { return std::isfinite(ms) && ms >= 0.0; })) return false;
  medians_ = kept.milliseconds;
  isOver_ = isRemembered_ = true;
  return true;
}

} // namespace vitrail
