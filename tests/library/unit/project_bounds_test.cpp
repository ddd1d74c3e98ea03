// Projected bounds: never too small, and not much too large.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "core/project_bounds.h"

namespace vitrail::tests {
namespace {

constexpr std::uint32_t kViewWidth = 200;
constexpr std::uint32_t kViewHeight = 100;

ClipBox box(const glm::vec3& min, const glm::vec3& max, const glm::mat4& clipFromBox) {
  ClipBox result;
  for (int i = 0; i < 3; ++i) {
    result.min[static_cast<std::size_t>(i)] = min[i];
    result.max[static_cast<std::size_t>(i)] = max[i];
  }
  std::copy_n(glm::value_ptr(clipFromBox), 16, result.clipFromBox.begin());
  return result;
}

Rectangle project(const ClipBox& one) { return projectBounds(std::span(&one, 1), kViewWidth, kViewHeight); }

glm::mat4 perspective() { return glm::perspectiveZO(0.5F * std::numbers::pi_v<float>, 2.0F, 0.1F, 100.0F); }

const Rectangle kEverything{0, 0, kViewWidth, kViewHeight};
const Rectangle kNothing{};

TEST(ProjectBounds, ABoxInClipSpaceByHand) {
  // x from -0.5 to 0: pixels 50 to 100; y from 0 to 0.5: 50 to 75; a pixel around them.
  EXPECT_EQ(project(box({-0.5F, 0.0F, 0.2F}, {0.0F, 0.5F, 0.4F}, glm::mat4(1.0F))), (Rectangle{48, 48, 54, 29}));
  EXPECT_EQ(project(box({-9.0F, -9.0F, 0.2F}, {9.0F, 9.0F, 0.4F}, glm::mat4(1.0F))), kEverything);
}

TEST(ProjectBounds, BoxesOutsideOfEveryPlaneReachNothing) {
  const glm::mat4 m = perspective();
  EXPECT_EQ(project(box({-50, -1, -9}, {-40, 1, -5}, m)), kNothing);
  EXPECT_EQ(project(box({40, -1, -9}, {50, 1, -5}, m)), kNothing);
  EXPECT_EQ(project(box({-1, -50, -9}, {1, -40, -5}, m)), kNothing);
  EXPECT_EQ(project(box({-1, 40, -9}, {1, 50, -5}, m)), kNothing);
  EXPECT_EQ(project(box({-1, -1, 5}, {1, 1, 9}, m)), kNothing);           // behind the eye
  EXPECT_EQ(project(box({-1, -1, -0.05F}, {1, 1, -0.01F}, m)), kNothing); // before the near plane
  EXPECT_EQ(project(box({-1, -1, -200}, {1, 1, -150}, m)), kNothing);     // beyond the far plane
}

TEST(ProjectBounds, BoxesThatReachTheEyeCoverEverything) {
  EXPECT_EQ(project(box({-1, -1, -5}, {1, 1, 5}, perspective())), kEverything);
  EXPECT_EQ(project(box({0.1F, 0.1F, -5}, {0.2F, 0.2F, 0.0F}, perspective())), kEverything);
}

TEST(ProjectBounds, WhatIsNotFiniteCoversEverything) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(project(box({-infinity, 0, -5}, {1, 1, -4}, perspective())), kEverything);
  EXPECT_EQ(project(box({0, 0, nan}, {1, 1, -4}, perspective())), kEverything);
  glm::mat4 broken = perspective();
  broken[1][2] = nan;
  EXPECT_EQ(project(box({0, 0, -5}, {1, 1, -4}, broken)), kEverything);
}

TEST(ProjectBounds, SeveralBoxesAreJoinedAndEmptyOnesLeftOut) {
  const glm::mat4 one(1.0F);
  const std::array boxes = {box({-0.5F, -0.5F, 0}, {-0.4F, -0.4F, 1}, one), box({0.4F, 0.4F, 0}, {0.5F, 0.5F, 1}, one),
                            box({1, 1, 1}, {-1, -1, -1}, one)};
  EXPECT_EQ(projectBounds(boxes, kViewWidth, kViewHeight), (Rectangle{48, 23, 104, 54}));
  EXPECT_EQ(projectBounds(std::span(boxes).last(1), kViewWidth, kViewHeight), kNothing);
  EXPECT_EQ(projectBounds({}, kViewWidth, kViewHeight), kNothing);
}

// Every visible point of random boxes lies inside, computed in single precision as a device would; and the rectangle of
// a box that is in view as a whole is no more than two pixels larger than its corners' on each side.
TEST(ProjectBounds, ContainsEveryPointOfRandomBoxes) {
  std::mt19937 random(11);
  const auto range = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random() >> 8U) / 16777216.0F;
  };
  for (int i = 0; i < 2000; ++i) {
    glm::mat4 m = glm::translate(perspective(), {range(-20, 20), range(-10, 10), range(-60, 5)});
    m = glm::rotate(m, range(0, 6), glm::vec3(range(-1, 1), range(-1, 1), 1.0F));
    const glm::vec3 low(range(-5, 0), range(-5, 0), range(-5, 0));
    const glm::vec3 high(range(0, 5), range(0, 5), range(0, 5));
    const Rectangle r = project(box(low, high, m));
    glm::vec2 least(1e9F);
    glm::vec2 most(-1e9F);
    bool inView = true;
    for (int k = 0; k < 200; ++k) {
      glm::vec3 at(range(low.x, high.x), range(low.y, high.y), range(low.z, high.z));
      if (k < 8) at = {(k & 1) != 0 ? low.x : high.x, (k & 2) != 0 ? low.y : high.y, (k & 4) != 0 ? low.z : high.z};
      const glm::vec4 clip = m * glm::vec4(at, 1.0F);
      const bool visible = clip.w > 0.0F && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w &&
                           clip.z >= 0.0F && clip.z <= clip.w;
      inView = inView && visible;
      if (!visible) continue;
      const glm::vec2 pixel = (glm::vec2(clip) / clip.w + 1.0F) * 0.5F * glm::vec2(kViewWidth, kViewHeight);
      ASSERT_TRUE(pixel.x >= static_cast<float>(r.x) && pixel.x <= static_cast<float>(r.x + r.width));
      ASSERT_TRUE(pixel.y >= static_cast<float>(r.y) && pixel.y <= static_cast<float>(r.y + r.height));
      least = glm::min(least, pixel);
      most = glm::max(most, pixel);
    }
    if (!inView) continue;
    EXPECT_LE(least.x - static_cast<float>(r.x), 2.01F);
    EXPECT_LE(static_cast<float>(r.x + r.width) - most.x, 2.01F);
    EXPECT_LE(least.y - static_cast<float>(r.y), 2.01F);
    EXPECT_LE(static_cast<float>(r.y + r.height) - most.y, 2.01F);
  }
}

} // namespace
} // namespace vitrail::tests
