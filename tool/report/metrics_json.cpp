#include "metrics_json.h"

#include <cmath>

namespace vitrail::tool {

namespace {

using Json = nlohmann::ordered_json;

} // namespace

nlohmann::ordered_json toJson(const Metrics& metrics) {
  return {{"psnr_db", std::isinf(metrics.psnr) ? Json(nullptr) : Json(metrics.psnr)},
          {"ssim", metrics.ssim},
          {"flip", metrics.flip},
          {"worst", {{"x", metrics.worstX}, {"y", metrics.worstY}, {"difference", metrics.worst}}},
          {"off_share", metrics.offShare}};
}

} // namespace vitrail::tool
