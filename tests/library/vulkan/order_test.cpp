// Recording calls that are left out, come twice or at the wrong place: a line in the log, nothing recorded, and never a
// frame that counts as exact with a wrong picture. The next frame is as if nothing had happened.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::vulkan {
namespace {

constexpr std::array kRightOrder{Step::Begin, Step::Collected, Step::Resolve, Step::End};

std::string describe(std::span<const Step> steps) {
  constexpr std::array kNames{"begin", "collected", "resolve", "end"};
  std::string text;
  for (const Step step : steps) text += std::string(text.empty() ? "" : ", ") + kNames[static_cast<std::size_t>(step)];
  return text;
}

// A host that has drawn a frame, what its next frames draw, and what comes of that.
class OrderedHost {
 public:
  explicit OrderedHost(const Way& way) {
    desc_.behind = {0.25F, 0.5F, 1.0F, 1.0F};
    apply(way, desc_);
    points_ = randomLists(desc_, {0, 1, 2, 5, 16, 17, 33, 70}, 8);
    desc_.capacity = static_cast<std::uint32_t>(points_.size());
    host_ = std::make_unique<VulkanHost>(backend(), desc_);
    expectRightFrame(0);
  }

  // A frame as it should be is right, with so many lines in the log. It is exact unless it is begun over one that was
  // not ended, which has a line: what it lacks may have been drawn into that one.
  void expectRightFrame(std::size_t lines) {
    const VulkanHost::Outcome outcome = host_->drawSteps(points_, kRightOrder);
    EXPECT_EQ(backend().takeLog().size(), lines);
    ASSERT_TRUE(outcome.stats);
    EXPECT_EQ(outcome.stats->complete, lines == 0 ? 1U : 0U);
    EXPECT_TRUE(isRight(outcome)) << "the frame after is wrong";
  }

  // Draws a frame by these calls; gives the lines in the log, of which none is empty.
  std::vector<LogLine> draw(std::span<const Step> steps) {
    outcome_ = host_->drawSteps(points_, steps);
    std::vector<LogLine> lines = backend().takeLog();
    for (const LogLine& line : lines) EXPECT_NE(line.text.find("vitrailVkCmd"), std::string::npos) << line.text;
    EXPECT_TRUE(!countsAsExact() || isRight(outcome_)) << "exact, and a wrong picture";
    return lines;
  }

  [[nodiscard]] bool countsAsExact() const { return outcome_.stats && outcome_.stats->complete == 1; }

 private:
  [[nodiscard]] bool isRight(const VulkanHost::Outcome& outcome) const {
    return largestError(outcome.pixels, expectedFrame(desc_, points_).pixels) < kTolerance;
  }

  HostDesc desc_;
  std::vector<Point> points_;
  std::unique_ptr<VulkanHost> host_;
  VulkanHost::Outcome outcome_;
};

class OrderTest : public VulkanTest {
 protected:
  // Draws a frame by these calls in every way, and one after it: so many lines each.
  static void expectLines(const std::vector<Step>& steps, std::size_t lines, std::size_t after = 0) {
    SCOPED_TRACE(describe(steps));
    for (const Way& way : everyWay(backend().features(), 1)) {
      SCOPED_TRACE(way.name);
      OrderedHost host(way);
      const std::vector<LogLine> logged = host.draw(steps);
      EXPECT_EQ(logged.size(), lines);
      for (const LogLine& line : logged) EXPECT_EQ(line.severity, VITRAIL_LOG_ERROR) << line.text;
      EXPECT_FALSE(host.countsAsExact());
      host.expectRightFrame(after);
    }
  }
};

TEST_F(OrderTest, CollectedTwice) {
  expectLines({Step::Begin, Step::Collected, Step::Collected, Step::Resolve, Step::End}, 1);
}

TEST_F(OrderTest, NotCollected) { expectLines({Step::Begin, Step::Resolve, Step::End}, 1); }

TEST_F(OrderTest, ResolvedTwice) {
  expectLines({Step::Begin, Step::Collected, Step::Resolve, Step::Resolve, Step::End}, 1);
}

TEST_F(OrderTest, NotResolved) { expectLines({Step::Begin, Step::Collected, Step::End}, 1); }

// What is refused once the frame has ended is no part of it: its statistics were on their way.
TEST_F(OrderTest, EndedTwice) {
  for (const Way& way : everyWay(backend().features(), 1)) {
    SCOPED_TRACE(way.name);
    OrderedHost host(way);
    EXPECT_EQ(host.draw(std::array{Step::Begin, Step::Collected, Step::Resolve, Step::End, Step::End}).size(), 1U);
    host.expectRightFrame(0);
  }
}

// A frame that is not ended has no statistics; the next one says that it was dropped.
TEST_F(OrderTest, NotEnded) { expectLines({Step::Begin, Step::Collected, Step::Resolve}, 0, 1); }

TEST_F(OrderTest, NotBegun) { expectLines({Step::Collected, Step::Resolve, Step::End}, 3); }

// Before any frame was begun with the target.
TEST_F(OrderTest, ResolvedBeforeAnyFrame) {
  for (const Way& way : everyWay(backend().features(), 1)) {
    SCOPED_TRACE(way.name);
    HostDesc desc;
    desc.capacity = 4;
    apply(way, desc);
    VulkanHost host(backend(), desc);
    const VulkanHost::Outcome outcome = host.drawSteps({}, std::array{Step::Resolve});
    expectOneLine("vitrailVkCmdResolve");
    for (const FloatColor& pixel : outcome.pixels) EXPECT_EQ(pixel, desc.behind);
    VitrailStats stats{};
    EXPECT_EQ(host.target().readStats(0, stats), VK_NOT_READY);
  }
}

// Begun twice, a frame is a dropped one and a right one: a warning.
TEST_F(OrderTest, BegunTwice) {
  for (const Way& way : everyWay(backend().features(), 1)) {
    SCOPED_TRACE(way.name);
    OrderedHost host(way);
    const std::vector<LogLine> lines =
        host.draw(std::array{Step::Begin, Step::Begin, Step::Collected, Step::Resolve, Step::End});
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].severity, VITRAIL_LOG_WARNING);
    host.expectRightFrame(0);
  }
}

