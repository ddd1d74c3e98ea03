// What is rasterised is triangles whose corners lie within the guard band. Others are made of what a host hands over:
// triangles that reach out of the view are clipped (Sutherland and Hodgman 1974, in homogeneous coordinates), lines
// become parallelograms, points become squares.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "raster/rules.h"

namespace vitrail::raster {

// A picture, or the part of one that is drawn, and how clip space is placed on it.
struct Viewport {
  std::uint32_t width = 0; // of the whole picture
  std::uint32_t height = 0;
  std::int32_t originX = 0; // pixels from its corner to that of the part
  std::int32_t originY = 0;
  bool yUp = false;             // of clip space
  bool depthFromMinusW = false; // OpenGL's z
};

struct ClipVertex {
  std::array<float, 4> position{};  // clip space
  std::array<float, 8> distances{}; // from the host's planes: what is negative is cut away
  float second = 0.0F;              // weights of the second and third corner of what the host handed over
  float third = 0.0F;
};

// Places a vertex of clip space that needs no clipping, in the steps in which drivers do, each rounded: divide by w,
// scale, move, snap.
Corner placed(const Viewport& viewport, const std::array<float, 4>& position);

// Whether it needs clipping for its position: outside the depth range or the guard band, or not finite.
bool needsClipping(const Viewport& viewport, const std::array<float, 4>& position);

// A triangle to rasterise: its corners, and for each the weights in what the host handed over.
struct Piece {
  std::array<Corner, 3> corners{};
  std::array<float, 3> second{};
  std::array<float, 3> third{};
};

// A triangle that is clipped by all planes has at most 3 + 6 + 8 corners.
constexpr std::size_t kMostPieces = 15;

struct Pieces {
  std::array<Piece, kMostPieces> pieces{};
  std::size_t count = 0;

  std::span<const Piece> all() const { return {pieces.data(), count}; }
};

// What is left of a triangle within the view's depth, the guard band and `planes` planes of the host's. Triangles that
// share an edge are clipped alike along it.
Pieces clipped(const Viewport& viewport, const std::array<ClipVertex, 3>& triangle, std::uint32_t planes);

// A line as two triangles: a pixel wide across the axis along which it is longer (Vulkan, 27.7.2, parallelograms).
Pieces lineOf(const Viewport& viewport, const std::array<ClipVertex, 2>& line, std::uint32_t planes);

// A point as a square of `size` pixels; nothing where its middle is cut away.
Pieces pointOf(const Viewport& viewport, const ClipVertex& point, std::uint32_t planes, float size);

} // namespace vitrail::raster
