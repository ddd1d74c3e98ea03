// Image metrics as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "../image/metrics.h"

namespace vitrail::tool {

// psnr_db (null: the pictures are equal), ssim, flip, worst {x, y, difference (1/255)}, off_share. Names and units are
// an interface and stay.
nlohmann::ordered_json toJson(const Metrics& metrics);

} // namespace vitrail::tool
