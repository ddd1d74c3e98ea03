// The numbers of frames, and when memory that they use is free again.
#include <gtest/gtest.h>

#include <array>

#include "core/frame_numbers.h"

namespace vitrail::tests {
namespace {

constexpr std::uint32_t kInFlight = 2;

TEST(FrameNumbers, TheLibraryCountsFromNoughtWhereTheHostDoesNot) {
  FrameNumbers frames;
  for (const std::uint64_t number : {0U, 1U, 2U}) {
    EXPECT_FALSE(frames.begin(0, false));
    EXPECT_EQ(frames.newest(), number);
  }
  EXPECT_FALSE(frames.areGiven());
}

TEST(FrameNumbers, AHostThatCountsFromNoughtHasItsNumbers) {
  FrameNumbers frames;
  for (const std::uint64_t number : {0U, 1U, 2U}) {
    EXPECT_FALSE(frames.begin(number, false));
    EXPECT_EQ(frames.newest(), number);
  }
  EXPECT_TRUE(frames.areGiven());
  EXPECT_TRUE(frames.begin(2, false)) << "the first one was dropped";
}

TEST(FrameNumbers, AnOpenFrameGivesItsNumberToTheNext) {
  FrameNumbers frames;
  frames.begin(0, false);
  EXPECT_TRUE(frames.begin(0, true));
  EXPECT_EQ(frames.newest(), 0U);
  EXPECT_EQ(frames.begun(), 1U);
}

// Numbers are names: whatever they are, memory stays for as many frames as are in flight.
TEST(FrameNumbers, MemoryIsFreedByFramesAndNotByNumbers) {
  for (const std::array<std::uint64_t, 4> numbers :
       {std::array<std::uint64_t, 4>{7, 8, 9, 10}, {7, 1000, 1001, 1002}, {1000, 3, 4, 5}}) {
    FrameNumbers frames;
    FrameUse use;
    EXPECT_TRUE(use.isFree(frames.begun(), kInFlight)) << "never used";
    frames.begin(numbers[0], false);
    use.add(frames.begun());
    EXPECT_FALSE(use.isFree(frames.begun(), kInFlight));
    frames.begin(numbers[1], false);
    EXPECT_FALSE(use.isFree(frames.begun(), kInFlight));
    frames.begin(numbers[2], false);
    EXPECT_TRUE(use.isFree(frames.begun(), kInFlight)) << "the host has waited for the first frame";
  }
}

TEST(FrameNumbers, ADroppedFrameUsesNothing) {
  FrameNumbers frames;
  FrameUse use;
  frames.begin(5, false);
  use.add(frames.begun());
  ASSERT_TRUE(frames.begin(5, false));
  use.drop(frames.begun());
  EXPECT_TRUE(use.isFree(frames.begun(), kInFlight));
  frames.begin(6, false);
  use.add(frames.begun());
  use.add(frames.begun());
  frames.begin(7, false);
  EXPECT_FALSE(use.isFree(frames.begun(), kInFlight));
}

} // namespace
} // namespace vitrail::tests
