// Random numbers that are the same on every machine: the engines of <random> are portable, its distributions are not.
// PCG32 (M. E. O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random Number
// Generation", 2014), the XSH RR variant with 64 bits of state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

namespace vitrail::tool {

class Random {
 public:
  // Generators of one seed and different streams are independent of each other.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0) : increment_((stream << 1U) | 1U) {
    next();
    state_ += seed;
    next();
  }

  // 32 random bits.
  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + increment_;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto turn = static_cast<std::uint32_t>(old >> 59U);
    return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
  }

  // In [0, 1), a multiple of 2^-24: exact in a float.
  float uniform() { return static_cast<float>(next() >> 8U) * 0x1p-24F; }

  // In [low, high), or high itself where the product rounds up to it.
  float range(float low, float high) { return low + (high - low) * uniform(); }

  // In [0, bound), for a bound above 0. The bias is below bound / 2^32.
  std::uint32_t below(std::uint32_t bound) {
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(next()) * bound) >> 32U);
  }

  // In the cube [-1, 1)^3. The statements fix the order of the draws, which function arguments would not.
  glm::vec3 inCube() {
    const float x = range(-1.0F, 1.0F);
    const float y = range(-1.0F, 1.0F);
    const float z = range(-1.0F, 1.0F);
    return {x, y, z};
  }

  // In the unit ball.
  glm::vec3 inBall() {
    glm::vec3 point = inCube();
    while (glm::dot(point, point) > 1.0F) point = inCube();
    return point;
  }

  // On the unit sphere.
  glm::vec3 direction() {
    glm::vec3 point = inBall();
    while (glm::dot(point, point) < 1e-4F) point = inBall();
    return glm::normalize(point);
  }

  // Fisher-Yates.
  template <typename T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) {
      std::swap(items[i - 1], items[below(static_cast<std::uint32_t>(i))]);
    }
  }

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

} // namespace vitrail::tool
