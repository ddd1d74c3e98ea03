// Where the library's memory comes from and how it follows what frames need: budgets, resizing in flight, pools reached
// by address, tiles, and the descriptions that it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "gpu_fixture.h"
#include "point_reference.h"

namespace vitrail::tests {
namespace {

constexpr VkDeviceSize kMebibyte = 1 << 20;

class MemoryTest : public tool::test::GpuTest {};

// A picture of 64x64 pixels with lists of random lengths.
std::vector<Point> manyLists(const PointHostDesc& desc, std::uint32_t longest, unsigned seed) {
  std::vector<std::uint32_t> lengths(std::size_t{desc.width} * desc.height);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    lengths[i] = static_cast<std::uint32_t>((i * 2654435761U >> 7U) % (longest + 1));
  }
  return randomLists(desc, lengths, seed);
}

PointHostDesc squareHost() {
  PointHostDesc desc;
  desc.width = 64;
  desc.height = 64;
  desc.behind = {0.2F, 0.5F, 0.8F, 1.0F};
  return desc;
}

TEST_F(MemoryTest, ThePoolGrowsTowardsItsBudgetUntilFramesAreExact) {
  for (const VitrailOverflow overflow : {VITRAIL_OVERFLOW_APPROXIMATE, VITRAIL_OVERFLOW_SKIP}) {
    PointHostDesc desc = squareHost();
    desc.memoryBudget = 2 * kMebibyte;
    desc.capacity = 1000;
    desc.overflow = overflow;
    PointHost host(gpu(), desc);
    const std::vector<Point> points = manyLists(desc, 20, 1);
    const std::vector<Point> more = manyLists(desc, 40, 2);
    for (const std::vector<Point>* scene : {&points, &more}) {
      const Expected expected = expectedFrame(desc, *scene);
      EXPECT_EQ(host.draw(*scene).stats.exact, 0U);
      PointResult result;
      for (int frame = 0; frame < 3; ++frame) result = host.draw(*scene);
      EXPECT_EQ(result.stats.exact, 1U);
      EXPECT_EQ(result.stats.fragmentsStored, scene->size());
      EXPECT_LT(largestError(result.pixels, expected.pixels), kTolerance);
      for (int frame = 0; frame < 3; ++frame) host.draw({}); // old pools are let go
      EXPECT_LE(host.target().memory().totalBytes, desc.memoryBudget);
    }
  }
}

// A host reads a frame's statistics when it records the one that takes over its slot, and that one has a larger pool.
TEST_F(MemoryTest, StatisticsKnowThePoolOfTheirFrame) {
  PointHostDesc desc = squareHost();
  desc.memoryBudget = 2 * kMebibyte;
  desc.capacity = 1000;
  PointHost host(gpu(), desc);
  const std::vector<Point> points = manyLists(desc, 20, 1);
  const VitrailStats drawn = host.draw(points).stats; // frame 0 of slot 0
  EXPECT_GT(drawn.fragmentsMissing, 0U);
  EXPECT_EQ(host.draw(points).stats.exact, 1U);
  host.drop(points); // frame 2 of slot 0, as far as the host has recorded
  VitrailStats stats{};
  ASSERT_EQ(host.target().readStats(0, stats), VK_SUCCESS);
  EXPECT_EQ(stats.nodeCapacity, 1000U);
  EXPECT_EQ(stats.fragmentsStored, 1000U);
  EXPECT_EQ(stats.fragmentsMissing, drawn.fragmentsMissing);
  EXPECT_EQ(stats.exact, 0U);
}

TEST_F(MemoryTest, AFrameBeyondTheBudgetStaysApproximateAndStill) {
  PointHostDesc desc = squareHost();
  desc.memoryBudget = kMebibyte / 2;
  PointHost host(gpu(), desc);
  const std::vector<Point> points = manyLists(desc, 60, 3);
  for (int frame = 0; frame < 3; ++frame) host.draw(points);
  const PointResult settled = host.draw(points);
  EXPECT_EQ(settled.stats.exact, 0U);
  EXPECT_EQ(settled.stats.fragmentsRequested, points.size());
  EXPECT_TRUE(host.draw(ordered(points, Order::Shuffled)).pixels == settled.pixels);
  EXPECT_LE(host.target().memory().totalBytes, desc.memoryBudget);
}

TEST_F(MemoryTest, ThePoolShrinksWhenLittleIsNeededForLong) {
  PointHostDesc desc = squareHost();
  desc.memoryBudget = 4 * kMebibyte;
  desc.capacity = 200000;
  PointHost host(gpu(), desc);
  const std::vector<Point> few = manyLists(desc, 2, 4);
  const std::uint32_t large = host.target().memory().nodeCapacity;
  EXPECT_EQ(large, 200000U);
  for (int frame = 0; frame < 115; ++frame) host.draw({few.data(), 100});
  EXPECT_EQ(host.target().memory().nodeCapacity, large);
  for (int frame = 0; frame < 15; ++frame) host.draw({few.data(), 100});
  EXPECT_LT(host.target().memory().nodeCapacity, large / 10);
  const PointResult result = host.draw({few.data(), 100});
  EXPECT_EQ(result.stats.exact, 1U);
  EXPECT_LT(largestError(result.pixels, expectedFrame(desc, {few.data(), 100}).pixels), kTolerance);
}

// The first frame is recorded but not submitted when the target gets another size; both are submitted at once.
TEST_F(MemoryTest, ATargetIsResizedWhileFramesAreInFlight) {
  std::vector<std::uint32_t> counts = sampleCounts(gpu());
  counts.insert(counts.begin(), 1);
  for (const std::uint32_t samples : counts) {
    for (const Way& way : everyWay(gpu(), samples)) {
      if (way.stencilMark) continue;
      SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name);
      PointHostDesc desc = squareHost();
      desc.samples = samples;
      apply(way, desc);
      PointHostDesc resized = desc;
      desc.memoryBudget = 8 * kMebibyte;
      PointHost host(gpu(), desc);
      std::vector<Point> before = manyLists(desc, 6, 5);
      host.draw(before); // the pool is large enough afterwards
      host.draw(before);
      for (const VkExtent2D extent : {VkExtent2D{100, 30}, VkExtent2D{20, 70}}) {
        resized.width = extent.width;
        resized.height = extent.height;
        const std::vector<Point> after = manyLists(resized, 7, 6);
        const auto [first, second] = host.drawAcrossResize(before, extent, after);
        EXPECT_LT(largestError(first.pixels, expectedFrame(desc, before).pixels), kTolerance);
        EXPECT_EQ(second.stats.exact, 1U);
        EXPECT_LT(largestError(second.pixels, expectedFrame(resized, after).pixels), kTolerance);
        before = after;
        desc.width = extent.width;
        desc.height = extent.height;
      }
      EXPECT_LT(largestError(host.draw(before).pixels, expectedFrame(resized, before).pixels), kTolerance);
    }
  }
}