// The calls of a frame in every order but the right one.
TEST_F(OrderTest, EveryWrongOrderIsSeen) {
  for (const Way& way : everyWay(backend().features(), 1)) {
    OrderedHost host(way);
    std::array<Step, 4> steps = kRightOrder;
    while (std::next_permutation(steps.begin(), steps.end())) {
      SCOPED_TRACE(way.name + ": " + describe(steps));
      const std::size_t lines = host.draw(steps).size();
      EXPECT_GE(lines, 1U);
      EXPECT_LT(lines, steps.size());
      EXPECT_FALSE(host.countsAsExact());
      // One that was left open says so now.
      const auto begin = std::find(steps.begin(), steps.end(), Step::Begin);
      host.expectRightFrame(std::find(begin, steps.end(), Step::End) == steps.end() ? 1 : 0);
    }
  }
}

// The call goes on with what there is, and says so.
TEST_F(OrderTest, AreasAndViewsThatAreNotThereAreTakenFromWhatIs) {
  HostDesc desc;
  desc.capacity = 4;
  desc.areaPixels = 16;
  VulkanHost host(backend(), desc);
  const std::vector<Point> points = {{0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}}};
  const auto expectWarning = [](const std::string& word) {
    const std::vector<LogLine> lines = backend().takeLog();
    ASSERT_EQ(lines.size(), 1U) << word;
    EXPECT_EQ(lines[0].severity, VITRAIL_LOG_WARNING);
    EXPECT_NE(lines[0].text.find(word), std::string::npos) << lines[0].text;
  };
  EXPECT_EQ(host.draw(points).stats.complete, 0U); // 8x8 pixels
  expectWarning("areaPixels");

  Target& target = host.target();
  Commands commands(backend().device());
  commands.run([&](VkCommandBuffer buffer) {
    VitrailVkBeginInfo begin{};
    begin.area = {{0, 0}, {4, 4}};
    target.begin(buffer, begin);
    target.collected(buffer);
    VitrailVkResolveInfo resolve{};
    resolve.view = 5;
    target.resolve(buffer, resolve);
    target.end(buffer);
  });
  expectWarning("view 5");
  VitrailStats stats{};
  ASSERT_EQ(target.readStats(target.frame(), stats), VK_SUCCESS);
  EXPECT_EQ(stats.complete, 0U);
}

// Memory that is replaced in the middle of a frame is not the frame's: it is dropped, and says so.
TEST_F(OrderTest, AResizeInAFrameDropsIt) {
  HostDesc desc;
  desc.capacity = 4;
  VulkanHost host(backend(), desc);
  const std::vector<Point> points = {{0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}}};
  const PointResult before = host.draw(points);
  VitrailVkResizeInfo resize{};
  resize.extent = {desc.width, desc.height};
  resize.views = host.targetDesc().views;
  Commands recorded(backend().device());
  recorded.run([&](VkCommandBuffer commands) {
    host.target().begin(commands);
    EXPECT_EQ(host.target().resize(resize), VK_SUCCESS);
    expectOneLine("dropped");
    host.target().collected(commands);
    expectOneLine("without a frame");
  });
  const PointResult after = host.draw(points);
  EXPECT_EQ(after.stats.complete, 1U);
  EXPECT_TRUE(after.pixels == before.pixels);
}

