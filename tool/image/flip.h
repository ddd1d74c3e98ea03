// The difference that a person sees when flipping between two pictures: LDR-FLIP. Andersson, Nilsson, Akenine-Möller,
// Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator for Alternating Images", Proceedings of the ACM on
// Computer Graphics and Interactive Techniques 3(2), 2020 (High Performance Graphics).
#pragma once

#include "picture.h"
#include "plane.h"

namespace vitrail::tool {

// Pixels in a degree of the viewer's field of view: the paper's default, a display 0.7 m wide with 3840 pixels seen
// from 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 67.02064327658226; // 3840 * pi / 180

// What FLIP takes of one picture. Alpha is not looked at.
struct FlipPicture {
  Plane lightness; // of the picture as the eye's contrast sensitivity filters it, in Hunt-adjusted L*a*b*
  Plane a;
  Plane b;
  Plane edges; // the strength of edges and of points in the achromatic channel
  Plane points;
};
FlipPicture flipPicture(const Picture& picture);

// The difference of each pixel, 0 (none is seen) to 1. The pictures have one size. It does not matter which is which.
Plane flipErrors(const FlipPicture& reference, const FlipPicture& test);

} // namespace vitrail::tool
