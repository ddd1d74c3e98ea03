// The barriers of a frame, as a host with a render graph asks for them, and makes them.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::vulkan {
namespace {

constexpr std::array kPoints{VITRAIL_VK_BARRIER_BEGIN, VITRAIL_VK_BARRIER_COLLECT, VITRAIL_VK_BARRIER_COLLECTED,
                             VITRAIL_VK_BARRIER_RESOLVE, VITRAIL_VK_BARRIER_END};

class BarriersTest : public VulkanTest {};

TEST_F(BarriersTest, AsDataNameTheTargetsBuffers) {
  HostDesc desc = squareHost();
  desc.capacity = 10;
  VulkanHost host(backend(), desc);
  for (const VitrailVkBarrierPoint point : kPoints) {
    const VitrailVkBarriers barriers = host.target().barriers(point);
    EXPECT_NE(barriers.source, 0U);
    EXPECT_NE(barriers.destination, 0U);
    ASSERT_GE(barriers.count, 1U);
    ASSERT_LE(barriers.count, std::uint32_t{VITRAIL_VK_MAX_BARRIERS});
    for (std::uint32_t i = 0; i < barriers.count; ++i) {
      EXPECT_EQ(barriers.buffers[i].sType, VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER);
      EXPECT_TRUE(barriers.buffers[i].buffer != VK_NULL_HANDLE);
      EXPECT_GT(barriers.buffers[i].size, 0U);
    }
  }
  VitrailVkBarriers barriers{};
  barriers.count = 7;
  vitrailVkBarriers(host.target().handle(), static_cast<VitrailVkBarrierPoint>(77), &barriers);
  EXPECT_EQ(barriers.count, 0U);
  expectOneLine("77");
}

// A host that makes them all has right pictures, and validation has nothing to say.
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
        VulkanOptions options;
        options.hostBarriers = true;
        VulkanHost host(backend(), desc, options);
        VulkanHost usual(backend(), desc);
        const std::vector<PointResult> results = host.drawTogether({points, fewer});
        EXPECT_TRUE(results[0].pixels == usual.draw(points).pixels);
        EXPECT_TRUE(results[1].pixels == usual.draw(fewer).pixels);
        EXPECT_EQ(results[0].stats.complete, capacity == points.size() ? 1U : 0U);
        EXPECT_EQ(results[1].stats.complete, 1U);
      }
    }
  }
}

// Each of them is needed: validation objects where the host leaves it out, so the library did not record it.
TEST_F(BarriersTest, ThatAHostLeavesOutAreMissing) {
  for (const VitrailVkBarrierPoint point : kPoints) {
    SCOPED_TRACE(point);
    HostDesc desc;
    desc.listBuild = VITRAIL_LIST_BUILD_COMPUTE;
    const std::vector<Point> points = randomLists(desc, {1, 5, 17}, 4);
    desc.capacity = static_cast<std::uint32_t>(points.size());
    VulkanOptions options;
    options.hostBarriers = true;
    options.omitted = point;
    VulkanHost(backend(), desc, options).drawTogether({points, points});
    const std::vector<std::string> errors = backend().takeErrors();
    ASSERT_FALSE(errors.empty());
    EXPECT_NE(errors[0].find("SYNC-HAZARD"), std::string::npos) << errors[0];
  }
}

} // namespace
} // namespace vitrail::tests::vulkan
