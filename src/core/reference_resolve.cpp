#include "reference_resolve.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace vitrail {

Color resolveReference(std::span<const StoredFragment> fragments, const Color& behind, bool nearestIsOne) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> keys;
  keys.reserve(fragments.size());
  for (const StoredFragment& f : fragments) keys.emplace_back(depthKey(f.depth, nearestIsOne), f.color);
  std::sort(keys.begin(), keys.end());

  Color result{};
  double transmittance = 1.0;
  for (const auto& [depth, bits] : keys) {
    const Color c = unpackColor(bits);
    for (unsigned i = 0; i < 3; ++i) result[i] += transmittance * c[3] * c[i];
    transmittance *= 1.0 - c[3];
  }
  for (unsigned i = 0; i < 3; ++i) result[i] += transmittance * behind[i];
  result[3] = 1.0 - transmittance * (1.0 - behind[3]);
  return result;
}

} // namespace vitrail
