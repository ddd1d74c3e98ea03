// The pictures of the program that measures Direct3D 11: the ways to draw them agree, and edges between triangles do
// not show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "host.h"

namespace vitrail::tests::figures {
namespace {

Settings small(Method method, std::uint32_t samples) {
  Settings settings;
  settings.width = 320;
  settings.height = 180;
  settings.method = method;
  settings.samples = samples;
  settings.layers = method == Method::Insertion ? 32 : 0; // more than a pixel has
  return settings;
}

std::vector<std::uint8_t> drawn(const Settings& settings) {
  Host host(settings);
  host.draw();
  return host.picture();
}

// The share of the values that are further apart than `most`, of 255.
double shareApart(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b, int most) {
  EXPECT_EQ(a.size(), b.size());
  std::size_t apart = 0;
  for (std::size_t i = 0; i < a.size(); ++i) apart += std::abs(a[i] - b[i]) > most ? 1 : 0;
  return static_cast<double>(apart) / static_cast<double>(a.size());
}

// Nodes round, to halves: a step or two are let pass.
TEST(Figures, AreTheSameBySortingAsByTheLibrary) {
  for (const std::uint32_t samples : sampleCounts()) {
    const auto insertion = drawn(small(Method::Insertion, samples));
    const auto fragment = drawn(small(Method::Fragment, samples));
    const auto compute = drawn(small(Method::Compute, samples));
    EXPECT_LE(shareApart(fragment, compute, 1), 0.0) << samples;
    EXPECT_LT(shareApart(insertion, compute, 2), samples == 1 ? 0.001 : 0.01) << samples;
    EXPECT_GT(shareApart(drawn(small(Method::Unsorted, samples)), compute, 2), 0.05) << "nothing had to be sorted";
  }
}

// As the tool draws it with Vulkan: vitrail render --scene mannequins --size 320x180 --json says how many there are.
TEST(Figures, HaveTheFragmentsThatTheToolCounts) {
  Host host(small(Method::Compute, 1));
  host.draw();
  const VitrailStats stats = host.stats();
  EXPECT_EQ(stats.complete, 1U);
  EXPECT_EQ(stats.fragmentsRequested, 40472U);
  EXPECT_EQ(stats.layersMax, 18U);
}

// The colours of the pane's inside: pixels whose neighbours show it, too.
std::set<std::array<std::uint8_t, 3>> colorsInside(const Settings& settings) {
  const std::vector<std::uint8_t> bytes = drawn(settings);
  const auto at = [&](std::uint32_t x, std::uint32_t y) {
    const std::uint8_t* p = &bytes[3 * (std::size_t{y} * settings.width + x)];
    return std::array<std::uint8_t, 3>{p[0], p[1], p[2]};
  };
  constexpr std::array<std::uint8_t, 3> kBehind = {255, 255, 255};
  std::set<std::array<std::uint8_t, 3>> colors;
  for (std::uint32_t y = 1; y + 1 < settings.height; ++y) {
    for (std::uint32_t x = 1; x + 1 < settings.width; ++x) {
      bool inside = true; // pixels beside the outline are partly covered
      for (std::uint32_t i = 0; i < 9; ++i) inside = inside && at(x + i % 3 - 1, y + i / 3 - 1) != kBehind;
      if (inside) colors.insert(at(x, y));
    }
  }
  return colors;
}

// Where two triangles meet a pixel has a fragment of each, both of one depth: each counts for the samples that it
// covers, so that the sheet has one colour. (Were each counted for the whole pixel, the pixels along the edges would
// be covered twice.)
TEST(Figures, EdgesBetweenTrianglesDoNotShow) {
  for (const std::uint32_t samples : sampleCounts()) {
    for (const Method method : {Method::Fragment, Method::Compute}) {
      Settings settings = small(method, samples);
      settings.scene = "pane";
      EXPECT_EQ(colorsInside(settings).size(), 1U) << samples;
      settings.wholePixels = true;
      if (samples == 1) continue; // a triangle covers a pixel, or does not
      EXPECT_GT(colorsInside(settings).size(), 1U) << samples;
    }
  }
}

} // namespace
} // namespace vitrail::tests::figures
