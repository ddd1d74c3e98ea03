// Descriptions that the library refuses: the error, and a line in the log that names the field.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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
    Target target;
    EXPECT_EQ(Target::create(context(), desc, target), code) << word;
    EXPECT_FALSE(target) << word;
    expectOneLine(word);
  }

  // The same with a change to what would be right.
  template <typename Change>
  void expectRefused(const std::string& word, Change change) const {
    VitrailVkTargetDesc desc = desc_;
    change(desc);
    expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, word);
  }

  // Of a context that was told of no features.
  static Context& context() { return backend().context(0); }

  Image image_;
  VkImageView view_ = VK_NULL_HANDLE;
  VitrailVkTargetDesc desc_{};
};

TEST_F(RefusedTest, ContextsWithoutWhatTheyNeed) {
  VitrailVkContextDesc desc{};
  VitrailVkContext none = nullptr;
  EXPECT_EQ(vitrailVkCreateContext(&desc, &none), VK_ERROR_INITIALIZATION_FAILED);
  EXPECT_EQ(none, nullptr);
  desc = backend().contextDesc();
  desc.device = VK_NULL_HANDLE;
  EXPECT_EQ(vitrailVkCreateContext(&desc, &none), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("device");
  desc = backend().contextDesc();
  desc.features = 1U << 20U | VITRAIL_VK_FEATURE_DUAL_SRC_BLEND;
  EXPECT_EQ(vitrailVkCreateContext(&desc, &none), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("0x100000");
  desc = backend().contextDesc();
  desc.next = &desc;
  EXPECT_EQ(vitrailVkCreateContext(&desc, &none), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("next");
}

TEST_F(RefusedTest, WrongFields) {
  using Desc = VitrailVkTargetDesc;
  expectRefused("extent", [](Desc& desc) { desc.extent.width = 0; });
  expectRefused("samples", [](Desc& desc) { desc.samples = static_cast<VkSampleCountFlagBits>(3); });
  expectRefused("nodeFormat", [](Desc& desc) { desc.nodeFormat = static_cast<VitrailNodeFormat>(7); });
  expectRefused("depthOrder", [](Desc& desc) { desc.depthOrder = static_cast<VitrailDepthOrder>(2); });
  expectRefused("overflow", [](Desc& desc) { desc.overflow = static_cast<VitrailOverflow>(5); });
  expectRefused("listBuild", [](Desc& desc) { desc.listBuild = static_cast<VitrailListBuild>(4); });
  expectRefused("resolve", [](Desc& desc) { desc.resolve = static_cast<VitrailResolve>(9); });
  expectRefused("msaaResolve", [](Desc& desc) { desc.msaaResolve = static_cast<VitrailMsaaResolve>(2); });
  expectRefused("framesInFlight", [](Desc& desc) { desc.framesInFlight = VITRAIL_MAX_FRAMES_IN_FLIGHT + 1; });
  expectRefused("next", [](Desc& desc) { desc.next = &desc; });
  VitrailVkTargetDesc desc = desc_;
  desc.colorFormat = VK_FORMAT_B8G8R8A8_SRGB;
  expectRefused(desc, VK_ERROR_FORMAT_NOT_SUPPORTED, "colorFormat");
}

TEST_F(RefusedTest, ViewsThatAreMissing) {
  VitrailVkTargetDesc desc = desc_;
  desc.views.color = nullptr;
  desc.views.count = 0;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views.color");
  desc = desc_;
  desc.views.count = VITRAIL_MAX_VIEWS + 1;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views.count");
  const std::vector<std::uint32_t>& counts = backend().features().multisampled;
  if (counts.empty()) return;
  desc = desc_;
  desc.samples = static_cast<VkSampleCountFlagBits>(counts[0]);
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views.opaque");
  desc.views.opaque = &view_;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views.depth");
}

// Whichever resolve is the default: the host has said that there are views, and not how many.
TEST_F(RefusedTest, ViewsWithoutACount) {
  for (const VitrailResolve resolve : {VITRAIL_RESOLVE_DEFAULT, VITRAIL_RESOLVE_COMPUTE, VITRAIL_RESOLVE_FRAGMENT}) {
    VitrailVkTargetDesc desc = desc_;
    desc.resolve = resolve;
    desc.views.count = 0;
    expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views.count");
  }
}

TEST_F(RefusedTest, LayersBoundedWhereTheHostResolves) {
  VitrailVkTargetDesc desc = desc_;
  desc.resolve = VITRAIL_RESOLVE_HOST;
  Target target;
  EXPECT_EQ(Target::create(context(), desc, target), VK_SUCCESS);
  desc.maxLayers = 4;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "maxLayers");
}

TEST_F(RefusedTest, ViewsThatAreNullHandles) {
  const std::array<VkImageView, 3> views = {view_, view_, VK_NULL_HANDLE};
  VitrailVkTargetDesc desc = desc_;
  desc.views.color = views.data();
  desc.views.count = 2;
  Target target;
  EXPECT_EQ(Target::create(context(), desc, target), VK_SUCCESS);
  desc.views.count = 3;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views.color[2]");
  VitrailVkResizeInfo resize{};
  resize.extent = {32, 32};
  resize.views = desc.views;
  EXPECT_EQ(target.resize(resize), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("views.color[2]");
  desc = desc_;
  desc.views.depth = views.data() + 2;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "views.depth[0]");
}

TEST_F(RefusedTest, FormatsOfTheScopeThatAreOfAnotherKind) {
  VitrailVkTargetDesc desc = desc_;
  desc.views = {};
  desc.resolve = VITRAIL_RESOLVE_FRAGMENT;
  desc.scope.depthFormat = VK_FORMAT_R8G8B8A8_UNORM;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "depthFormat");
  desc.scope.depthFormat = VK_FORMAT_UNDEFINED;
  desc.scope.stencilFormat = VK_FORMAT_D32_SFLOAT;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "stencilFormat");
  desc.scope.stencilFormat = VK_FORMAT_UNDEFINED;
  desc.scope.stencilMark = VK_TRUE;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "stencilFormat");
}

