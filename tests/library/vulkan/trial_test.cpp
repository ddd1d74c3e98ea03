// Which way to draw is the fastest, by time stamps around frames of known cost: buffers that are filled so many times.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <vitrail/vitrail.hpp>

#include "backend.h"
#include "objects.h"

namespace vitrail::tests::vulkan {
namespace {

using vitrail::vulkan::Trial;

constexpr std::array<std::uint32_t, 3> kFills = {8, 1, 4}; // of each way

class TrialTest : public VulkanTest {
 protected:
  TrialTest() : commands_(backend().device()) {}

  static Context& context() { return backend().context(0); }
  static VitrailVkTrialDesc desc() {
    VitrailVkTrialDesc desc{};
    desc.queueFamily = backend().device().queueFamily();
    desc.ways = kFills.size();
    desc.warmUps = 1;
    desc.rounds = 3;
    desc.version = 7;
    return desc;
  }
  static Trial make(const VitrailVkTrialDesc& desc) {
    Trial trial;
    EXPECT_EQ(Trial::create(context(), desc, trial), VK_SUCCESS);
    return trial;
  }

  void fill(VkCommandBuffer commands, std::uint32_t times) {
    for (std::uint32_t i = 0; i < times; ++i) {
      cmdBarrier(commands, kTransferWrite, kTransferWrite);
      vkCmdFillBuffer(commands, buffer_.get(), 0, VK_WHOLE_SIZE, i);
    }
  }
  void frame(VkCommandBuffer commands, Trial& trial, std::uint32_t way) {
    trial.begin(commands, way);
    fill(commands, kFills.at(way));
    trial.end(commands);
  }
  // Draws frames as the trial asks for them. Returns their ways.
  std::vector<std::uint32_t> draw(Trial& trial, std::size_t frames) {
    std::vector<std::uint32_t> ways;
    for (std::size_t i = 0; i < frames; ++i) {
      const std::uint32_t way = trial.way();
      ways.push_back(way);
      commands_.run([&](VkCommandBuffer commands) { frame(commands, trial, way); });
    }
    return ways;
  }

  Commands commands_;
  Buffer buffer_{backend().device(), VkDeviceSize{8} << 20U, VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::Device};
};

TEST_F(TrialTest, TheFastestWayIsFoundAndRemembered) {
  Trial trial = make(desc());
  VitrailVkTrialResult result{};
  std::size_t size = 999;
  EXPECT_EQ(draw(trial, 11), (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1}));
  EXPECT_EQ(trial.read(result), VK_NOT_READY);
  EXPECT_EQ(result.rounds[0], 3U);
  EXPECT_EQ(result.rounds[2], 2U);
  EXPECT_EQ(trial.memory(size, nullptr), VK_NOT_READY);
  EXPECT_EQ(size, 0U);
  EXPECT_EQ(draw(trial, 3), (std::vector<std::uint32_t>{2, 1, 1})) << "it is over with the first of them";

  ASSERT_EQ(trial.read(result), VK_SUCCESS);
  EXPECT_EQ(result.fastest, 1U);
  EXPECT_FALSE(result.remembered);
  for (std::size_t way = 0; way < kFills.size(); ++way) {
    EXPECT_EQ(result.rounds[way], 3U);
    EXPECT_GT(result.milliseconds[way], 0.0);
  }
  EXPECT_LT(result.milliseconds[1], result.milliseconds[2]);
  EXPECT_LT(result.milliseconds[2], result.milliseconds[0]);
  EXPECT_EQ(result.milliseconds[3], 0.0);

  EXPECT_EQ(trial.memory(size, nullptr), VK_SUCCESS);
  std::vector<unsigned char> memory(size);
  std::size_t small = size - 1;
  EXPECT_EQ(trial.memory(small, memory.data()), VK_INCOMPLETE);
  EXPECT_EQ(small, 0U);
  ASSERT_EQ(trial.memory(size, memory.data()), VK_SUCCESS);