TEST_F(MemoryTest, PoolsAreReachedByAddressToo) {
  if (!gpu().features().bufferDeviceAddress) GTEST_SKIP() << "this device has no buffer addresses";
  std::vector<std::uint32_t> counts = sampleCounts(gpu());
  counts.insert(counts.begin(), 1);
  for (const std::uint32_t samples : counts) {
    for (const Way& way : everyWay(gpu(), samples)) {
      for (const VitrailNodeFormat format : nodeFormats(samples)) {
        if (way.stencilMark ||
            (format != VITRAIL_NODE_STANDARD && (samples > 1 || way.resolve != VITRAIL_RESOLVE_COMPUTE))) {
          continue;
        }
        SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name + ", format " + std::to_string(format));
        PointHostDesc desc;
        desc.addresses = true;
        desc.samples = samples;
        desc.nodes = format;
        apply(way, desc);
        const std::vector<Point> points = randomLists(desc, {0, 1, 5, 16, 17, 33, 100}, 9);
        desc.capacity = static_cast<std::uint32_t>(points.size());
        PointHost host(gpu(), desc);
        const PointResult result = host.draw(points);
        EXPECT_LT(largestError(result.pixels, expectedFrame(desc, points).pixels), kTolerance);
        EXPECT_EQ(result.stats.exact, 1U);
        desc.capacity -= 10; // beyond the pool's end is nobody's
        EXPECT_EQ(PointHost(gpu(), desc).draw(points).stats.fragmentsMissing, 10U);
      }
    }
  }
}