TEST_F(RefusedTest, NeitherCapacityNorBudget) {
  VitrailVkTargetDesc desc = desc_;
  desc.nodeCapacity = 0;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "nodeCapacity");
  VitrailVkRequirements needs{};
  EXPECT_EQ(context().targetRequirements(desc, needs), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("nodeCapacity");
}

TEST_F(RefusedTest, BuffersOfTheHostThatDoNotServe) {
  VitrailVkTargetDesc desc = desc_;
  VitrailVkRequirements needs{};
  ASSERT_EQ(context().targetRequirements(desc, needs), VK_SUCCESS);
  const Buffer buffer(backend().device(), needs.size + needs.alignment, needs.usage, Memory::Device);
  desc.buffer = buffer.get();
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "bufferSize");
  desc.bufferSize = needs.size - 1;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "bufferSize");
  desc.bufferSize = needs.size;
  desc.bufferOffset = 4;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "bufferOffset");
  desc.bufferOffset = 0;
  desc.memoryBudget = 64 << 20;
  expectRefused(desc, VK_ERROR_INITIALIZATION_FAILED, "memoryBudget");
  desc.memoryBudget = 0;
  desc.bufferOffset = needs.alignment;
  Target target;
  ASSERT_EQ(Target::create(context(), desc, target), VK_SUCCESS);
  VitrailVkResizeInfo resize{};
  resize.extent = {32, 32};
  resize.views = desc.views;
  EXPECT_EQ(target.resize(resize), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("host's memory");
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

// Compute where it can be had, else a draw; the target tells which.
TEST_F(RefusedTest, TheDefaultResolveFollowsTheFields) {
  VitrailVkTargetDesc desc = desc_;
  desc.resolve = VITRAIL_RESOLVE_DEFAULT;
  EXPECT_EQ(context().defaultResolve(desc), VITRAIL_RESOLVE_COMPUTE);
  Target target;
  ASSERT_EQ(Target::create(context(), desc, target), VK_SUCCESS);
  EXPECT_EQ(target.resolveKind(), VITRAIL_RESOLVE_COMPUTE);
  desc.views = {};
  EXPECT_EQ(context().defaultResolve(desc), VITRAIL_RESOLVE_FRAGMENT);
  ASSERT_EQ(Target::create(context(), desc, target), VK_SUCCESS);
  EXPECT_EQ(target.resolveKind(), VITRAIL_RESOLVE_FRAGMENT);
  desc = desc_;
  desc.resolve = VITRAIL_RESOLVE_DEFAULT;
  desc.samples = VK_SAMPLE_COUNT_4_BIT;
  desc.msaaResolve = VITRAIL_MSAA_RESOLVE_PER_SAMPLE;
  EXPECT_EQ(context().defaultResolve(desc), VITRAIL_RESOLVE_FRAGMENT);
}

} // namespace
} // namespace vitrail::tests::vulkan
