// Calls of a frame that are left out, come twice or at the wrong place: a line in the log, nothing done, and never a
// frame that counts as exact with a wrong picture. The next frame is as if nothing had happened.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "backend.h"
#include "expected.h"

namespace vitrail::tests {
namespace {

// The calls of a frame. Points are drawn after Begin.
enum class Step { Begin, Collected, Resolve, End };
constexpr std::array kRightOrder{Step::Begin, Step::Collected, Step::Resolve, Step::End};

std::string describe(std::span<const Step> steps) {
  constexpr std::array kNames{"begin", "collected", "resolve", "end"};
  std::string text;
  for (const Step step : steps) text += std::string(text.empty() ? "" : ", ") + kNames[static_cast<std::size_t>(step)];
  return text;
}

void make(FrameCalls& calls, Step step, std::span<const Point> points) {
  switch (step) {
    case Step::Begin:
      calls.begin({});
      return calls.draw(points);
    case Step::Collected:
      return calls.collected();
    case Step::Resolve:
      return calls.resolve({});
    case Step::End:
      return calls.end();
  }
}

CallsResult drawSteps(PointHost& host, std::span<const Point> points, std::span<const Step> steps) {
  return host.drawCalls([&](FrameCalls& calls) {
    for (const Step step : steps) make(calls, step, points);
  });
}

// A host that has drawn a frame, what its next frames draw, and what comes of that.
class OrderedHost {
 public:
  OrderedHost(Backend& backend, const Way& way) : backend_(backend) {
    desc_.behind = {0.25F, 0.5F, 1.0F, 1.0F};
    apply(way, desc_);
    points_ = randomLists(desc_, {0, 1, 2, 5, 16, 17, 33, 70}, 8);
    desc_.capacity = static_cast<std::uint32_t>(points_.size());
    host_ = backend.makeHost(desc_);
    expectRightFrame(0);
  }

  // A frame as it should be is right, with so many lines in the log. It is exact unless it is begun over one that was
  // not ended, which has a line: what it lacks may have been drawn into that one.
  void expectRightFrame(std::size_t lines) {
    const CallsResult result = drawSteps(*host_, points_, kRightOrder);
    EXPECT_EQ(backend_.takeLog().size(), lines);
    ASSERT_TRUE(result.stats);
    EXPECT_EQ(result.stats->complete, lines == 0 ? 1U : 0U);
    EXPECT_TRUE(isRight(result)) << "the frame after is wrong";
  }

  // Draws a frame by these calls; gives the lines in the log, of which none is empty.
  std::vector<LogLine> draw(std::span<const Step> steps) {
    result_ = drawSteps(*host_, points_, steps);
    std::vector<LogLine> lines = backend_.takeLog();
    for (const LogLine& line : lines) {
      EXPECT_NE(line.text.find(backend_.callPrefix()), std::string::npos) << line.text;
    }
    EXPECT_TRUE(!countsAsExact() || isRight(result_)) << "exact, and a wrong picture";
    return lines;
  }

  [[nodiscard]] bool countsAsExact() const { return result_.stats && result_.stats->complete == 1; }

 private:
  [[nodiscard]] bool isRight(const CallsResult& result) const {
    return largestError(result.pixels, expectedFrame(desc_, points_).pixels) < kTolerance;
  }

  Backend& backend_;
  HostDesc desc_;
  std::vector<Point> points_;
  std::unique_ptr<PointHost> host_;
  CallsResult result_;
};

class OrderTest : public BackendTest {
 protected:
  // Draws a frame by these calls in every way, and one after it: so many lines each.
  static void expectLines(const std::vector<Step>& steps, std::size_t lines, std::size_t after = 0) {
    SCOPED_TRACE(describe(steps));
    for (const Way& way : everyWay(features(), 1)) {
      SCOPED_TRACE(way.name);
      OrderedHost host(backend(), way);
      const std::vector<LogLine> logged = host.draw(steps);
      EXPECT_EQ(logged.size(), lines);
      for (const LogLine& line : logged) EXPECT_EQ(line.severity, VITRAIL_LOG_ERROR) << line.text;
      EXPECT_FALSE(host.countsAsExact());
      host.expectRightFrame(after);
    }
  }

