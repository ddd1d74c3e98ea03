// Who builds the lists where the host leaves it to the library.
#include <gtest/gtest.h>

#include <vitrail/vitrail.hpp>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::vulkan {
namespace {

class ListBuildTest : public VulkanTest {};

// The default is told, and stays what it is, also where another target would be made otherwise.
TEST_F(ListBuildTest, TheDefaultIsToldAndStays) {
  HostDesc desc;
  desc.width = 16;
  desc.height = 8;
  desc.listBuild = VITRAIL_LIST_BUILD_DEFAULT;
  desc.specialized = true;
  const std::vector<Point> points = randomLists(desc, {0, 1, 5, 20, 3}, 7);
  desc.capacity = static_cast<std::uint32_t>(points.size());
  VulkanHost host(backend(), desc);
  const PointResult first = host.draw(points);

  VitrailVkTargetDesc described{};
  described.extent = {desc.width, desc.height};
  const VitrailListBuild listBuild = host.context().defaultListBuild(described);
  EXPECT_EQ(host.target().listBuild(), listBuild);
  described.extent = {4096, 4097};
  EXPECT_EQ(host.context().defaultListBuild(described), VITRAIL_LIST_BUILD_FRAGMENT);
  if (listBuild != VITRAIL_LIST_BUILD_COMPUTE) return;
  VitrailVkResizeInfo resize{};
  resize.extent = described.extent;
  EXPECT_EQ(host.target().resize(resize), VK_ERROR_INITIALIZATION_FAILED);
  expectOneLine("VITRAIL_LIST_BUILD_FRAGMENT");
  const PointResult second = host.draw(points);
  EXPECT_TRUE(second.pixels == first.pixels);
  EXPECT_EQ(second.stats.complete, 1U);
}

} // namespace
} // namespace vitrail::tests::vulkan
