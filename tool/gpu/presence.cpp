#include "presence.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <system_error>

namespace vitrail::tool {

namespace {

constexpr std::array<std::string_view, 5> kNodes{"dxg", "kgsl-3d0", "mali0", "nvhost-gpu", "nvgpu"};

bool isUsable(const std::filesystem::path& node) { return ::access(node.c_str(), R_OK | W_OK) == 0; }

// Whether a folder has a usable node of that name with a number behind it.
bool hasNumbered(const std::filesystem::path& folder, std::string_view name) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string file = entry.path().filename().string();
    const bool isNumbered = file.starts_with(name) && file.size() > name.size() &&
                            file.find_first_not_of("0123456789", name.size()) == std::string::npos;
    if (isNumbered && isUsable(entry.path())) return true;
  }
  return false;
}

} // namespace

bool mayHaveGpu(const std::filesystem::path& devices) {
  return hasNumbered(devices / "dri", "renderD") || hasNumbered(devices, "nvidia") ||
         std::ranges::any_of(kNodes, [&](std::string_view node) { return isUsable(devices / node); });
}

} // namespace vitrail::tool
