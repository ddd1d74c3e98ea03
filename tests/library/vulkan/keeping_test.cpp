// Where pipelines are kept (tests/kept), that is below the validation layer, which sees all that hosts make and
// destroy.
#include <gtest/gtest.h>

#include "backend.h"
#include "point_pipelines.h"

namespace vitrail::tests::vulkan {
namespace {

class KeepingTest : public VulkanTest {};

// The layer gives each pipeline a handle of its own; what keeps them would give the same one twice.
TEST_F(KeepingTest, IsBelowTheValidationLayer) {
  PointPipelinesInfo info;
  info.set = backend().context(0).descriptorSetLayout();
  info.colorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  PointPipelines one(backend().device(), info);
  PointPipelines other(backend().device(), info);
  EXPECT_NE(one.points(1), other.points(1));
}

} // namespace
} // namespace vitrail::tests::vulkan
