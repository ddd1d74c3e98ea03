#include "color_map.h"

#include <algorithm>
#include <cmath>

namespace vitrail::tool {

const ColorMap kMagma{{{0, 0, 4},
                       {10, 8, 34},
                       {29, 17, 71},
                       {54, 16, 107},
                       {81, 18, 124},
                       {106, 28, 129},
                       {131, 38, 129},
                       {156, 46, 127},
                       {183, 55, 121},
                       {207, 64, 112},
                       {229, 80, 100},
                       {244, 105, 92},
                       {251, 135, 97},
                       {254, 165, 113},
                       {254, 194, 135},
                       {253, 224, 161},
                       {252, 253, 191}}};

const ColorMap kViridis{{{68, 1, 84},
                         {72, 24, 106},
                         {71, 45, 123},
                         {66, 64, 134},
                         {59, 82, 139},
                         {51, 99, 141},
                         {44, 114, 142},
                         {38, 130, 142},
                         {33, 145, 140},
                         {31, 159, 136},
                         {39, 173, 129},
                         {61, 188, 116},
                         {92, 200, 99},
                         {129, 211, 77},
                         {170, 220, 50},
                         {213, 226, 26},
                         {253, 231, 37}}};

Picture heatmap(const Plane& plane, double largest, const ColorMap& map) {
  Picture picture;
  picture.width = plane.width;
  picture.height = plane.height;
  picture.rgba.reserve(plane.values.size() * 4);
  for (const double value : plane.values) {
    const double share = largest > 0.0 ? std::clamp(value / largest, 0.0, 1.0) : 0.0;
    const double place = share * static_cast<double>(map.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, map.size() - 1);
    for (std::size_t c = 0; c < 3; ++c) {
      const double first = map[below][c];
      const double second = map[above][c];
      const double code = std::lerp(first, second, place - static_cast<double>(below));
      picture.rgba.push_back(static_cast<std::uint8_t>(std::lround(code)));
    }
    picture.rgba.push_back(255);
  }
  return picture;
}

} // namespace vitrail::tool
