#include "device_needs.h"

#include <fmt/format.h>

namespace vitrail::tool {

void requireOf(const Gpu& gpu, bool has, std::string_view lack, std::string_view method, std::string_view instead) {
  if (has) return;
  throw GpuError(
      fmt::format("{} {}, which the method {} needs: use {}", gpu.properties().deviceName, lack, method, instead));
}

void requireInterlock(const Gpu& gpu, std::string_view method) {
  requireOf(gpu, gpu.features().fragmentInterlock, "has no fragment shader interlock", method, "loop");
}

} // namespace vitrail::tool