// Sums of a frame that overflowed and was not collected are not added to those of the next one.
TEST_F(OrderTest, SumsOfAFrameThatWasNotCollectedAreGone) {
  HostDesc desc;
  desc.capacity = 2;
  desc.resolve = VITRAIL_RESOLVE_FRAGMENT;
  const std::vector<Point> points = std::vector<Point>(10, {0, 0, 0.5F, {1.0F, 0.5F, 0.25F, 0.5F}});
  const PointResult alone = VulkanHost(backend(), desc).draw(points);
  VulkanHost host(backend(), desc);
  host.drawSteps(points, std::array{Step::Begin, Step::End});
  backend().takeLog();
  EXPECT_TRUE(host.draw(points).pixels == alone.pixels);
}

// A copy of lists that cannot be had records nothing and says why; the frame does not count as exact.
TEST_F(OrderTest, CopiesThatCannotBeHadAreRefused) {
  HostDesc desc;
  desc.capacity = 4;
  desc.copyLayers = 16;
  VulkanHost host(backend(), desc);
  HostDesc without = desc;
  without.copyLayers = 0;
  VulkanHost other(backend(), without);
  const std::vector<Point> points = {{0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}}};
  host.draw(points);
  other.draw(points);
  const Buffer buffer(backend().device(), host.target().copySize(4, 4), VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::Host);
  std::memset(buffer.mapped(), 0x5a, buffer.size());
  const auto refuse = [&](VkCommandBuffer commands, const Target& target, const VkRect2D& area, VkBuffer into,
                          VkDeviceSize offset, const std::string& word) {
    VitrailVkCopyInfo info{};
    info.area = area;
    info.buffer = into;
    info.offset = offset;
    info.size = into != VK_NULL_HANDLE && word != "size" ? buffer.size() - offset : 16;
    target.copyLists(commands, info);
    expectOneLine(word);
  };
  Commands recorded(backend().device());
  recorded.run([&](VkCommandBuffer commands) {
    Target& target = host.target();
    refuse(commands, target, {{0, 0}, {4, 4}}, buffer.get(), 0, "CopyLists"); // before the frame
    target.begin(commands);
    target.collected(commands);
    refuse(commands, target, {{0, 0}, {8, 8}}, buffer.get(), 0, "copyLayers 16"); // more pixels than layers
    refuse(commands, target, {{6, 0}, {4, 4}}, buffer.get(), 0, "inside");
    refuse(commands, target, {{-1, 0}, {4, 4}}, buffer.get(), 0, "inside");
    refuse(commands, target, {{0, 0}, {0, 4}}, buffer.get(), 0, "inside");
    refuse(commands, target, {{0, 0}, {4, 4}}, VK_NULL_HANDLE, 0, "buffer");
    refuse(commands, target, {{0, 0}, {4, 4}}, buffer.get(), 2, "offset");
    refuse(commands, target, {{0, 0}, {4, 4}}, buffer.get(), 0, "size");
    target.resolve(commands);
    target.end(commands);
    other.target().begin(commands);
    other.target().collected(commands);
    refuse(commands, other.target(), {{0, 0}, {4, 4}}, buffer.get(), 0, "without copyLayers");
    other.target().resolve(commands);
    other.target().end(commands);
  });
  EXPECT_EQ(host.stats(host.target().frame())->complete, 0U);
  const auto* bytes = static_cast<const std::uint8_t*>(buffer.mapped());
  EXPECT_TRUE(std::all_of(bytes, bytes + buffer.size(), [](std::uint8_t byte) { return byte == 0x5a; }));
  EXPECT_EQ(host.draw(points).stats.complete, 1U);
}

// Frames that the library numbers are 0, 1, 2, ... and their statistics are theirs.
TEST_F(OrderTest, TheLibraryNumbersFramesWhereTheHostDoesNot) {
  HostDesc desc;
  desc.capacity = 10;
  VulkanOptions options;
  options.numbersFrames = false;
  VulkanHost host(backend(), desc, options);
  EXPECT_EQ(host.target().frame(), 0U);
  for (std::uint32_t frame = 0; frame < 5; ++frame) {
    const std::vector<Point> points = randomLists(desc, {frame + 1}, 3);
    const PointResult result = host.draw(points);
    EXPECT_EQ(host.target().frame(), frame);
    EXPECT_EQ(result.stats.frame, frame);
    EXPECT_EQ(result.stats.layersMax, frame + 1);
  }
}

} // namespace
} // namespace vitrail::tests::vulkan
