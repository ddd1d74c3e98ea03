// How far one picture is from another, for programs and for people.
#pragma once

#include <cstdint>
#include <string>

#include "../image/metrics.h"

namespace vitrail::tool {

// Two pictures of one size that were compared.
struct PictureComparison {
  std::string expected; // their files
  std::string test;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool alpha = false; // one of them has it
  Metrics metrics;
};

// The JSON document of `vitrail compare A.png B.png --json`.
std::string toJson(const PictureComparison& comparison);

std::string toTable(const PictureComparison& comparison);

} // namespace vitrail::tool
