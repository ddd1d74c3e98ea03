#include "short_count.h"

#include <fmt/format.h>

namespace vitrail::tool {

std::string shortCount(std::uint64_t count) {
  const auto value = static_cast<double>(count);
  if (count >= 999'500) return fmt::format("{:.1f} M", value / 1e6);
  if (count >= 1'000) return fmt::format("{:.{}f} k", value / 1e3, count < 9'950 ? 1 : 0);
  return fmt::format("{}", count);
}

} // namespace vitrail::tool
