// How long things live: memory that a target has replaced, and contexts that are destroyed before their targets.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::vulkan {
namespace {

class LifetimeTest : public VulkanTest {};

// A window that is being dragged: twelve sizes for one frame.
TEST_F(LifetimeTest, ResizesBetweenTwoFramesKeepOnePool) {
  constexpr std::uint64_t kBudget = 8 << 20;
  HostDesc desc = squareHost();
  desc.memoryBudget = kBudget;
  desc.capacity = 100000;
  VulkanHost host(backend(), desc);
  const std::vector<Point> points = manyLists(desc, 6, 5);
  EXPECT_EQ(host.draw(points).stats.complete, 1U);
  const std::uint64_t first = host.memory().totalBytes;
  for (std::uint32_t step = 1; step <= 12; ++step) {
    host.resize({64 + 10 * step, 64 + 5 * step});
    const VitrailMemory memory = host.memory();
    EXPECT_LE(memory.totalBytes - memory.retiredBytes, kBudget) << step;
    EXPECT_LE(memory.retiredBytes, first) << step; // the one that a frame used
  }
  desc.width = 64 + 120;
  desc.height = 64 + 60;
  const std::vector<Point> last = manyLists(desc, 6, 5);
  const PointResult result = host.draw(last);
  EXPECT_EQ(result.stats.complete, 1U);
  EXPECT_LT(largestError(result.pixels, expectedFrame(desc, last).pixels), kTolerance);
}

TEST_F(LifetimeTest, MemoryThatNoFrameUsedGoesAtOnce) {
  HostDesc desc = squareHost();
  desc.capacity = 1000;
  VulkanHost host(backend(), desc);
  host.resize({128, 128});
  EXPECT_EQ(host.memory().retiredBytes, 0U);
}

// Frames in flight keep what was replaced; frames that begin later let it go, also where the host never calls
// vitrailVkUpdateTarget().
TEST_F(LifetimeTest, BeginningFramesFreesOldPools) {
  for (const std::uint32_t framesInFlight : {1U, 2U, 3U}) {
    SCOPED_TRACE(framesInFlight);
    HostDesc desc = squareHost();
    desc.capacity = 1000;
    VulkanOptions options;
    options.update = false;
    options.framesInFlight = framesInFlight;
    VulkanHost host(backend(), desc, options);
    const std::vector<Point> points = {{0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}}};
    host.draw(points);
    host.resize({128, 128});
    // The last frame with the old pool was n; frame n + framesInFlight is begun when it has finished.
    for (std::uint32_t frame = 1; frame < framesInFlight; ++frame) {
      EXPECT_GT(host.memory().retiredBytes, 0U) << "before frame " << frame << " the old pool may be in use";
      host.draw(points);
    }
    host.draw(points);
    EXPECT_EQ(host.memory().retiredBytes, 0U);
  }
}

// A host that has waited for frame n - framesInFlight reads its statistics before or after it records frame n.
TEST_F(LifetimeTest, StatisticsAreThereWhenHostsReadThem) {
  for (const std::uint32_t framesInFlight : {1U, 2U, 3U, 8U}) {
    SCOPED_TRACE(framesInFlight);
    HostDesc desc;
    desc.capacity = 20;
    VulkanOptions options;
    options.framesInFlight = framesInFlight;
    VulkanHost host(backend(), desc, options);
    for (std::uint32_t frame = 0; frame < 12; ++frame) {
      const std::vector<Point> points = randomLists(desc, {frame + 1}, 2);
      host.draw(points);
      if (frame < framesInFlight) continue;
      const auto read = host.stats(frame - framesInFlight);
      ASSERT_TRUE(read) << "frame " << frame;
      EXPECT_EQ(read->layersMax, frame - framesInFlight + 1);
      EXPECT_EQ(host.stats(frame - framesInFlight - 1).has_value(), false) << "of frame " << frame;
    }
  }
}

// The context goes with the last of its targets, which draw until then.
TEST_F(LifetimeTest, AContextMayBeDestroyedBeforeItsTargets) {
  const VitrailVkContextDesc contextDesc = backend().contextDesc();
  VitrailVkContext context = nullptr;
  ASSERT_EQ(vitrailVkCreateContext(&contextDesc, &context), VK_SUCCESS);
  Image image(backend().device(), {8, 8}, VK_FORMAT_R16G16B16A16_SFLOAT, VK_SAMPLE_COUNT_1_BIT,
              VK_IMAGE_USAGE_STORAGE_BIT);
  const VkImageView view = image.view();
  VitrailVkTargetDesc desc{};
  desc.extent = {8, 8};
  desc.nodeCapacity = 10;
  desc.views.count = 1;
  desc.views.color = &view;
  VitrailVkTarget first = nullptr;
  VitrailVkTarget second = nullptr;
  ASSERT_EQ(vitrailVkCreateTarget(context, &desc, &first), VK_SUCCESS);
  ASSERT_EQ(vitrailVkCreateTarget(context, &desc, &second), VK_SUCCESS);
  vitrailVkDestroyContext(context);
  expectOneLine("targets are left (2)");
  VitrailVkTarget third = nullptr;
  EXPECT_EQ(vitrailVkCreateTarget(context, &desc, &third), VK_ERROR_INITIALIZATION_FAILED);
  EXPECT_EQ(third, nullptr);
  expectOneLine("destroyed");
  vitrailVkDestroyTarget(first);

  Commands commands(backend().device());
  commands.run([&](VkCommandBuffer buffer) {
    vitrailVkCmdBegin(buffer, second, nullptr);
    vitrailVkCmdCollected(buffer, second);
    image.cmdUse(buffer, VK_IMAGE_LAYOUT_GENERAL,
                 {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                  VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT});
    vitrailVkCmdResolve(buffer, second, nullptr);
    vitrailVkCmdEnd(buffer, second);
  });
  VitrailStats stats{};
  EXPECT_EQ(vitrailVkReadStats(second, 0, &stats), VK_SUCCESS);
  EXPECT_EQ(stats.complete, 1U);
  vitrailVkDestroyTarget(second); // what is left of the context then is a validation error at the device's end
}

} // namespace
} // namespace vitrail::tests::vulkan