// Draws in the tiles of a plan. Counts the tiles that were drawn, in vain or not.
std::vector<FloatColor> drawTiles(tool::Gpu& gpu, PointHostDesc desc, VitrailTilePlanDesc planDesc,
                                  std::span<const Point> points, std::size_t& attempts) {
  planDesc.extent = {desc.width, desc.height};
  planDesc.nodeFormat = desc.nodes;
  planDesc.samples = static_cast<VkSampleCountFlagBits>(desc.samples);
  TilePlan plan;
  const Context& context = sharedContext(gpu, 0);
  EXPECT_EQ(TilePlan::create(context, planDesc, plan), VK_SUCCESS);
  VitrailVkTargetDesc target{};
  plan.prepare(target);
  desc.capacity = target.nodeCapacity;
  desc.areaPixels = target.areaPixels;
  desc.overflow = target.overflow;
  PointHost host(gpu, desc);
  EXPECT_LE(host.target().memory().nodeBytes + host.target().memory().headBytes, planDesc.memoryBudget);
  const PointResult result = host.drawAreas(points, [&](const VitrailStats* last, VkRect2D& area) {
    if (last != nullptr) {
      ++attempts;
      EXPECT_EQ(plan.finish(*last), VK_SUCCESS);
    }
    return plan.next(area);
  });
  return result.pixels;
}

TEST_F(MemoryTest, EveryBudgetGivesTheSameBits) {
  std::vector<std::uint32_t> counts = sampleCounts(gpu());
  counts.insert(counts.begin(), 1);
  for (const std::uint32_t samples : counts) {
    for (const Way& way : everyWay(gpu(), samples)) {
      if (samples > 1 && way.stencilMark) continue;
      SCOPED_TRACE(std::to_string(samples) + " samples, " + way.name);
      PointHostDesc desc = squareHost();
      desc.samples = samples;
      apply(way, desc);
      const std::vector<Point> points = manyLists(desc, 20, 7);
      desc.capacity = static_cast<std::uint32_t>(points.size());
      const std::vector<FloatColor> whole = PointHost(gpu(), desc).draw(points).pixels;
      std::size_t attempts = 0;
      for (const VkDeviceSize budget : {VkDeviceSize{64 << 10}, kMebibyte / 4, kMebibyte, 4 * kMebibyte}) {
        VitrailTilePlanDesc plan{};
        plan.memoryBudget = budget;
        attempts = 0;
        EXPECT_TRUE(drawTiles(gpu(), desc, plan, points, attempts) == whole) << budget << " bytes";
        if (way.resolve == VITRAIL_RESOLVE_FRAGMENT && budget == 64 << 10) break; // one budget shows it
      }
      EXPECT_TRUE(way.resolve == VITRAIL_RESOLVE_FRAGMENT || attempts == 1) << "the last budget holds it all";
    }
  }
}

