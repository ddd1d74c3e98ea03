// Descriptions that the library refuses: the error, and a line in the log that names the field.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <vitrail/vitrail.hpp>

#include "backend.h"
#include "objects.h"

namespace vitrail::tests::vulkan {
namespace {

class RefusedTest : public VulkanTest {
 protected:
  void SetUp() override {
    image_ = Image(backend().device(), {64, 64}, VK_FORMAT_R16G16B16A16_SFLOAT, VK_SAMPLE_COUNT_1_BIT,
                   VK_IMAGE_USAGE_STORAGE_BIT);
    view_ = image_.view();
    desc_.extent = {64, 64};
    desc_.resolve = VITRAIL_RESOLVE_COMPUTE;
    desc_.nodeCapacity = 1000;
    desc_.views.count = 1;
    desc_.views.color = &view_;
  }

  // Refused with that code and one line that has that word.
  static void expectRefused(const VitrailVkTargetDesc& desc, VkResult code, const std::string& word) {
    vitrail::vulkan::Target target;
    EXPECT_EQ(vitrail::vulkan::Target::create(context(), desc, target), code) << word;
    EXPECT_FALSE(target) << word;
    expectOneLine(word);
  }

  // Of a context that was told of no features.
  static vitrail::vulkan::Context& context() { return backend().context(0); }

  Image image_;
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
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "listBuild");
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
  const std::vector<std::uint32_t> counts = backend().features().multisampled;
  if (counts.empty()) return;
  desc = desc_;
  desc.samples = static_cast<VkSampleCountFlagBits>(counts[0]);
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views.opaque");
  desc.views.opaque = &view_;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views.depth");
}

TEST_F(RefusedTest, WhatTheDeviceOrTheContextDoesNotOffer) {
  VitrailVkTargetDesc desc = desc_;
  const std::vector<std::uint32_t>& counts = backend().features().multisampled;
  for (const std::uint32_t samples : {2U, 4U, 8U}) {
    if (std::find(counts.begin(), counts.end(), samples) != counts.end()) continue;
    desc.samples = static_cast<VkSampleCountFlagBits>(samples);
    expectRefused(desc, VK_ERROR_FEATURE_NOT_PRESENT, "samples");
  }
  if (counts.empty()) return;
  desc = desc_;
  desc.samples = static_cast<VkSampleCountFlagBits>(counts.back());
  desc.msaaResolve = VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  expectRefused(desc, VK_ERROR_FEATURE_NOT_PRESENT, "per sample");
  desc.resolve = VITRAIL_RESOLVE_FRAGMENT; // the context was not told of sampleRateShading
  expectRefused(desc, VK_ERROR_FEATURE_NOT_PRESENT, "sample shading");
  if (counts.back() != 8) return;
  desc = desc_;
  desc.samples = VK_SAMPLE_COUNT_8_BIT;
  desc.nodeFormat = VITRAIL_NODE_COMPACT;
  expectRefused(desc, VK_ERROR_FORMAT_NOT_SUPPORTED, "compact");
}

TEST_F(RefusedTest, MemoryThatIsNotThere) {
  const std::uint32_t most = context().maxNodeCapacity(VITRAIL_NODE_STANDARD);
  VitrailVkTargetDesc desc = desc_;
  if (most < std::numeric_limits<std::uint32_t>::max() - 1) {
    desc.nodeCapacity = most + 1;
    expectRefused(desc, VK_ERROR_OUT_OF_DEVICE_MEMORY, "nodeCapacity");
  }
  desc = desc_;
  desc.memoryBudget = 10000;
  expectRefused(desc, VK_ERROR_OUT_OF_DEVICE_MEMORY, "memoryBudget");
  EXPECT_LE(context().maxNodeCapacity(VITRAIL_NODE_COMPACT), (1U << 24U) - 2);
  EXPECT_LE(context().maxNodeCapacity(VITRAIL_NODE_HDR, VK_SAMPLE_COUNT_8_BIT), (1U << 24U) - 2);
}

// A loose node has 24 bits for its pixel.
TEST_F(RefusedTest, AreasThatAreTooLargeForListsBuiltByCompute) {
  VitrailVkTargetDesc desc = desc_;
  desc.listBuild = VITRAIL_LIST_BUILD_COMPUTE;
  desc.overflow = VITRAIL_OVERFLOW_SKIP;
  desc.nodeCapacity = 1;
  desc.extent = {4096, 4097};
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "VITRAIL_LIST_BUILD_FRAGMENT");
  VitrailVkRequirements requirements{};
  EXPECT_NE(context().targetRequirements(desc, requirements), VK_SUCCESS);
  expectOneLine("VITRAIL_LIST_BUILD_FRAGMENT");
  for (const std::uint32_t areaPixels : {0U, 1000000U}) {
    desc.extent.height = areaPixels == 0 ? 4096 : 4097;
    desc.areaPixels = areaPixels;
    EXPECT_EQ(context().targetRequirements(desc, requirements), VK_SUCCESS);
  }
  desc.areaPixels = 0;
  desc.extent.height = 4097;
  EXPECT_EQ(context().defaultListBuild(desc), VITRAIL_LIST_BUILD_FRAGMENT);
  desc.listBuild = VITRAIL_LIST_BUILD_DEFAULT;
  EXPECT_EQ(context().targetRequirements(desc, requirements), VK_SUCCESS);
}

// Compute where it can be had, else a draw.
TEST_F(RefusedTest, TheDefaultResolveFollowsTheFields) {
  VitrailVkTargetDesc desc = desc_;
  desc.resolve = VITRAIL_RESOLVE_DEFAULT;
  EXPECT_EQ(context().defaultResolve(desc), VITRAIL_RESOLVE_COMPUTE);
  desc.views.color = nullptr;
  EXPECT_EQ(context().defaultResolve(desc), VITRAIL_RESOLVE_FRAGMENT);
  desc = desc_;
  desc.resolve = VITRAIL_RESOLVE_DEFAULT;
  desc.samples = VK_SAMPLE_COUNT_4_BIT;
  desc.msaaResolve = VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  EXPECT_EQ(context().defaultResolve(desc), VITRAIL_RESOLVE_FRAGMENT);
}

TEST_F(RefusedTest, APixelThatFitsNoBudgetIsAnErrorWithTheBytes) {
  VitrailTilePlanDesc desc{};
  desc.memoryBudget = 64 << 10;
  TilePlan plan;
  EXPECT_EQ(backend().planTiles(desc, plan), VITRAIL_ERROR_INVALID);
  expectOneLine("extent");
  desc.width = 1;
  desc.height = 1;
  desc.memoryBudget = 1000;
  EXPECT_EQ(backend().planTiles(desc, plan), VITRAIL_ERROR_OUT_OF_MEMORY);
  expectOneLine("memoryBudget");
  desc.memoryBudget = 64 << 10;
  ASSERT_EQ(backend().planTiles(desc, plan), VITRAIL_SUCCESS);
  VitrailRect tile{};
  ASSERT_TRUE(plan.next(tile));
  VitrailStats stats{};
  stats.nodeCapacity = 4000;
  stats.fragmentsRequested = 100000;
  stats.fragmentsStored = 4000;
  stats.fragmentsMissing = 96000;
  EXPECT_EQ(plan.finish(stats), VITRAIL_ERROR_OUT_OF_MEMORY);
  expectOneLine("100000");
}

} // namespace
} // namespace vitrail::tests::vulkan
