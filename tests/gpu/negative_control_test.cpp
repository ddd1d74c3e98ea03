// The tests' own test: linked against a library that leaves out the collect-to-resolve barrier, synchronization
// validation must object. If it does not, no other test's silence means anything.
#include <gtest/gtest.h>

#include "point_host.h"

namespace vitrail::tests {
namespace {

TEST(NegativeControl, AMissingBarrierIsCaught) {
  tool::Gpu gpu({.device = "", .validate = true});
  {
    PointHostDesc desc;
    desc.capacity = 4;
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