// Only the rectangle around the bounds is drawn, and a known count saves drawing in vain.
TEST_F(MemoryTest, BoundsAndCountsMakeFewerTiles) {
  PointHostDesc desc = squareHost();
  std::vector<Point> points = manyLists(desc, 50, 8);
  std::erase_if(points, [](const Point& p) { return p.x < 20 || p.x >= 40 || p.y < 10 || p.y >= 50; });
  desc.capacity = static_cast<std::uint32_t>(points.size());
  const std::vector<FloatColor> whole = PointHost(gpu(), desc).draw(points).pixels;
  VitrailBounds bounds{};
  bounds.min[0] = 20.0F / 32.0F - 1.0F;
  bounds.max[0] = 40.0F / 32.0F - 1.0F;
  bounds.min[1] = 10.0F / 32.0F - 1.0F;
  bounds.max[1] = 50.0F / 32.0F - 1.0F;
  bounds.max[2] = 1.0F;
  for (int i = 0; i < 4; ++i) bounds.clipFromBox[5 * i] = 1.0F;
  VkRect2D area{};
  vitrailProjectBounds(1, &bounds, {64, 64}, &area);
  EXPECT_EQ(area.offset.x, 18);
  EXPECT_EQ(area.offset.y, 8);
  EXPECT_EQ(area.extent.width, 24U);
  EXPECT_EQ(area.extent.height, 44U);
  VitrailTilePlanDesc plan{};
  plan.memoryBudget = 64 << 10;
  plan.boundsCount = 1;
  plan.bounds = &bounds;
  std::size_t unknown = 0;
  EXPECT_TRUE(drawTiles(gpu(), desc, plan, points, unknown) == whole);
  plan.expectedFragments = points.size();
  std::size_t known = 0;
  EXPECT_TRUE(drawTiles(gpu(), desc, plan, points, known) == whole);
  EXPECT_LT(known, unknown);
  EXPECT_GT(known, 1U);
}

TEST_F(MemoryTest, APixelThatFitsNoBudgetIsAnErrorWithTheBytes) {
  std::string reason;
  VitrailVkContextDesc contextDesc{};
  contextDesc.instance = gpu().instance();
  contextDesc.physicalDevice = gpu().physicalDevice();
  contextDesc.device = gpu().device();
  contextDesc.getInstanceProcAddr = vkGetInstanceProcAddr;
  contextDesc.log = [](VitrailLogSeverity, const char* message, void* user) {
    *static_cast<std::string*>(user) = message;
  };
  contextDesc.logUser = &reason;
  Context context;
  ASSERT_EQ(Context::create(contextDesc, context), VK_SUCCESS);
  VitrailTilePlanDesc desc{};
  desc.memoryBudget = 64 << 10;
  TilePlan plan;
  EXPECT_EQ(TilePlan::create(context, desc, plan), VK_ERROR_INITIALIZATION_FAILED);
  desc.extent = {1, 1};
  desc.memoryBudget = 1000;
  EXPECT_EQ(TilePlan::create(context, desc, plan), VK_ERROR_OUT_OF_DEVICE_MEMORY);
  desc.memoryBudget = 64 << 10;
  ASSERT_EQ(TilePlan::create(context, desc, plan), VK_SUCCESS);
  VkRect2D tile{};
  ASSERT_TRUE(plan.next(tile));
  VitrailStats stats{};
  stats.nodeCapacity = 4000;
  stats.fragmentsRequested = 100000;
  stats.fragmentsStored = 4000;
  stats.fragmentsMissing = 96000;
  EXPECT_EQ(plan.finish(stats), VK_ERROR_OUT_OF_DEVICE_MEMORY);
  EXPECT_NE(reason.find("100000"), std::string::npos) << reason;
}

TEST_F(MemoryTest, RequirementsAndReportsAgree) {
  PointHostDesc desc = squareHost();
  desc.capacity = 1000;
  const VitrailMemory memory = PointHost(gpu(), desc).target().memory();
  EXPECT_EQ(memory.nodeCapacity, 1000U);
  EXPECT_EQ(memory.nodeBytes, vitrailNodePoolSize(VITRAIL_NODE_STANDARD, 1000));
  EXPECT_EQ(memory.headBytes, 4U * 64 * 64);
  EXPECT_EQ(memory.totalBytes, memory.nodeBytes + memory.headBytes + memory.otherBytes);
  desc.overflow = VITRAIL_OVERFLOW_SKIP;
  const VitrailMemory less = PointHost(gpu(), desc).target().memory();
  EXPECT_NEAR(static_cast<double>(memory.totalBytes - less.totalBytes), 20.0 * 64 * 64, 512.0); // but for alignment
}

