// Null arguments: errors where a call returns one, zero where it returns something else, nothing where it returns
// nothing. What was to be filled in is zeroed.
#include <gtest/gtest.h>

#include <vitrail/vulkan.h>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::vulkan {
namespace {

constexpr VkResult kRefused = VK_ERROR_INITIALIZATION_FAILED;

class NullTest : public VulkanTest {
 protected:
  // Where the context is known its log has a line; nobody else can be told.
  static void expectLogged() { expectOneLine("null"); }
};

TEST_F(NullTest, Contexts) {
  VitrailVkContextDesc desc = backend().contextDesc();
  EXPECT_EQ(vitrailVkCreateContext(&desc, nullptr), kRefused);
  expectLogged();
  auto context = reinterpret_cast<VitrailVkContext>(&desc);
  EXPECT_EQ(vitrailVkCreateContext(nullptr, &context), kRefused);
  EXPECT_EQ(context, nullptr);
  vitrailVkDestroyContext(nullptr);

  VitrailVkTargetDesc target{};
  EXPECT_EQ(vitrailVkDefaultResolve(nullptr, &target), VITRAIL_RESOLVE_DEFAULT);
  EXPECT_EQ(vitrailVkDefaultListBuild(nullptr, &target), VITRAIL_LIST_BUILD_DEFAULT);
  EXPECT_EQ(vitrailVkDescriptorSetLayout(nullptr), VkDescriptorSetLayout{});
  EXPECT_EQ(vitrailVkMaxNodeCapacity(nullptr, VITRAIL_NODE_STANDARD, VK_SAMPLE_COUNT_1_BIT), 0U);
  VitrailTileLimits limits{};
  limits.nodeCapacity = 7;
  EXPECT_EQ(vitrailVkTileLimits(nullptr, VITRAIL_NODE_STANDARD, VK_SAMPLE_COUNT_1_BIT, &limits), kRefused);
  EXPECT_EQ(limits.nodeCapacity, 0U);

  VitrailVkContext made = backend().context(0).handle();
  EXPECT_EQ(vitrailVkDefaultResolve(made, nullptr), VITRAIL_RESOLVE_DEFAULT);
  expectLogged();
  EXPECT_EQ(vitrailVkDefaultListBuild(made, nullptr), VITRAIL_LIST_BUILD_DEFAULT);
  expectLogged();
  EXPECT_EQ(vitrailVkTileLimits(made, VITRAIL_NODE_STANDARD, VK_SAMPLE_COUNT_1_BIT, nullptr), kRefused);
  expectLogged();
}

TEST_F(NullTest, MakingTargets) {
  VitrailVkContext context = backend().context(0).handle();
  VitrailVkTargetDesc desc{};
  EXPECT_EQ(vitrailVkCreateTarget(context, &desc, nullptr), kRefused);
  expectLogged();
  auto target = reinterpret_cast<VitrailVkTarget>(&desc);
  EXPECT_EQ(vitrailVkCreateTarget(context, nullptr, &target), kRefused);
  expectLogged();
  EXPECT_EQ(target, nullptr);
  EXPECT_EQ(vitrailVkCreateTarget(nullptr, &desc, &target), kRefused);
  vitrailVkDestroyTarget(nullptr);

  VitrailVkRequirements needs{};
  needs.size = 7;
  EXPECT_EQ(vitrailVkTargetRequirements(nullptr, &desc, &needs), kRefused);
  EXPECT_EQ(needs.size, 0U);
  EXPECT_EQ(vitrailVkTargetRequirements(context, nullptr, &needs), kRefused);
  expectLogged();
  EXPECT_EQ(vitrailVkTargetRequirements(context, &desc, nullptr), kRefused);
  expectLogged();

  VitrailVkSpecialization specialization{};
  specialization.data[0] = 7;
  vitrailVkCollectSpecialization(nullptr, &desc, &specialization);
  EXPECT_EQ(specialization.data[0], 0U);
  vitrailVkCollectSpecialization(context, nullptr, &specialization);
  expectLogged();
  vitrailVkCollectSpecialization(context, &desc, nullptr);
  expectLogged();
  vitrailVkStencilMark(nullptr);
  vitrailVkTilePlanTarget(nullptr, &desc);
}

TEST_F(NullTest, TargetsThatAreNone) {
  EXPECT_EQ(vitrailVkTargetResolve(nullptr), VITRAIL_RESOLVE_DEFAULT);
  EXPECT_EQ(vitrailVkTargetListBuild(nullptr), VITRAIL_LIST_BUILD_DEFAULT);
  EXPECT_EQ(vitrailVkTargetDescriptorSet(nullptr), VkDescriptorSet{});
  EXPECT_EQ(vitrailVkTargetFrame(nullptr), 0U);
  EXPECT_EQ(vitrailVkUpdateTarget(nullptr, 0), kRefused);
  const VitrailVkResizeInfo resize{};
  EXPECT_EQ(vitrailVkResizeTarget(nullptr, &resize), kRefused);
  VitrailMemory memory{};
  memory.totalBytes = 7;
  vitrailVkTargetMemory(nullptr, &memory);
  EXPECT_EQ(memory.totalBytes, 0U);
  VitrailVkBarriers barriers{};
  barriers.count = 1;
  vitrailVkBarriers(nullptr, VITRAIL_VK_BARRIER_BEGIN, &barriers);
  EXPECT_EQ(barriers.count, 0U);
  VitrailStats stats{};
  stats.complete = 1;
  EXPECT_EQ(vitrailVkReadStats(nullptr, 0, &stats), kRefused);
  EXPECT_EQ(stats.complete, 0U);
  EXPECT_EQ(vitrailVkCopySize(nullptr, 1, 1), 0U);
}

TEST_F(NullTest, WhatTargetsAreAsked) {
  HostDesc desc;
  desc.capacity = 4;
  VulkanHost host(backend(), desc);
  VitrailVkTarget target = host.target().handle();
  EXPECT_EQ(vitrailVkResizeTarget(target, nullptr), kRefused);
  expectLogged();
  EXPECT_EQ(vitrailVkReadStats(target, 0, nullptr), kRefused);
  expectLogged();
  vitrailVkTargetMemory(target, nullptr);
  expectLogged();
  vitrailVkBarriers(target, VITRAIL_VK_BARRIER_BEGIN, nullptr);
  expectLogged();
}

// Nothing is recorded, and no frame is begun.
TEST_F(NullTest, Recording) {
  HostDesc desc;
  desc.capacity = 4;
  VulkanHost host(backend(), desc);
  VitrailVkTarget target = host.target().handle();
  Commands commands(backend().device());
  commands.run([&](VkCommandBuffer buffer) {
    vitrailVkCmdBegin(buffer, nullptr, nullptr);
    vitrailVkCmdCollected(buffer, nullptr);
    vitrailVkCmdResolve(buffer, nullptr, nullptr);
    vitrailVkCmdCopyLists(buffer, nullptr, nullptr);
    vitrailVkCmdEnd(buffer, nullptr);
    vitrailVkCmdBegin(VK_NULL_HANDLE, target, nullptr);
    expectLogged();
    vitrailVkCmdCollected(VK_NULL_HANDLE, target);
    expectLogged();
    vitrailVkCmdResolve(VK_NULL_HANDLE, target, nullptr);
    expectLogged();
    vitrailVkCmdCopyLists(VK_NULL_HANDLE, target, nullptr);
    expectLogged();
    vitrailVkCmdEnd(VK_NULL_HANDLE, target);
    expectLogged();
  });
  const std::vector<Point> points = randomLists(desc, {3}, 1);
  EXPECT_EQ(host.draw(points).stats.complete, 1U);
}

} // namespace
} // namespace vitrail::tests::vulkan
