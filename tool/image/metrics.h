// How far one picture is from another, in the measures that the field reports.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "flip.h"
#include "picture.h"

namespace vitrail::tool {

struct Metrics {
  double psnr = 0.0; // dB over R, G and B of the 8-bit sRGB values; infinite for equal pictures
  double ssim = 0.0; // ssim.h
  double flip = 0.0; // the mean of flip.h's errors
  // The pixel with the largest difference of a channel, the first of equal ones in reading order.
  std::uint32_t worstX = 0;
  std::uint32_t worstY = 0;
  int worst = 0;         // that difference, in 1/255
  double offShare = 0.0; // the share of pixels that are off by more than kOffBound in any channel
};
inline constexpr int kOffBound = 2; // 1/255

struct Difference {
  Metrics metrics;
  Plane flip; // the FLIP error of each pixel
};

// A picture that others are compared with; what that takes is worked out once.
//
// Pictures with alpha are compared as they are seen, over black and over white: light over a backdrop is linear in the
// backdrop, so pictures that agree over both agree over all. If either of two pictures has alpha, both are laid over
// black and over white, blended in linear light and rounded to 8 bits, and each measure is the worse one of the two.
class ComparedPicture {
 public:
  explicit ComparedPicture(const Picture& picture);
  ~ComparedPicture();
  ComparedPicture(const ComparedPicture&) = delete;
  ComparedPicture& operator=(const ComparedPicture&) = delete;

  // Throws std::invalid_argument where the pictures differ in size.
  Difference differenceTo(const Picture& test) const;

 private:
  struct Seen; // a picture without alpha
  const Seen& over(int backdrop) const;

  Picture picture_;
  mutable std::array<std::unique_ptr<Seen>, 2> seen_; // over black and over white, made when first asked for
};

} // namespace vitrail::tool
