// The tests' own test: linked against a library that leaves out a barrier, synchronization validation must object. If
// it does not, no other test's silence means anything. Once without the barrier between collecting and the resolve,
// once, with VITRAIL_TEST_LINKING, without the one after the compute pass that links.
#include <gtest/gtest.h>

#include "point_host.h"

#ifndef VITRAIL_TEST_LINKING
#define VITRAIL_TEST_LINKING VITRAIL_LIST_BUILD_FRAGMENT
#endif

namespace vitrail::tests {
namespace {

TEST(NegativeControl, AMissingBarrierIsCaught) {
  tool::Gpu gpu({.device = "", .validate = true});
  {
    PointHostDesc desc;
    desc.capacity = 4;
    desc.listBuild = VITRAIL_TEST_LINKING;
    const Point point = {0, 0, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}};
    PointHost(gpu, desc).draw(std::span(&point, 1));
  }
  dropContexts();
  const std::vector<std::string> errors = gpu.validationErrors();
  ASSERT_FALSE(errors.empty()) << "synchronization validation does not see a missing barrier";
  EXPECT_NE(errors[0].find("SYNC-HAZARD-READ-AFTER-WRITE"), std::string::npos) << errors[0];
}

} // namespace
} // namespace vitrail::tests
