// Null arguments: errors where a call returns one, zero where it returns something else, nothing where it returns
// nothing. What was to be filled in is zeroed.
#include <gtest/gtest.h>

#include <vector>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::opengl {
namespace {

constexpr VitrailResult kRefused = VITRAIL_ERROR_INVALID;

class NullTest : public OpenGlTest {
 protected:
  // Where the context is known its log has a line; nobody else can be told.
  static void expectLogged() { expectOneLine("null"); }
};

TEST_F(NullTest, Contexts) {
  VitrailGlContextDesc desc = backend().contextDesc();
  EXPECT_EQ(vitrailGlCreateContext(&desc, nullptr), kRefused);
  expectLogged();
  auto context = reinterpret_cast<VitrailGlContext>(&desc);
  EXPECT_EQ(vitrailGlCreateContext(nullptr, &context), kRefused);
  EXPECT_EQ(context, nullptr);
  vitrailGlDestroyContext(nullptr);

  VitrailGlTargetDesc target{};
  EXPECT_EQ(vitrailGlDefaultResolve(nullptr, &target), VITRAIL_RESOLVE_DEFAULT);
  EXPECT_EQ(vitrailGlDefaultListBuild(nullptr, &target), VITRAIL_LIST_BUILD_DEFAULT);
  EXPECT_STREQ(vitrailGlCollectSource(nullptr), "");
  EXPECT_STREQ(vitrailGlListSource(nullptr), "");
  EXPECT_EQ(vitrailGlMaxNodeCapacity(nullptr, VITRAIL_NODE_STANDARD, 1), 0U);
  VitrailTileLimits limits{};
  limits.nodeCapacity = 7;
  EXPECT_EQ(vitrailGlTileLimits(nullptr, VITRAIL_NODE_STANDARD, 1, &limits), kRefused);
  EXPECT_EQ(limits.nodeCapacity, 0U);

  VitrailGlContext made = backend().context();
  EXPECT_EQ(vitrailGlDefaultResolve(made, nullptr), VITRAIL_RESOLVE_DEFAULT);
  expectLogged();
  EXPECT_EQ(vitrailGlDefaultListBuild(made, nullptr), VITRAIL_LIST_BUILD_DEFAULT);
  expectLogged();
  EXPECT_EQ(vitrailGlTileLimits(made, VITRAIL_NODE_STANDARD, 1, nullptr), kRefused);
  expectLogged();
}

TEST_F(NullTest, MakingTargets) {
  VitrailGlContext context = backend().context();
  VitrailGlTargetDesc desc{};
  EXPECT_EQ(vitrailGlCreateTarget(context, &desc, nullptr), kRefused);
  expectLogged();
  auto target = reinterpret_cast<VitrailGlTarget>(&desc);
  EXPECT_EQ(vitrailGlCreateTarget(context, nullptr, &target), kRefused);
  expectLogged();
  EXPECT_EQ(target, nullptr);
  EXPECT_EQ(vitrailGlCreateTarget(nullptr, &desc, &target), kRefused);
  vitrailGlDestroyTarget(nullptr);

  VitrailGlRequirements needs{};
  needs.size = 7;
  EXPECT_EQ(vitrailGlTargetRequirements(nullptr, &desc, &needs), kRefused);
  EXPECT_EQ(needs.size, 0U);
  EXPECT_EQ(vitrailGlTargetRequirements(context, nullptr, &needs), kRefused);
  expectLogged();
  EXPECT_EQ(vitrailGlTargetRequirements(context, &desc, nullptr), kRefused);
  expectLogged();

  VitrailGlSpecialization specialization{};
  specialization.defines[0] = 'x';
  vitrailGlCollectSpecialization(nullptr, &desc, &specialization);
  EXPECT_STREQ(specialization.defines, "");
  vitrailGlCollectSpecialization(context, nullptr, &specialization);
  expectLogged();
  vitrailGlCollectSpecialization(context, &desc, nullptr);
  expectLogged();
  vitrailGlTilePlanTarget(nullptr, &desc);
}

TEST_F(NullTest, TargetsThatAreNone) {
  EXPECT_EQ(vitrailGlTargetResolve(nullptr), VITRAIL_RESOLVE_DEFAULT);
  EXPECT_EQ(vitrailGlTargetListBuild(nullptr), VITRAIL_LIST_BUILD_DEFAULT);
  EXPECT_EQ(vitrailGlTargetFrame(nullptr), 0U);
  EXPECT_EQ(vitrailGlUpdateTarget(nullptr, 0), kRefused);
  const VitrailGlResizeInfo resize{};
  EXPECT_EQ(vitrailGlResizeTarget(nullptr, &resize), kRefused);
  VitrailMemory memory{};
  memory.totalBytes = 7;
  vitrailGlTargetMemory(nullptr, &memory);
  EXPECT_EQ(memory.totalBytes, 0U);
  EXPECT_EQ(vitrailGlBarriers(nullptr, VITRAIL_GL_BARRIER_BEGIN), 0U);
  VitrailStats stats{};
  stats.complete = 1;
  EXPECT_EQ(vitrailGlReadStats(nullptr, 0, &stats), kRefused);
  EXPECT_EQ(stats.complete, 0U);
  EXPECT_EQ(vitrailGlCopySize(nullptr, 1, 1), 0U);
  vitrailGlBegin(nullptr, nullptr);
  vitrailGlBind(nullptr);
  vitrailGlCollected(nullptr);
  vitrailGlResolve(nullptr, nullptr);
  vitrailGlCopyLists(nullptr, nullptr);
  vitrailGlEnd(nullptr);
}

TEST_F(NullTest, WhatTargetsAreAsked) {
  HostDesc desc;
  desc.capacity = 4;
  OpenGlHost host(backend(), desc);
  EXPECT_EQ(vitrailGlResizeTarget(host.target(), nullptr), kRefused);
  expectLogged();
  EXPECT_EQ(vitrailGlReadStats(host.target(), 0, nullptr), kRefused);
  expectLogged();
  vitrailGlTargetMemory(host.target(), nullptr);
  expectLogged();
  vitrailGlBegin(host.target(), nullptr);
  vitrailGlCollected(host.target());
  vitrailGlCopyLists(host.target(), nullptr);
  expectLogged();
}

} // namespace
} // namespace vitrail::tests::opengl
