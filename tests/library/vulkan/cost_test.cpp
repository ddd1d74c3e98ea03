// What a frame costs that has nothing to draw: next to nothing, on every path.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::vulkan {
namespace {

class CostTest : public VulkanTest {};

double fastest(VulkanHost& host, std::span<const Point> points) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) least = std::min(least, host.seconds(points));
  return least;
}

// Beside a frame with one fragment, which has to look at every pixel. Where that is too fast to be told from the time
// of a submission, as on a GPU, there is nothing to compare.
TEST_F(CostTest, AnEmptyFrameCostsNextToNothing) {
  constexpr double kTold = 5e-3;
  for (const Way& way : everyWay(backend().features(), 1)) {
    SCOPED_TRACE(way.name);
    HostDesc desc;
    desc.width = 1920;
    desc.height = 1080;
    desc.capacity = 10;
    apply(way, desc);
    VulkanHost host(backend(), desc);
    const Point point = {3, 3, 0.5F, {1.0F, 1.0F, 1.0F, 0.5F}};
    const double one = fastest(host, std::span(&point, 1));
    const double none = fastest(host, {});
    RecordProperty(way.name + ": one fragment, ms", std::to_string(one * 1e3));
    RecordProperty(way.name + ": none, ms", std::to_string(none * 1e3));
    EXPECT_LT(none, one > kTold ? 0.5 * one : kTold);
  }
}

} // namespace
} // namespace vitrail::tests::vulkan
