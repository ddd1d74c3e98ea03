// The tests' own test: linked against a library that leaves out a barrier, synchronization validation must object. If
// it does not, no other test's silence means anything. Once without the barrier between collecting and the resolve,
// once, with VITRAIL_TEST_LIST_BUILD, without the one after the compute pass that builds lists.
#include <gtest/gtest.h>

#include "backend.h"
#include "point_host.h"

#ifndef VITRAIL_TEST_LIST_BUILD
#define VITRAIL_TEST_LIST_BUILD VITRAIL_LIST_BUILD_FRAGMENT
#endif

namespace vitrail::tests::vulkan {
namespace {

TEST(NegativeControl, AMissingBarrierIsCaught) {
  HostDesc desc;
  desc.capacity = 4;
  desc.listBuild = VITRAIL_TEST_LIST_BUILD;
  const Point point = {0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}};
  VulkanHost(backend(), desc).draw(std::span(&point, 1));
  const std::vector<std::string> errors = backend().takeErrors();
  ASSERT_FALSE(errors.empty()) << "synchronization validation does not see a missing barrier";
  EXPECT_NE(errors[0].find("SYNC-HAZARD-READ-AFTER-WRITE"), std::string::npos) << errors[0];
}

} // namespace
} // namespace vitrail::tests::vulkan