  VitrailVkTrialDesc again = desc();
  again.memory = memory.data();
  again.memorySize = memory.size();
  Trial second = make(again);
  VitrailVkTrialResult kept{};
  ASSERT_EQ(second.read(kept), VK_SUCCESS);
  EXPECT_TRUE(kept.remembered);
  EXPECT_EQ(kept.fastest, 1U);
  EXPECT_EQ(kept.milliseconds[0], result.milliseconds[0]);
  EXPECT_EQ(draw(second, 2), (std::vector<std::uint32_t>{1, 1}));
  std::vector<unsigned char> same(size);
  ASSERT_EQ(second.memory(size, same.data()), VK_SUCCESS);
  EXPECT_EQ(same, memory);

  again.version = 8;
  Trial other = make(again);
  EXPECT_EQ(other.read(kept), VK_NOT_READY) << "of another version";
  again = desc();
  again.memory = memory.data();
  again.memorySize = memory.size() - 1;
  EXPECT_EQ(make(again).read(kept), VK_NOT_READY) << "damaged";
}

TEST_F(TrialTest, DefaultsAreFourAndNineFrames) {
  VitrailVkTrialDesc few = desc();
  few.ways = 2;
  few.warmUps = few.rounds = 0;
  Trial trial = make(few);
  VitrailVkTrialResult result{};
  draw(trial, 25);
  EXPECT_EQ(trial.read(result), VK_NOT_READY);
  draw(trial, 1);
  EXPECT_EQ(trial.read(result), VK_SUCCESS);
  EXPECT_EQ(result.rounds[0], 9U);
  EXPECT_EQ(result.rounds[1], 9U);
}

TEST_F(TrialTest, FramesThatAreNeverSubmittedDoNotCount) {
  Trial trial = make(desc());
  VitrailVkTrialResult result{};
  for (int i = 0; i < 30; ++i) frame(commands_.begin(), trial, trial.way());
  EXPECT_EQ(trial.read(result), VK_NOT_READY);
  EXPECT_EQ(result.rounds[0], 0U);
  draw(trial, 12);
  EXPECT_EQ(trial.read(result), VK_SUCCESS);
  EXPECT_EQ(result.fastest, 1U);
}

TEST_F(TrialTest, OfTooManyFramesInFlightTheOldestDoNotCount) {
  VitrailVkTrialDesc many = desc();
  many.ways = 2;
  many.rounds = 1000;
  Trial trial = make(many);
  VitrailVkTrialResult result{};
  commands_.run([&](VkCommandBuffer commands) { // 66 of one way, and then 30 of the other, of 64 that are kept
    for (int i = 0; i < 96; ++i) {
      trial.begin(commands, i < 66 ? 1 : 0);
      trial.end(commands);
    }
  });
  EXPECT_EQ(trial.read(result), VK_NOT_READY);
  EXPECT_EQ(result.rounds[0], 29U); // but one to warm up
  EXPECT_EQ(result.rounds[1], 33U);
}

TEST_F(TrialTest, WrongCallsRecordNothing) {
  Trial trial = make(desc());
  VitrailVkTrialResult result{};
  commands_.run([&](VkCommandBuffer commands) {
    trial.begin(commands, kFills.size());
    expectOneLine("vitrailVkCmdTrialBegin: way 3 of 3");
    trial.end(commands);
    expectOneLine("vitrailVkCmdTrialEnd: no vitrailVkCmdTrialBegin");
    trial.begin(nullptr, 0);
    expectOneLine("vitrailVkCmdTrialBegin: commandBuffer is null");
    trial.end(nullptr);
    expectOneLine("vitrailVkCmdTrialEnd: commandBuffer is null");
  });
  draw(trial, 11);
  EXPECT_EQ(trial.read(result), VK_NOT_READY);
  draw(trial, 1);
  EXPECT_EQ(trial.read(result), VK_SUCCESS);
}

TEST_F(TrialTest, FramesWithoutAnEndDoNotCount) {
  Trial trial = make(desc());
  VitrailVkTrialResult result{};
  trial.begin(commands_.begin(), 0); // dropped
  commands_.run([&](VkCommandBuffer commands) { frame(commands, trial, 1); });
  expectOneLine("vitrailVkCmdTrialBegin: the frame before has no vitrailVkCmdTrialEnd");
  commands_.run([&](VkCommandBuffer commands) { // both in one
    trial.begin(commands, 0);
    frame(commands, trial, 1);
  });
  expectOneLine("vitrailVkCmdTrialBegin: the frame before has no vitrailVkCmdTrialEnd");
  EXPECT_EQ(trial.read(result), VK_NOT_READY);
  EXPECT_EQ(result.rounds[0], 0U);
  EXPECT_EQ(result.rounds[1], 1U); // but one to warm up
}

TEST_F(TrialTest, DescriptionsThatAreRefused) {
  const auto refused = [](auto change, VkResult code, const char* word) {
    VitrailVkTrialDesc wrong = desc();
    change(wrong);
    Trial trial;
    EXPECT_EQ(Trial::create(context(), wrong, trial), code) << word;
    EXPECT_FALSE(trial);
    expectOneLine(word);
  };
  constexpr VkResult kInvalid = VK_ERROR_INITIALIZATION_FAILED;
  int something = 0;
  refused([](VitrailVkTrialDesc& d) { d.ways = 1; }, kInvalid, "ways 1");
  refused([](VitrailVkTrialDesc& d) { d.ways = VITRAIL_VK_MAX_WAYS + 1; }, kInvalid, "ways 9");
  refused([](VitrailVkTrialDesc& d) { d.warmUps = 1001; }, kInvalid, "warmUps 1001");
  refused([](VitrailVkTrialDesc& d) { d.rounds = 1001; }, kInvalid, "rounds 1001");
  refused([](VitrailVkTrialDesc& d) { d.memorySize = 8; }, kInvalid, "memorySize 8");
  refused([](VitrailVkTrialDesc& d) { d.queueFamily = 1000; }, kInvalid, "queueFamily 1000");
  refused([&](VitrailVkTrialDesc& d) { d.next = &something; }, kInvalid, "VitrailVkTrialDesc::next");
}

TEST_F(TrialTest, NullArguments) {
  const VitrailVkTrialDesc good = desc();
  auto trial = reinterpret_cast<VitrailVkTrial>(&commands_);
  EXPECT_EQ(vitrailVkCreateTrial(nullptr, &good, &trial), VK_ERROR_INITIALIZATION_FAILED);
  EXPECT_EQ(trial, nullptr);
  EXPECT_EQ(vitrailVkCreateTrial(context().handle(), nullptr, &trial), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("null");
  EXPECT_EQ(vitrailVkCreateTrial(context().handle(), &good, nullptr), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("null");
  vitrailVkDestroyTrial(nullptr);
  EXPECT_EQ(vitrailVkTrialWay(nullptr), 0U);
  vitrailVkCmdTrialBegin(nullptr, nullptr, 0);
  vitrailVkCmdTrialEnd(nullptr, nullptr);
  VitrailVkTrialResult result{};
  result.fastest = 7;
  EXPECT_EQ(vitrailVkReadTrial(nullptr, &result), VK_ERROR_INITIALIZATION_FAILED);
  EXPECT_EQ(result.fastest, 0U);
  std::size_t size = 7;
  EXPECT_EQ(vitrailVkTrialMemory(nullptr, &size, nullptr), VK_ERROR_INITIALIZATION_FAILED);
  EXPECT_EQ(size, 0U);
  Trial made = make(good);
  EXPECT_EQ(vitrailVkReadTrial(made.handle(), nullptr), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("null");
  EXPECT_EQ(vitrailVkTrialMemory(made.handle(), nullptr, nullptr), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("null");
}

TEST_F(TrialTest, ContextsStayUntilTheirTrialsAreGone) {
  VitrailVkContextDesc of = backend().contextDesc();
  Context own;
  ASSERT_EQ(Context::create(of, own), VK_SUCCESS);
  Trial trial;
  ASSERT_EQ(Trial::create(own, desc(), trial), VK_SUCCESS);
  own = Context();
  expectOneLine("left");
  EXPECT_EQ(draw(trial, 1).front(), 0U);
}

} // namespace
} // namespace vitrail::tests::vulkan
