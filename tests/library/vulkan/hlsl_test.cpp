// Vulkan hosts that write HLSL: collect.hlsl, as glslang compiles it to SPIR-V, fills the lists that collect.glsl does.
#include <gtest/gtest.h>

#include <algorithm>

#include "../expected.h"
#include "backend.h"
#include "point_host.h"

namespace vitrail::tests::vulkan {
namespace {

class HlslTest : public VulkanTest {
 protected:
  // Draws the points, into memory that holds nothing but guard words before.
  std::vector<std::uint32_t> nodesOf(HostDesc desc, ShaderKind shader, std::span<const Point> points,
                                     PointResult& result) {
    desc.shader = shader;
    VulkanHost host(backend(), desc);
    result = host.draw(points);
    EXPECT_TRUE(host.guardsUntouched());
    return host.words(&StorageLayout::nodes);
  }

  // Whether the device takes fragments in the order of the draws, so that each lies in the same place of the memory.
  static bool inOneOrder() {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(backend().device().physicalDevice(), &properties);
    return properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  }
};

// At one sample: glslang leaves out SV_Coverage.
TEST_F(HlslTest, FillsTheNodesThatGlslFills) {
  for (const VitrailNodeFormat format : {VITRAIL_NODE_STANDARD, VITRAIL_NODE_COMPACT, VITRAIL_NODE_HDR}) {
    for (const VitrailListBuild build : {VITRAIL_LIST_BUILD_FRAGMENT, VITRAIL_LIST_BUILD_COMPUTE}) {
      for (const bool words : {false, true}) {
        if (words && format != VITRAIL_NODE_HDR) continue;
        HostDesc desc;
        desc.nodes = format;
        desc.listBuild = build;
        desc.userWords = words;
        desc.guarded = true;
        desc.behind = {0.25F, 0.5F, 1.0F, 1.0F};
        const std::vector<Point> points = randomLists(desc, {0, 1, 2, 17, 40, 300}, 3);
        desc.capacity = static_cast<std::uint32_t>(points.size());
        PointResult glsl;
        PointResult hlsl;
        const auto nodes = nodesOf(desc, ShaderKind::Usual, points, glsl);
        const auto found = nodesOf(desc, ShaderKind::Hlsl, points, hlsl);
        // A GPU draws the points of a frame in an order of its own, each time another.
        if (inOneOrder()) {
          EXPECT_EQ(found, nodes) << format << ' ' << build << ' ' << words;
        }
        EXPECT_TRUE(hlsl.pixels == glsl.pixels);
        EXPECT_EQ(hlsl.stats.complete, 1U);
        EXPECT_EQ(hlsl.stats.fragmentsStored, points.size());
      }
    }
  }
}

// Where no fragment finds a node they are counted, and the sums that stand for them give the same picture.
TEST_F(HlslTest, CountsAndSumsWhatIsMissing) {
  HostDesc desc;
  desc.behind = {0.25F, 0.5F, 1.0F, 1.0F};
  desc.guarded = true;
  const std::vector<Point> points = randomLists(desc, {0, 1, 2, 17, 40}, 3);
  desc.capacity = 64;
  desc.requestedBefore = desc.capacity; // all nodes are gone
  std::vector<PointResult> results;
  for (const ShaderKind shader : {ShaderKind::Usual, ShaderKind::Hlsl}) {
    desc.shader = shader;
    VulkanHost host(backend(), desc);
    const PointResult& result = results.emplace_back(host.draw(points));
    EXPECT_EQ(result.stats.fragmentsRequested, desc.requestedBefore + points.size());
    EXPECT_EQ(result.stats.complete, 0U);
  }
  EXPECT_TRUE(results[0].pixels == results[1].pixels);
  EXPECT_TRUE(std::ranges::any_of(results[1].pixels, [&](const auto& pixel) { return pixel != desc.behind; }));
}

} // namespace
} // namespace vitrail::tests::vulkan
