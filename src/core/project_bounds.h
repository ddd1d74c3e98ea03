// Which pixels boxes in space can reach.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace vitrail {

// Whole pixels of a picture, from its top left corner.
struct Rectangle {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;

  bool operator==(const Rectangle&) const = default;
};

// An axis-aligned box and the matrix (column-major) from its space to clip space: x and y in [-w, w], depth in [0, w].
struct ClipBox {
  std::array<float, 3> min{};
  std::array<float, 3> max{};
  std::array<float, 16> clipFromBox{};
};

// The smallest rectangle that contains the projections of all boxes and a pixel around them, for what a device's single
// precision and snapping may move, clipped to the picture. It is conservative: a box that reaches the eye's plane, or
// whose projection is not finite, covers the whole picture unless it lies outside as a whole. Empty boxes (min > max on
// an axis) reach nothing. A width and height of 0 where nothing is visible.
Rectangle projectBounds(std::span<const ClipBox> boxes, std::uint32_t width, std::uint32_t height);

} // namespace vitrail
