// Nodes that HLSL makes (shaders/vitrail/node.hlsl and so on) equal those that GLSL makes of the same fragments, byte
// for byte: both run on one device, by Direct3D and by Vulkan, HLSL (as glslang compiles it) by Vulkan, too. So do the
// sums of fragments without a node, which also equal those of the kernels for Direct3D: GLSL that SPIRV-Cross has
// translated.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "bytecode/pack.h"
#include "bytecode/pack_cross_compiled.h"
#include "core/pool.h"
#include "run.h"
#include "shaders/pack.h"
#include "shaders/pack_hlsl.h"
#include "vulkan_compute.h"

namespace vitrail::tests::direct3d {
namespace {

constexpr std::uint32_t kWords = 18; // of a packed fragment
constexpr std::uint32_t kFirstSum = 12;
constexpr std::uint32_t kFlags = 17;
using Packed = std::array<std::uint32_t, kWords>;

// What both shaders read: words as they are laid out there.
struct PackInput {
  std::array<std::uint32_t, 4> kind{}; // format, samples, whether the nearest is one, fragments
  std::vector<std::array<std::uint32_t, 8>> fragments;

  void add(std::array<float, 4> color, float depth, std::uint32_t blend, std::uint32_t coverage) {
    std::array<std::uint32_t, 8> words{};
    for (std::size_t i = 0; i < 4; ++i) words[i] = std::bit_cast<std::uint32_t>(color[i]);
    words[4] = std::bit_cast<std::uint32_t>(depth);
    words[5] = blend;
    words[6] = coverage;
    fragments.push_back(words);
    kind[3] = static_cast<std::uint32_t>(fragments.size());
  }
  [[nodiscard]] std::vector<std::uint32_t> words() const {
    std::vector<std::uint32_t> all(kind.begin(), kind.end());
    for (const auto& fragment : fragments) all.insert(all.end(), fragment.begin(), fragment.end());
    return all;
  }
};

// Values where rounding and clamping are decided: none, one, halves of steps, the ends of the curve's line, the largest
// half, what is not a number.
std::vector<float> specialValues() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<float> values = {0.0F,
                               -0.0F,
                               1.0F,
                               -1.0F,
                               2.0F,
                               0.0031308F,
                               0.04045F,
                               65504.0F,
                               65520.0F,
                               1e-20F,
                               1e-40F,
                               6.1e-5F,
                               5.9e-8F,
                               1e20F,
                               kInfinity,
                               -kInfinity,
                               0.5F,
                               0.25F,
                               16.0F,
                               4.66e-10F,
                               std::numeric_limits<float>::quiet_NaN(),
                               std::nextafterf(1.0F, 0.0F)};
  for (const float steps : {31.0F, 63.0F, 255.0F}) {
    for (int i = 0; i < 8; ++i) values.push_back((static_cast<float>(i) + 0.5F) / steps);
  }
  return values;
}

PackInput everyFragment(std::uint32_t format, std::uint32_t samples, bool nearestIsOne) {
  PackInput input;
  input.kind = {format, samples, nearestIsOne ? 1U : 0U, 0};
  std::mt19937 random(format * 16 + samples);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  const auto coverage = [&] { return 1U + static_cast<std::uint32_t>(random()) % ((1U << samples) - 1U); };
  const std::vector<float> special = specialValues();
  for (const float a : special) {
    for (const float b : special) {
      for (std::uint32_t blend = 0; blend < 4; ++blend) input.add({a, b, unit(random), a}, b, blend, coverage());
    }
  }
  for (int i = 0; i < 100000; ++i) {
    const float scale = i % 3 == 0 ? 20.0F : 1.0F;
    const float depth = i % 2 == 0 ? unit(random) : 1.0F - unit(random) * 1e-4F;
    input.add({unit(random) * scale, unit(random) * unit(random), unit(random), unit(random)}, depth,
              static_cast<std::uint32_t>(i) % 4U, coverage());
  }
  return input;
}

Packed packedAt(const std::vector<std::byte>& bytes, std::size_t fragment) {
  Packed words{};
  std::memcpy(words.data(), bytes.data() + fragment * sizeof(words), sizeof(words));
  return words;
}

std::string describe(const std::array<std::uint32_t, 8>& words) {
  std::string text;
  for (std::size_t i = 0; i < 5; ++i) text += std::to_string(std::bit_cast<float>(words[i])) + " ";
  return text + "blend " + std::to_string(words[5]) + " coverage " + std::to_string(words[6]);
}

// The fragments of which some words differ, the first few of them in words.
std::size_t countDiffering(const PackInput& input, const std::vector<std::byte>& hlsl,
                           const std::vector<std::byte>& other, bool sums) {
  std::size_t differing = 0;
  for (std::size_t i = 0; i < input.fragments.size(); ++i) {
    const Packed a = packedAt(hlsl, i);
    const Packed b = packedAt(other, i);
    bool differs = false;
    for (std::uint32_t w = 0; w < kWords; ++w) {
      if ((w >= kFirstSum && w < kFlags) != sums || a[w] == b[w]) continue;
      differs = true;
      EXPECT_GE(differing, 3U) << "word " << w << " is " << a[w] << " and " << b[w] << ": "
                               << describe(input.fragments[i]);
    }
    differing += differs ? 1 : 0;
  }
  return differing;
}

class NodesOfBothLanguages : public ::testing::TestWithParam<std::uint32_t> {};
std::string nameOf(const ::testing::TestParamInfo<std::uint32_t>& format) {
  return std::array{"Standard", "Compact", "Hdr"}.at(format.param);
}
INSTANTIATE_TEST_SUITE_P(, NodesOfBothLanguages, ::testing::Values(0U, 1U, 2U), nameOf);

TEST_P(NodesOfBothLanguages, AreTheSameBytes) {
  for (const std::uint32_t samples : {1U, 2U, 4U, 8U}) {
    if (maxNodeIndexCount(GetParam(), samples) == 0) continue;
    for (const bool nearestIsOne : {false, true}) {
      SCOPED_TRACE(std::to_string(samples) + " samples, nearest is " + (nearestIsOne ? "one" : "zero"));
      const PackInput input = everyFragment(GetParam(), samples, nearestIsOne);
      const std::size_t bytes = input.fragments.size() * sizeof(Packed);
      const auto groups = static_cast<std::uint32_t>((input.fragments.size() + 63) / 64);
      const std::vector<std::byte> hlsl = runByDirect3d(bytecode::pack, input.words(), bytes, groups);
      const std::vector<std::byte> glsl = runByVulkan(shaders::pack, input.words(), bytes, groups);
      const std::vector<std::byte> kernel = runByDirect3d(bytecode::pack_cross_compiled, input.words(), bytes, groups);
      EXPECT_EQ(countDiffering(input, hlsl, glsl, false), 0U) << "nodes";
      const std::vector<std::byte> onVulkan = runByVulkan(shaders::pack_hlsl, input.words(), bytes, groups);
      EXPECT_EQ(countDiffering(input, onVulkan, glsl, false), 0U) << "nodes of HLSL on Vulkan";
      EXPECT_EQ(countDiffering(input, hlsl, kernel, true), 0U) << "sums of the kernels";
      EXPECT_EQ(countDiffering(input, hlsl, glsl, true), 0U) << "sums";
      EXPECT_EQ(countDiffering(input, onVulkan, glsl, true), 0U) << "sums of HLSL on Vulkan";
      std::set<std::uint32_t> nodes; // are not all one
      for (std::size_t i = 0; i < input.fragments.size(); ++i) nodes.insert(packedAt(hlsl, i)[0]);
      EXPECT_GT(nodes.size(), 10000U);
    }
  }
}

} // namespace
} // namespace vitrail::tests::direct3d
