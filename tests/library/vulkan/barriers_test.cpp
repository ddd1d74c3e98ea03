// The barriers of a frame, as a host with a render graph asks for them.
#include <gtest/gtest.h>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::vulkan {
namespace {

class BarriersTest : public VulkanTest {};

TEST_F(BarriersTest, AsDataNameTheTargetsBuffers) {
  HostDesc desc = squareHost();
  desc.capacity = 10;
  VulkanHost host(backend(), desc);
  for (const VitrailVkBarrierPoint point :
       {VITRAIL_VK_BARRIER_BEGIN, VITRAIL_VK_BARRIER_COLLECT, VITRAIL_VK_BARRIER_COLLECTED, VITRAIL_VK_BARRIER_RESOLVE,
        VITRAIL_VK_BARRIER_END}) {
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

} // namespace
} // namespace vitrail::tests::vulkan
