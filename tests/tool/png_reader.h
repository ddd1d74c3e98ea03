// Reads a PNG back, with libpng's simplified interface: not the code that wrote it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace vitrail::tests {

struct ReadPng {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool hasAlpha = false;
  std::vector<std::uint8_t> rgba; // sRGB, straight alpha
};

// Throws std::runtime_error where the file is not a whole, valid PNG.
ReadPng readPng(const std::filesystem::path& path);

} // namespace vitrail::tests
