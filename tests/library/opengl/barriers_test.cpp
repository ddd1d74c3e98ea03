// The barriers of a frame, as a host with a render graph asks for them, and makes them. Nothing validates them here: a
// driver on a CPU runs what it is given in order.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::opengl {
namespace {

class BarriersTest : public OpenGlTest {};

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
    // And nothing that no pass does: the first is a transfer alone, and no shader writes what uniform blocks read.
    EXPECT_EQ(bits(VITRAIL_GL_BARRIER_BEGIN), GLbitfield{GL_BUFFER_UPDATE_BARRIER_BIT});
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
