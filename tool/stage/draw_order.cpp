#include "draw_order.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

namespace vitrail::tool {

std::vector<std::uint32_t> submissionOrder(std::uint32_t count, DrawOrder order, std::uint64_t salt) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0U);
  if (order == DrawOrder::Reversed) std::reverse(numbers.begin(), numbers.end());
  if (order == DrawOrder::Shuffled) {
    // std::shuffle's result is the library's choice; the generator's numbers are the standard's.
    std::mt19937_64 random(salt);
    for (std::size_t i = count; i > 1; --i) std::swap(numbers[i - 1], numbers[random() % i]);
  }
  return numbers;
}

std::vector<std::uint32_t> reorderTriangles(const std::vector<std::uint32_t>& indices, DrawOrder order,
                                            std::uint64_t salt) {
  const auto triangles = static_cast<std::uint32_t>(indices.size() / 3);
  std::vector<std::uint32_t> result;
  result.reserve(indices.size());
  for (const std::uint32_t triangle : submissionOrder(triangles, order, salt)) {
    const std::size_t first = std::size_t{triangle} * 3;
    result.insert(result.end(), {indices[first], indices[first + 1], indices[first + 2]});
  }
  return result;
}

} // namespace vitrail::tool
