// Which of several ways is the fastest, by times that are given.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/trial.h"

namespace vitrail::tests {
namespace {

std::vector<unsigned char> bytesOf(const TrialMemory& memory) {
  std::vector<unsigned char> bytes(sizeof(memory));
  std::memcpy(bytes.data(), &memory, bytes.size());
  return bytes;
}

// Of two ways, 3 and 2 ms.
Trial measured() {
  Trial trial(2, 0, 1);
  trial.take(0, 3.0);
  trial.take(1, 2.0);
  return trial;
}

TEST(TrialTest, TheMedianCounts) {
  Trial trial(2, 0, 4);
  for (const double ms : {9.0, 1.0, 2.0, 3.0}) trial.take(0, ms);
  EXPECT_EQ(trial.milliseconds(0), 2.5);
  EXPECT_FALSE(trial.isOver());
  for (const double ms : {2.0, 2.6, 2.6}) trial.take(1, ms);
  EXPECT_EQ(trial.milliseconds(1), 2.6);
  EXPECT_EQ(trial.fastest(), 0U);
  trial.take(1, 0.5); // the last one: 2.3 in the middle
  EXPECT_TRUE(trial.isOver());
  EXPECT_EQ(trial.fastest(), 1U);
  EXPECT_EQ(trial.next(), 1U);
}

TEST(TrialTest, FirstFramesAndThoseTooManyDoNotCount) {
  Trial trial(2, 2, 1);
  for (const double ms : {100.0, 100.0, 4.0, 0.1}) trial.take(0, ms);
  EXPECT_EQ(trial.measured(0), 1U);
  EXPECT_EQ(trial.milliseconds(0), 4.0);
  EXPECT_EQ(trial.milliseconds(1), 0.0);
  EXPECT_EQ(trial.fastest(), 0U) << "nothing is known of the other";
}

TEST(TrialTest, OfEquallyFastOnesTheFirst) {
  Trial trial(3, 0, 1);
  trial.take(0, 2.0);
  trial.take(2, 1.0);
  trial.take(1, 1.0);
  EXPECT_EQ(trial.fastest(), 1U);
}

TEST(TrialTest, WaysTakeTurns) {
  Trial trial(3, 1, 1);
  std::vector<std::uint32_t> ways;
  for (int i = 0; i < 6; ++i) {
    ways.push_back(trial.next());
    trial.record(ways.back());
  }
  EXPECT_EQ(ways, (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2}));
  trial.record(0); // one that nobody asked for
  EXPECT_EQ(trial.next(), 1U);
}

TEST(TrialTest, WhatWasMeasuredIsKept) {
  Trial trial(2, 4, 9);
  ASSERT_TRUE(trial.remember(bytesOf(measured().memory(5, 7)), 5, 7));
  EXPECT_TRUE(trial.isOver());
  EXPECT_TRUE(trial.isRemembered());
  EXPECT_EQ(trial.next(), 1U);
  EXPECT_EQ(trial.milliseconds(0), 3.0);
}

TEST(TrialTest, OfSomethingElseItIsNot) {
  const std::vector<unsigned char> kept = bytesOf(measured().memory(5, 7));
  const auto isTaken = [](const std::vector<unsigned char>& memory, std::uint32_t ways, std::uint64_t device,
                          std::uint64_t version) { return Trial(ways, 4, 9).remember(memory, device, version); };
  EXPECT_TRUE(isTaken(kept, 2, 5, 7));
  EXPECT_FALSE(isTaken(kept, 3, 5, 7));
  EXPECT_FALSE(isTaken(kept, 2, 6, 7));
  EXPECT_FALSE(isTaken(kept, 2, 5, 8));
  for (std::size_t i = 0; i < kept.size(); ++i) { // damaged anywhere
    std::vector<unsigned char> other = kept;
    other[i] ^= 1U;
    EXPECT_FALSE(isTaken(other, 2, 5, 7)) << i;
  }
  EXPECT_FALSE(isTaken({kept.begin(), kept.end() - 1}, 2, 5, 7));
  EXPECT_FALSE(isTaken({}, 2, 5, 7));
  Trial trial(2, 4, 9);
  EXPECT_FALSE(trial.remember(kept, 5, 8));
  EXPECT_FALSE(trial.isOver());
  EXPECT_EQ(trial.milliseconds(0), 0.0);
}

} // namespace
} // namespace vitrail::tests
