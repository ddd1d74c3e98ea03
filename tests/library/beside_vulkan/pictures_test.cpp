// Pictures of Direct3D are those of Vulkan: the same points, drawn by both on one device.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "library/backend.h"
#include "library/expected.h"

namespace vitrail::tests {
namespace {

// The program has two backends.
Backend& backendOf(bool vulkan) {
  const auto found =
      std::ranges::find_if(backends(), [&](const Backend* one) { return (one->name() == "vulkan") == vulkan; });
  if (found == backends().end()) throw HostError("a backend is missing");
  return **found;
}

long encoded(float linear) {
  const float value = std::clamp(linear, 0.0F, 1.0F);
  return std::lround(255 * (value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1 / 2.4F) - 0.055F));
}

struct Apart {
  std::size_t encoded = 0; // values that differ as sRGB of 8 bits
  std::size_t bits = 0;    // that differ at all
  float most = 0.0F;
};

Apart compare(const PointResult& a, const PointResult& b) {
  Apart apart;
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      const float x = a.pixels[i][c];
      const float y = b.pixels[i][c];
      if (encoded(x) != encoded(y)) ++apart.encoded;
      if (std::bit_cast<std::uint32_t>(x) != std::bit_cast<std::uint32_t>(y)) ++apart.bits;
      apart.most = std::max(apart.most, std::abs(x - y));
    }
  }
  return apart;
}

// What frames differ in besides: of `part` fragments in a hundred there is room for, the others are summed.
struct Frame {
  std::string name;
  std::uint32_t maxLayers = 0;
  std::size_t part = 100;
};

class PicturesBesideVulkan : public ::testing::TestWithParam<Frame> {};
INSTANTIATE_TEST_SUITE_P(, PicturesBesideVulkan,
                         ::testing::Values(Frame{"Whole"}, Frame{"Capped", 5}, Frame{"Overflowed", 0, 60}),
                         [](const auto& one) { return one.param.name; });

TEST_P(PicturesBesideVulkan, AreTheSameBits) {
  const Frame& frame = GetParam();
  Backend& direct3d = backendOf(false);
  Backend& vulkan = backendOf(true);
  for (const std::uint32_t samples : {1U, 4U}) {
    for (const VitrailNodeFormat format : {VITRAIL_NODE_STANDARD, VITRAIL_NODE_COMPACT, VITRAIL_NODE_HDR}) {
      if (format == VITRAIL_NODE_COMPACT && samples > 1) continue; // has no room for them
      for (const Way& way : everyWay(direct3d.features(), samples)) {
        SCOPED_TRACE(way.name + ", " + std::to_string(samples) + " samples, format " + std::to_string(format));
        HostDesc desc;
        desc.width = 16;
        desc.height = 16;
        desc.samples = samples;
        desc.nodes = format;
        desc.maxLayers = frame.maxLayers;
        desc.behind = {0.25F, 0.5F, 1.0F, 0.75F};
        apply(way, desc);
        std::vector<std::uint32_t> lengths;
        for (std::uint32_t i = 0; i < desc.width * desc.height; ++i) lengths.push_back(i % 100 == 99 ? 300 : i % 40);
        PointVariety variety;
        variety.blendModes = true;
        variety.coverage = samples > 1;
        if (format == VITRAIL_NODE_HDR) variety.brightest = 4.0F;
        const std::vector<Point> points = randomLists(desc, lengths, 5, variety);
        desc.capacity = static_cast<std::uint32_t>(points.size() * frame.part / 100);
        const PointResult ours = direct3d.makeHost(desc)->draw(points);
        const Apart apart = compare(ours, vulkan.makeHost(desc)->draw(points));
        EXPECT_EQ(ours.stats.complete, frame.part < 100 || frame.maxLayers != 0 ? 0U : 1U);
        EXPECT_EQ(apart.encoded, 0U);
        // libvkd3d 1.2 drops `precise`, and Mesa then reorders the sum of samples that have one transmittance
        // (docs/notes/direct3d.md).
        const bool reordered =
            direct3d.name() == "d3d12" && samples > 1 && frame.part < 100 && way.resolve == VITRAIL_RESOLVE_COMPUTE;
        if (reordered) {
          EXPECT_LT(apart.most, 4e-6F);
        } else {
          EXPECT_EQ(apart.bits, 0U) << "of " << 4 * ours.pixels.size() << ", up to " << apart.most;
        }
      }
    }
  }
}

} // namespace
} // namespace vitrail::tests