  static void expectWarning(const std::string& word) {
    const std::vector<LogLine> lines = backend().takeLog();
    ASSERT_EQ(lines.size(), 1U) << word;
    EXPECT_EQ(lines[0].severity, VITRAIL_LOG_WARNING);
    EXPECT_NE(lines[0].text.find(word), std::string::npos) << lines[0].text;
  }
};

VITRAIL_ON_EVERY_BACKEND(OrderTest);

TEST_P(OrderTest, CollectedTwice) {
  expectLines({Step::Begin, Step::Collected, Step::Collected, Step::Resolve, Step::End}, 1);
}

TEST_P(OrderTest, NotCollected) { expectLines({Step::Begin, Step::Resolve, Step::End}, 1); }

TEST_P(OrderTest, ResolvedTwice) {
  expectLines({Step::Begin, Step::Collected, Step::Resolve, Step::Resolve, Step::End}, 1);
}

TEST_P(OrderTest, NotResolved) { expectLines({Step::Begin, Step::Collected, Step::End}, 1); }

// What is refused once the frame has ended is no part of it: its statistics were on their way.
TEST_P(OrderTest, EndedTwice) {
  for (const Way& way : everyWay(features(), 1)) {
    SCOPED_TRACE(way.name);
    OrderedHost host(backend(), way);
    EXPECT_EQ(host.draw(std::array{Step::Begin, Step::Collected, Step::Resolve, Step::End, Step::End}).size(), 1U);
    host.expectRightFrame(0);
  }
}

// A frame that is not ended has no statistics; the next one says that it was dropped.
TEST_P(OrderTest, NotEnded) { expectLines({Step::Begin, Step::Collected, Step::Resolve}, 0, 1); }

TEST_P(OrderTest, NotBegun) { expectLines({Step::Collected, Step::Resolve, Step::End}, 3); }

// Before any frame was begun with the target.
TEST_P(OrderTest, ResolvedBeforeAnyFrame) {
  for (const Way& way : everyWay(features(), 1)) {
    SCOPED_TRACE(way.name);
    HostDesc desc;
    desc.capacity = 4;
    apply(way, desc);
    const std::unique_ptr<PointHost> host = makeHost(desc);
    const CallsResult result = drawSteps(*host, {}, std::array{Step::Resolve});
    expectOneLine(backend().callPrefix() + "Resolve");
    for (const FloatColor& pixel : result.pixels) EXPECT_EQ(pixel, desc.behind);
    EXPECT_FALSE(host->stats(0));
  }
}

// Begun twice, a frame is a dropped one and a right one: a warning.
TEST_P(OrderTest, BegunTwice) {
  for (const Way& way : everyWay(features(), 1)) {
    SCOPED_TRACE(way.name);
    OrderedHost host(backend(), way);
    const std::vector<LogLine> lines =
        host.draw(std::array{Step::Begin, Step::Begin, Step::Collected, Step::Resolve, Step::End});
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].severity, VITRAIL_LOG_WARNING);
    host.expectRightFrame(0);
  }
}

// The calls of a frame in every order but the right one.
TEST_P(OrderTest, EveryWrongOrderIsSeen) {
  for (const Way& way : everyWay(features(), 1)) {
    OrderedHost host(backend(), way);
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
TEST_P(OrderTest, AreasAndViewsThatAreNotThereAreTakenFromWhatIs) {
  HostDesc desc;
  desc.capacity = 4;
  desc.areaPixels = 16;
  const std::unique_ptr<PointHost> host = makeHost(desc);
  const std::vector<Point> points = {{0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}}};
  EXPECT_EQ(host->draw(points).stats.complete, 0U); // 8x8 pixels
  expectWarning("areaPixels");
  const CallsResult result = host->drawCalls([](FrameCalls& calls) {
    calls.begin({0, 0, 4, 4});
    calls.collected();
    calls.resolve(5);
    calls.end();
  });
  expectWarning("view 5");
  ASSERT_TRUE(result.stats);
  EXPECT_EQ(result.stats->complete, 0U);
}

// Memory that is replaced in the middle of a frame is not the frame's: it is dropped, and says so.
TEST_P(OrderTest, AResizeInAFrameDropsIt) {
  HostDesc desc;
  desc.capacity = 4;
  const std::unique_ptr<PointHost> host = makeHost(desc);
  const std::vector<Point> points = {{0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}}};
  const PointResult before = host->draw(points);
  host->drawCalls([](FrameCalls& calls) {
    calls.begin({});
    calls.resize();
    expectOneLine("dropped");
    calls.collected();
    expectOneLine("without a frame");
  });
  const PointResult after = host->draw(points);
  EXPECT_EQ(after.stats.complete, 1U);
  EXPECT_TRUE(after.pixels == before.pixels);
}