TEST_F(MemoryTest, BarriersAsDataNameTheTargetsBuffers) {
  PointHostDesc desc = squareHost();
  desc.capacity = 10;
  const PointHost host(gpu(), desc);
  for (const VitrailVkBarrierPoint point :
       {VITRAIL_VK_BARRIER_BEFORE_CLEAR, VITRAIL_VK_BARRIER_BEFORE_COLLECT, VITRAIL_VK_BARRIER_COLLECTED}) {
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
}

class RefusedTest : public MemoryTest {
 protected:
  void SetUp() override {
    VitrailVkContextDesc desc{};
    desc.instance = gpu().instance();
    desc.physicalDevice = gpu().physicalDevice();
    desc.device = gpu().device();
    desc.getInstanceProcAddr = vkGetInstanceProcAddr;
    desc.log = [](VitrailLogSeverity, const char* message, void* user) { *static_cast<std::string*>(user) = message; };
    desc.logUser = &reason_;
    ASSERT_EQ(Context::create(desc, context_), VK_SUCCESS);
    desc_.extent = {64, 64};
    desc_.resolve = VITRAIL_RESOLVE_COMPUTE;
    desc_.views.count = 1;
    desc_.views.color = &view_; // never reached
  }

  void expectRefused(const VitrailVkTargetDesc& desc, VkResult code, const char* word) {
    reason_.clear();
    Target target;
    EXPECT_EQ(Target::create(context_, desc, target), code) << word;
    EXPECT_FALSE(target) << word;
    EXPECT_NE(reason_.find(word), std::string::npos) << "the log says: " << reason_;
  }

  std::string reason_;
  Context context_;
  VkImageView view_ = VK_NULL_HANDLE;
  VitrailVkTargetDesc desc_{};
};

TEST_F(RefusedTest, ContextsWithoutWhatTheyNeed) {
  VitrailVkContextDesc desc{};
  VitrailVkContext none = nullptr;
  EXPECT_EQ(vitrailVkCreateContext(&desc, &none), VK_ERROR_INITIALIZATION_FAILED);
  EXPECT_EQ(none, nullptr);
}

TEST_F(RefusedTest, WrongFields) {
  VitrailVkTargetDesc desc = desc_;
  desc.extent.width = 0;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "extent");
  desc = desc_;
  desc.samples = static_cast<VkSampleCountFlagBits>(3);
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "samples");
  desc = desc_;
  desc.nodeFormat = static_cast<VitrailNodeFormat>(7);
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "nodeFormat");
  desc = desc_;
  desc.depthOrder = static_cast<VitrailDepthOrder>(2);
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "depthOrder");
  desc = desc_;
  desc.overflow = static_cast<VitrailOverflow>(5);
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "overflow");
  desc = desc_;
  desc.listBuild = static_cast<VitrailListBuild>(4);
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "linking");
  desc = desc_;
  desc.resolve = static_cast<VitrailResolve>(9);
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "resolve");
  desc = desc_;
  desc.framesInFlight = VITRAIL_MAX_FRAMES_IN_FLIGHT + 1;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "framesInFlight");
  desc = desc_;
  desc.colorFormat = VK_FORMAT_B8G8R8A8_SRGB;
  expectRefused(desc, VK_ERROR_FORMAT_NOT_SUPPORTED, "colorFormat");
}

TEST_F(RefusedTest, ViewsThatAreMissing) {
  VitrailVkTargetDesc desc = desc_;
  desc.views.count = 0;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views.color");
  desc.views.count = VITRAIL_MAX_VIEWS + 1;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views");
  const std::vector<std::uint32_t> counts = sampleCounts(gpu());
  if (counts.empty()) return;
  desc = desc_;
  desc.samples = static_cast<VkSampleCountFlagBits>(counts[0]);
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views.opaque");
  desc.views.opaque = &view_;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views.depth");
}

