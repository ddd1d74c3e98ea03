// Sizes of the buffers behind a target, and the limits that bound them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "vitrail/layout.h"

namespace vitrail {

inline constexpr std::uint64_t kNodeBytes = sizeof(layout::VitrailNode);
inline constexpr std::uint64_t kHeadBytes = sizeof(layout::uint);

// Bytes of a pool. A pool without nodes still has the room of one: a buffer cannot be empty.
constexpr std::uint64_t nodePoolBytes(std::uint32_t capacity) {
  return std::max<std::uint64_t>(capacity, 1) * kNodeBytes;
}

// Bytes of the head pointers of an image.
constexpr std::uint64_t headBytes(std::uint32_t width, std::uint32_t height) {
  return std::uint64_t{width} * height * kHeadBytes;
}

// The most nodes that fit in `bytes`, leaving out the index that ends a list.
constexpr std::uint32_t nodesThatFit(std::uint64_t bytes) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(bytes / kNodeBytes, layout::VITRAIL_END - 1));
}

// Bytes of the list of pixels with more fragments than the resolve sorts in registers, of which a pool of `capacity`
// nodes makes only so many.
constexpr std::uint64_t longListBytes(std::uint32_t width, std::uint32_t height, std::uint32_t capacity) {
  return std::max<std::uint64_t>(
             1, std::min<std::uint64_t>(capacity / (layout::VITRAIL_BLOCK + 1), std::uint64_t{width} * height)) *
         4;
}

} // namespace vitrail
