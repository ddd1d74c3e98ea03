// Reads integers out of bytes, whatever this machine's byte order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace vitrail::tool {

// `size` bytes from `offset` on, up to 4, which lie inside `bytes`; the lowest byte comes first.
inline std::uint32_t littleEndian(std::span<const std::byte> bytes, std::size_t offset, std::size_t size = 4) {
  std::uint32_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = (value << 8U) | std::to_integer<std::uint32_t>(bytes[offset + i]);
  return value;
}

} // namespace vitrail::tool