TEST_F(RefusedTest, WhatTheDeviceOrTheContextDoesNotOffer) {
  VitrailVkTargetDesc desc = desc_;
  for (const std::uint32_t samples : {2U, 4U, 8U}) {
    if ((gpu().features().sampleCounts & samples) != 0) continue;
    desc.samples = static_cast<VkSampleCountFlagBits>(samples);
    expectRefused(desc, VK_ERROR_FEATURE_NOT_PRESENT, "samples");
  }
  const std::vector<std::uint32_t> counts = sampleCounts(gpu());
  if (counts.empty()) return;
  desc = desc_;
  desc.samples = static_cast<VkSampleCountFlagBits>(counts.back());
  desc.msaaResolve = VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  expectRefused(desc, VK_ERROR_FEATURE_NOT_PRESENT, "per sample");
  desc.resolve = VITRAIL_RESOLVE_FRAGMENT; // the context was not told of sampleRateShading
  expectRefused(desc, VK_ERROR_FEATURE_NOT_PRESENT, "sampleRateShading");
  if (counts.back() != 8) return;
  desc = desc_;
  desc.samples = VK_SAMPLE_COUNT_8_BIT;
  desc.nodeFormat = VITRAIL_NODE_COMPACT;
  expectRefused(desc, VK_ERROR_FORMAT_NOT_SUPPORTED, "compact");
}

TEST_F(RefusedTest, MemoryThatIsNotThere) {
  const std::uint32_t most = context_.maxNodeCapacity(VITRAIL_NODE_STANDARD);
  VitrailVkTargetDesc desc = desc_;
  if (most < std::numeric_limits<std::uint32_t>::max() - 1) {
    desc.nodeCapacity = most + 1;
    expectRefused(desc, VK_ERROR_OUT_OF_DEVICE_MEMORY, "nodeCapacity");
  }
  desc = desc_;
  desc.memoryBudget = 10000;
  expectRefused(desc, VK_ERROR_OUT_OF_DEVICE_MEMORY, "memoryBudget");
  EXPECT_LE(context_.maxNodeCapacity(VITRAIL_NODE_COMPACT), (1U << 24U) - 2);
  EXPECT_LE(context_.maxNodeCapacity(VITRAIL_NODE_HDR, VK_SAMPLE_COUNT_8_BIT), (1U << 24U) - 2);
}

// A node has 24 bits for its pixel until it is linked.
TEST_F(RefusedTest, AreasThatAreTooLargeToLinkByCompute) {
  VitrailVkTargetDesc desc = desc_;
  desc.listBuild = VITRAIL_LIST_BUILD_COMPUTE;
  desc.overflow = VITRAIL_OVERFLOW_SKIP;
  desc.nodeCapacity = 1;
  desc.extent = {4096, 4097};
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "VITRAIL_LIST_BUILD_FRAGMENT");
  VitrailVkRequirements requirements{};
  EXPECT_NE(context_.targetRequirements(desc, requirements), VK_SUCCESS);
  for (const std::uint32_t areaPixels : {0U, 1000000U}) {
    desc.extent.height = areaPixels == 0 ? 4096 : 4097;
    desc.areaPixels = areaPixels;
    EXPECT_EQ(context_.targetRequirements(desc, requirements), VK_SUCCESS);
  }
  desc.areaPixels = 0;
  desc.extent.height = 4097;
  EXPECT_EQ(context_.defaultListBuild(desc), VITRAIL_LIST_BUILD_FRAGMENT);
  desc.listBuild = VITRAIL_LIST_BUILD_DEFAULT;
  EXPECT_EQ(context_.targetRequirements(desc, requirements), VK_SUCCESS);
}

// Compute where it can be had, else a draw.
TEST_F(RefusedTest, TheDefaultResolveFollowsTheFields) {
  VitrailVkTargetDesc desc = desc_;
  desc.resolve = VITRAIL_RESOLVE_DEFAULT;
  EXPECT_EQ(context_.defaultResolve(desc), VITRAIL_RESOLVE_COMPUTE);
  desc.views.color = nullptr;
  EXPECT_EQ(context_.defaultResolve(desc), VITRAIL_RESOLVE_FRAGMENT);
  desc = desc_;
  desc.resolve = VITRAIL_RESOLVE_DEFAULT;
  desc.samples = VK_SAMPLE_COUNT_4_BIT;
  desc.msaaResolve = VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  EXPECT_EQ(context_.defaultResolve(desc), VITRAIL_RESOLVE_FRAGMENT);
}

} // namespace
} // namespace vitrail::tests
