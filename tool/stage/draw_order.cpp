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

std::vector<std::uint32_t> reorderPrimitives(const Mesh& mesh, DrawOrder order, std::uint64_t salt) {
  const std::size_t corners = cornersOf(mesh.primitive);
  const auto count = static_cast<std::uint32_t>(mesh.indices.size() / corners);
  std::vector<std::uint32_t> result;
  result.reserve(mesh.indices.size());
  for (const std::uint32_t i : submissionOrder(count, order, salt)) {
    const auto first = mesh.indices.begin() + static_cast<std::ptrdiff_t>(i * corners);
    result.insert(result.end(), first, first + static_cast<std::ptrdiff_t>(corners));
  }
  return result;
}

} // namespace vitrail::tool
