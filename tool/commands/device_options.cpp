#include "device_options.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "../methods/methods.h"
#include "option_values.h"

namespace vitrail::tool {

namespace {

constexpr std::string_view kDeviceHelp =
    R"(  --device D            cpu, or a number or a part of a name from `vitrail info` (default: the best
                        GPU; where there is none cpu, or a Vulkan driver for CPUs if what is asked
                        for needs Vulkan))";

} // namespace

std::string withDeviceHelp(const std::string& page) { return withText(page, "@device@", kDeviceHelp); }

Wish wishFor(const std::vector<std::string>& methods) {
  const auto isOnProcessor = [](const std::string& method) { return traitsOf(method).onProcessor; };
  if (methods.empty()) return Wish::VulkanIfThere;
  if (std::ranges::all_of(methods, isOnProcessor)) return Wish::Processor;
  return std::ranges::any_of(methods, isOnProcessor) ? Wish::VulkanIfThere : Wish::Vulkan;
}

void closeValidated(Device& device) {
  if (device.gpu() == nullptr) return;
  device.gpu()->close(); // what was not destroyed by now is a validation error
  const std::vector<std::string> errors = device.gpu()->validationErrors();
  if (errors.empty()) return;
  throw std::runtime_error(
      fmt::format("the validation layer reports {} errors, the first: {}", errors.size(), errors[0]));
}

} // namespace vitrail::tool
