// Structural similarity of two pictures: Wang, Bovik, Sheikh and Simoncelli, "Image Quality Assessment: From Error
// Visibility to Structural Similarity", IEEE Transactions on Image Processing 13(4), 2004.
#pragma once

#include "picture.h"

namespace vitrail::tool {

// The mean SSIM index, 1 for equal pictures: on luma, 0.299 R + 0.587 G + 0.114 B of the 8-bit sRGB values, with the
// paper's window, a Gaussian of 11x11 pixels and standard deviation 1.5, at every place where it lies inside the
// picture, K1 = 0.01 and K2 = 0.03. Along a side of fewer than 11 pixels the window is the largest odd number of pixels
// that fits. Alpha is not looked at. The pictures have one size.
double ssim(const Picture& a, const Picture& b);

} // namespace vitrail::tool
