// Image metrics for people. What is not equal does not read as equal.
#pragma once

#include <string>

#include "../image/metrics.h"

namespace vitrail::tool {

std::string psnrText(double psnr);   // "38.75", or "inf" for equal pictures
std::string ssimText(double ssim);   // "0.9751"
std::string flipText(double flip);   // "0.0021"
std::string shareText(double share); // "3.1 %", or "0" for none

} // namespace vitrail::tool
