// The barriers of a frame. OpenGL has no validation of them: hazards.h looks at a record of the calls, and must object
// where any one barrier is left out. llvmpipe, which runs dispatches before draws that it has put off, must draw a
// wrong picture without the one between them.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "../expected.h"
#include "backend.h"
#include "hazards.h"
#include "point_host.h"
#include "tapped.h"

namespace vitrail::tests::opengl {
namespace {

class BarriersTest : public OpenGlTest {};

// Hosts whose calls are written down.
class RecordTest : public OpenGlTest {
 protected:
  void SetUp() override {
    OpenGlTest::SetUp();
    VitrailGlContextDesc desc = backend().contextDesc();
    tap.real = desc.getProcAddress;
    desc.getProcAddress = tappedLoader;
    ASSERT_EQ(vitrailGlCreateContext(&desc, &context_), VITRAIL_SUCCESS);
    usual_ = backend().exchangeContext(context_);
  }
  void TearDown() override {
    backend().exchangeContext(usual_);
    vitrailGlDestroyContext(context_);
    tap.reset();
    OpenGlTest::TearDown();
  }

  static constexpr std::string_view kFrame = "(a frame)";
  static constexpr std::uint64_t kFrames = 4;

  // What some frames call. The one before the last is dropped when it has drawn, so that nothing of what shaders wrote
  // has a barrier when the last one begins.
  static std::vector<TappedCall> record(const HostDesc& desc, const std::vector<Point>& points, bool hostBarriers) {
    OpenGlHost host(backend(), desc, hostBarriers);
    GLuint copied = 0;
    glGenBuffers(1, &copied);
    glBindBuffer(GL_COPY_WRITE_BUFFER, copied);
    glBufferData(GL_COPY_WRITE_BUFFER, 1 << 20, nullptr, GL_DYNAMIC_READ);
    tap.reset();
    for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
      tap.calls.push_back({kFrame});
      PointTextures& textures = host.texturesOf(frame);
      host.drawOpaque(textures);
      host.begin(frame, {});
      host.drawPoints(textures, points);
      tap.calls.push_back({kHostCollects});
      if (frame == kFrames - 2) continue;
      host.collected();
      if (desc.copyLayers != 0) copy(host.target(), copied);
      host.resolve(textures, frame % PointHost::kFramesTogether);
      if (hostBarriers) tap.calls.push_back({kHostOrdersPicture});
      tap.calls.push_back({kHostUsesPicture});
      host.end();
    }
    for (const LogLine& line : backend().takeLog()) {
      EXPECT_NE(line.text.find("not ended"), std::string::npos) << line.text;
    }
    glDeleteBuffers(1, &copied);
    return tap.calls;
  }

  static void copy(VitrailGlTarget target, GLuint buffer) {
    VitrailGlCopyInfo info{};
    info.area = {0, 0, 4, 4};
    info.buffer = buffer;
    info.size = vitrailGlCopySize(target, 4, 4);
    vitrailGlCopyLists(target, &info);
  }

  // None is missing, and each of the last frame is needed, but for some that another one follows at once.
  static void expectEachIsNeeded(const std::vector<TappedCall>& calls, std::size_t spare) {
    for (const std::string& missing : missingBarriers(calls)) ADD_FAILURE() << missing;
    std::uint64_t frame = 0;
    std::size_t tried = 0;
    std::string notNeeded;
    std::size_t notNeededCount = 0;
    for (std::size_t i = 0; i < calls.size(); ++i) {
      if (calls[i].name == kFrame) ++frame;
      if (calls[i].name != "MemoryBarrier" || frame != kFrames) continue;
      std::vector<TappedCall> fewer = calls;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      ++tried;
      if (!missingBarriers(fewer).empty()) continue;
      ++notNeededCount;
      notNeeded += " number " + std::to_string(tried) + " with the bits " + std::to_string(calls[i].first);
    }
    EXPECT_EQ(notNeededCount, spare) << "barriers that are not needed:" << notNeeded;
    EXPECT_GE(tried, 5U);
  }

 private:
  VitrailGlContext context_ = nullptr;
  VitrailGlContext usual_ = nullptr;
};

TEST_F(RecordTest, EveryBarrierIsThereAndNeeded) {
  std::vector<std::uint32_t> counts = sampleCounts(backend().features());
  if (counts.size() > 2) counts = {1, 4};
  for (const std::uint32_t samples : counts) {
    for (const Way& way : everyWay(backend().features(), samples)) {
      for (const bool copies : {false, true}) {
        for (const bool hostBarriers : {false, true}) {
          SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name + (copies ? ", copied" : "") +
                       (hostBarriers ? ", by the host" : ""));
          HostDesc desc;
          desc.samples = samples;
          desc.copyLayers = copies ? 2000 : 0;
          apply(way, desc);
          const std::vector<Point> points = randomLists(desc, {0, 1, 5, 17, 33, 70, 300}, 4);
          desc.capacity = static_cast<std::uint32_t>(points.size());
          // A copy has barriers before and behind it, where there is one of the resolve's (or one of the host's).
          const std::size_t spare = copies ? (hostBarriers ? 2 : 1) : 0;
          expectEachIsNeeded(record(desc, points, hostBarriers), spare);
        }
      }
    }
  }
}