// Sums of a frame that overflowed and was not collected are not added to those of the next one.
TEST_P(OrderTest, SumsOfAFrameThatWasNotCollectedAreGone) {
  HostDesc desc;
  desc.capacity = 2;
  desc.resolve = VITRAIL_RESOLVE_FRAGMENT;
  const std::vector<Point> points = std::vector<Point>(10, {0, 0, 0.5F, {1.0F, 0.5F, 0.25F, 0.5F}});
  const PointResult alone = draw(desc, points);
  const std::unique_ptr<PointHost> host = makeHost(desc);
  drawSteps(*host, points, std::array{Step::Begin, Step::End});
  backend().takeLog();
  EXPECT_TRUE(host->draw(points).pixels == alone.pixels);
}

// A copy of lists that cannot be had does nothing and says why; the frame does not count as exact.
TEST_P(OrderTest, CopiesThatCannotBeHadAreRefused) {
  HostDesc desc;
  desc.capacity = 4;
  desc.copyLayers = 16;
  const std::unique_ptr<PointHost> host = makeHost(desc);
  const std::vector<Point> points = {{0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}}};
  host->draw(points);
  constexpr VitrailRect kArea = {0, 0, 4, 4};
  const CallsResult result = host->drawCalls([&](FrameCalls& calls) {
    const auto refuse = [&](const CopyAttempt& attempt, const char* word) {
      calls.copyLists(attempt);
      expectOneLine(word);
    };
    refuse({kArea}, "CopyLists"); // before the frame
    calls.begin({});
    calls.collected();
    refuse({{0, 0, 8, 8}}, "copyLayers 16"); // more pixels than layers
    refuse({{6, 0, 4, 4}}, "inside");
    refuse({{0xffffffffU, 0, 4, 4}}, "inside"); // -1 where numbers have signs
    refuse({{0, 0, 0, 4}}, "inside");
    refuse({kArea, false}, "buffer");
    refuse({kArea, true, 2}, "offset");
    refuse({kArea, true, 0, 16}, "size");
    calls.resolve({});
    calls.end();
  });
  EXPECT_EQ(result.stats->complete, 0U);
  EXPECT_FALSE(result.copied);
  EXPECT_EQ(host->draw(points).stats.complete, 1U);

  desc.copyLayers = 0;
  const std::unique_ptr<PointHost> without = makeHost(desc);
  without->draw(points);
  without->drawCalls([&](FrameCalls& calls) {
    calls.begin({});
    calls.collected();
    calls.copyLists({kArea});
    expectOneLine("without copyLayers");
    calls.resolve({});
    calls.end();
  });
}

// Frames that the library numbers are 0, 1, 2, ... and their statistics are theirs.
TEST_P(OrderTest, TheLibraryNumbersFramesWhereTheHostDoesNot) {
  HostDesc desc;
  desc.capacity = 10;
  desc.numbersFrames = false;
  const std::unique_ptr<PointHost> host = makeHost(desc);
  EXPECT_EQ(host->newestFrame(), 0U);
  for (std::uint32_t frame = 0; frame < 5; ++frame) {
    const std::vector<Point> points = randomLists(desc, {frame + 1}, 3);
    const PointResult result = host->draw(points);
    EXPECT_EQ(host->newestFrame(), frame);
    EXPECT_EQ(result.stats.frame, frame);
    EXPECT_EQ(result.stats.layersMax, frame + 1);
  }
}

} // namespace
} // namespace vitrail::tests
