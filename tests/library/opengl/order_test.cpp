// Calls that are left out, come twice or at the wrong place: a line in the log, nothing done, and never a frame that
// counts as exact with a wrong picture. The next frame is as if nothing had happened.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::opengl {
namespace {

enum class Step { Begin, Collected, Resolve, End };

constexpr std::array kRightOrder{Step::Begin, Step::Collected, Step::Resolve, Step::End};

// A host whose frames are made of any calls.
class OrderedHost {
 public:
  explicit OrderedHost(const Way& way) {
    desc_.behind = {0.25F, 0.5F, 1.0F, 1.0F};
    apply(way, desc_);
    points_ = randomLists(desc_, {0, 1, 2, 5, 16, 17, 33, 70}, 8);
    desc_.capacity = static_cast<std::uint32_t>(points_.size());
    host_.emplace(backend(), desc_);
    expectRightFrame(0);
  }

  // A frame as it should be is right, with so many lines in the log: begun over one that was not ended it has one, and
  // is not exact.
  void expectRightFrame(std::size_t lines) {
    draw(kRightOrder);
    EXPECT_EQ(lines_.size(), lines);
    EXPECT_EQ(countsAsExact(), lines == 0);
    EXPECT_TRUE(isRight()) << "the frame after is wrong";
  }

  // Draws a frame by these calls; gives the lines in the log.
  const std::vector<LogLine>& draw(std::span<const Step> steps) {
    ++frame_;
    PointTextures& textures = host_->texturesOf(frame_);
    host_->drawOpaque(textures);
    for (const Step step : steps) {
      if (step == Step::Begin) {
        host_->begin(frame_, {});
        host_->drawPoints(textures, points_);
      }
      if (step == Step::Collected) host_->collected();
      if (step == Step::Resolve) host_->resolve(textures, frame_ % PointHost::kFramesTogether);
      if (step == Step::End) host_->end();
    }
    lines_ = backend().takeLog();
    for (const LogLine& line : lines_) EXPECT_NE(line.text.find("vitrailGl"), std::string::npos) << line.text;
    glFinish();
    stats_ = host_->stats(frame_);
    if (stats_) pixels_ = host_->read(textures, frame_).pixels;
    EXPECT_TRUE(!countsAsExact() || isRight()) << "exact, and a wrong picture";
    return lines_;
  }

  [[nodiscard]] bool countsAsExact() const { return stats_ && stats_->complete == 1; }

 private:
  [[nodiscard]] bool isRight() const {
    return largestError(pixels_, expectedFrame(desc_, points_).pixels) < kTolerance;
  }

  HostDesc desc_;
  std::vector<Point> points_;
  std::optional<OpenGlHost> host_;
  std::uint64_t frame_ = 0;
  std::optional<VitrailStats> stats_;
  std::vector<FloatColor> pixels_;
  std::vector<LogLine> lines_;
};

class OrderTest : public OpenGlTest {
 protected:
  // Draws a frame by these calls in every way, and one after it: so many lines each.
  static void expectLines(const std::vector<Step>& steps, std::size_t lines, std::size_t after = 0) {
    for (const Way& way : everyWay(backend().features(), 1)) {
      SCOPED_TRACE(way.name);
      OrderedHost host(way);
      for (const LogLine& line : host.draw(steps)) EXPECT_EQ(line.severity, VITRAIL_LOG_ERROR) << line.text;
      EXPECT_FALSE(host.countsAsExact());
      EXPECT_EQ(host.draw({}).size(), 0U);
      host.expectRightFrame(after);
      EXPECT_EQ(OrderedHost(way).draw(steps).size(), lines);
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

// A frame that is not ended has no statistics; the next one says that it was dropped.
TEST_F(OrderTest, NotEnded) { expectLines({Step::Begin, Step::Collected, Step::Resolve}, 0, 1); }

TEST_F(OrderTest, NotBegun) { expectLines({Step::Collected, Step::Resolve, Step::End}, 3); }

// The calls of a frame in every order but the right one.
TEST_F(OrderTest, EveryWrongOrderIsSeen) {
  for (const Way& way : everyWay(backend().features(), 1)) {
    SCOPED_TRACE(way.name);
    OrderedHost host(way);
    std::array<Step, 4> steps = kRightOrder;
    while (std::next_permutation(steps.begin(), steps.end())) {
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
TEST_F(OrderTest, AViewThatIsNotThereIsTakenFromWhatIs) {
  HostDesc desc;
  desc.capacity = 4;
  const OpenGlHost host(backend(), desc);
  vitrailGlBegin(host.target(), nullptr);
  vitrailGlCollected(host.target());
  VitrailGlResolveInfo info{};
  info.view = 5;
  vitrailGlResolve(host.target(), &info);
  expectOneLine("view 5");
  vitrailGlEnd(host.target());
  glFinish();
  ASSERT_TRUE(host.stats(0));
  EXPECT_EQ(host.stats(0)->complete, 0U);
}

// A copy of lists that cannot be had writes nothing and says why; the frame does not count as exact.
TEST_F(OrderTest, CopiesThatCannotBeHadAreRefused) {
  HostDesc desc;
  desc.capacity = 4;
  desc.copyLayers = 16;
  const OpenGlHost host(backend(), desc);
  VitrailGlTarget target = host.target();
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  const auto refuse = [&](const VitrailRect& area, GLuint into, std::uint64_t offset, const std::string& word) {
    VitrailGlCopyInfo info{};
    info.area = area;
    info.buffer = into;
    info.offset = offset;
    info.size = word == "size" ? 16 : vitrailGlCopySize(target, 4, 4);
    vitrailGlCopyLists(target, &info);
    expectOneLine(word);
  };
  refuse({0, 0, 4, 4}, buffer, 0, "CopyLists"); // before the frame
  vitrailGlBegin(target, nullptr);
  vitrailGlCollected(target);
  refuse({0, 0, 8, 8}, buffer, 0, "copyLayers 16"); // more pixels than layers
  refuse({6, 0, 4, 4}, buffer, 0, "inside");
  refuse({0, 0, 0, 4}, buffer, 0, "inside");
  refuse({0, 0, 4, 4}, 0, 0, "buffer");
  refuse({0, 0, 4, 4}, buffer, 2, "offset");
  refuse({0, 0, 4, 4}, buffer, 0, "size");
  vitrailGlResolve(target, nullptr);
  vitrailGlEnd(target);
  glFinish();
  ASSERT_TRUE(host.stats(0));
  EXPECT_EQ(host.stats(0)->complete, 0U);
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  glDeleteBuffers(1, &buffer);
}

} // namespace
} // namespace vitrail::tests::opengl