// The negative control of the above, on a driver: a fault that is there to be seen.
TEST_F(RecordTest, ADriverThatPutsDrawsOffShowsAMissingBarrier) {
  const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (renderer.find("llvmpipe") == std::string::npos) GTEST_SKIP() << renderer << " may run draws at once";
  HostDesc desc;
  desc.behind = {0.25F, 0.5F, 1.0F, 1.0F};
  const std::vector<Point> points = randomLists(desc, {300, 200, 100}, 4);
  desc.capacity = static_cast<std::uint32_t>(points.size());
  OpenGlHost host(backend(), desc);
  const std::vector<FloatColor> right = host.draw(points).pixels;
  constexpr std::size_t kCollected = 2; // of a frame's barriers: the host's draws -> vitrailGlCollected()
  constexpr int kMostFrames = 100;      // one is enough, unless the draws were not put off by chance
  bool seen = false;
  for (int i = 0; i < kMostFrames && !seen; ++i) {
    tap.reset();
    tap.leftOutBarrier = kCollected;
    const PointResult result = host.draw(points);
    seen = result.pixels != right;
    EXPECT_TRUE(!seen || result.stats.complete == 0);
  }
  EXPECT_TRUE(seen);
  tap.reset();
  EXPECT_TRUE(host.draw(points).pixels == right);
}

// Every one is of what shaders wrote before: the bits say how it is used behind it.
TEST_F(BarriersTest, NameWhatIsReadOrWrittenNext) {
  for (const Way& way : everyWay(backend().features(), 1)) {
    SCOPED_TRACE(way.name);
    HostDesc desc;
    desc.capacity = 10;
    apply(way, desc);
    const OpenGlHost host(backend(), desc);
    const auto bits = [&](VitrailGlBarrierPoint point) { return vitrailGlBarriers(host.target(), point); };
    // The clears of glClearBufferSubData() and glBufferSubData() write over what shaders wrote.
    EXPECT_NE(bits(VITRAIL_GL_BARRIER_BEGIN) & GL_BUFFER_UPDATE_BARRIER_BIT, 0U);
    // The sums, which the last frame's resolve has cleaned. The clears of this frame are in order.
    EXPECT_NE(bits(VITRAIL_GL_BARRIER_COLLECT) & GL_SHADER_STORAGE_BARRIER_BIT, 0U);
    // Lists and counters, by storage buffers.
    EXPECT_NE(bits(VITRAIL_GL_BARRIER_COLLECTED) & GL_SHADER_STORAGE_BARRIER_BIT, 0U);
    EXPECT_NE(bits(VITRAIL_GL_BARRIER_RESOLVE) & GL_SHADER_STORAGE_BARRIER_BIT, 0U);
    // The counters are copied with glCopyBufferSubData().
    EXPECT_NE(bits(VITRAIL_GL_BARRIER_END) & (GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT), 0U);
    // Draws and dispatches take their arguments from what a kernel wrote as it was collected.
    EXPECT_NE(bits(VITRAIL_GL_BARRIER_RESOLVE) & GL_COMMAND_BARRIER_BIT, 0U);
    // And nothing that no pass does: the first are transfers and a kernel that empties the lists, and no shader writes
    // what uniform blocks read.
    EXPECT_EQ(bits(VITRAIL_GL_BARRIER_BEGIN), GLbitfield{GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT});
    EXPECT_EQ(bits(VITRAIL_GL_BARRIER_COLLECT), GLbitfield{GL_SHADER_STORAGE_BARRIER_BIT});
    for (const auto point : {VITRAIL_GL_BARRIER_COLLECTED, VITRAIL_GL_BARRIER_RESOLVE, VITRAIL_GL_BARRIER_END}) {
      constexpr GLbitfield kAny = GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT;
      EXPECT_EQ(bits(point) & ~kAny, 0U) << point;
    }
    EXPECT_EQ(vitrailGlBarriers(host.target(), static_cast<VitrailGlBarrierPoint>(77)), 0U);
    expectOneLine("77");
  }
}

// A host that makes them all has right pictures.
TEST_F(BarriersTest, AHostMakesThemAll) {
  std::vector<std::uint32_t> counts = sampleCounts(backend().features());
  if (counts.size() > 2) counts = {1, 4};
  for (const std::uint32_t samples : counts) {
    for (const Way& way : everyWay(backend().features(), samples)) {
      SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name);
      HostDesc desc;
      desc.samples = samples;
      apply(way, desc);
      const std::vector<Point> points = randomLists(desc, {0, 1, 5, 17, 33, 70, 300}, 4);
      const std::vector<Point> fewer = randomLists(desc, {3, 2}, 5);
      for (const std::size_t capacity : {points.size(), points.size() / 2}) {
        desc.capacity = static_cast<std::uint32_t>(capacity);
        OpenGlHost host(backend(), desc, true);
        OpenGlHost usual(backend(), desc);
        const std::vector<PointResult> results = host.drawTogether({points, fewer});
        EXPECT_TRUE(results[0].pixels == usual.draw(points).pixels);
        EXPECT_TRUE(results[1].pixels == usual.draw(fewer).pixels);
        EXPECT_EQ(results[0].stats.complete, capacity == points.size() ? 1U : 0U);
        EXPECT_EQ(results[1].stats.complete, 1U);
      }
    }
  }
}

} // namespace
} // namespace vitrail::tests::opengl
