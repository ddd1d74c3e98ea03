#include "device_options.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "../methods/methods.h"
#include "errors.h"
#include "option_values.h"

namespace vitrail::tool {

namespace {

constexpr std::string_view kDeviceHelp =
    R"(  --device D            cpu, or a number or a part of a name from `vitrail info` (default: the best
                        GPU; where there is none cpu, or a Vulkan driver for CPUs if what is asked
                        for needs Vulkan))";
constexpr std::string_view kApiHelp =
    R"(  --api A               vulkan (default), or opengl, which has the methods linked-list, unsorted,
                        sorted and depth-peeling)";

constexpr const char* kApis = "vulkan and opengl";

} // namespace

std::string withDeviceHelp(const std::string& page) { return withText(page, "@device@", kDeviceHelp); }

std::string withApiHelp(const std::string& page, bool several) {
  constexpr std::string_view kSeveral = "; vulkan,opengl for both";
  return withText(page, "@api@", std::string(kApiHelp) + std::string(several ? kSeveral : ""));
}

void addApi(CLI::App& command, std::optional<Api>& api) { addChoice(command, "--api", kApis, api, apiNamed); }

void addApis(CLI::App& command, std::vector<Api>& apis) {
  addList<Api>(command, "--api", apis, "an API: vulkan or opengl", apiNamed);
}

Wish wishFor(const std::vector<std::string>& methods) {
  const auto isOnProcessor = [](const std::string& method) { return traitsOf(method).onProcessor; };
  if (methods.empty()) return Wish::VulkanIfThere;
  if (std::ranges::all_of(methods, isOnProcessor)) return Wish::Processor;
  return std::ranges::any_of(methods, isOnProcessor) ? Wish::VulkanIfThere : Wish::Vulkan;
}

DeviceOptions deviceFor(const std::string& name, bool validate, const std::vector<std::string>& methods,
                        const std::vector<Api>& apis) {
  DeviceOptions options{name, validate, wishFor(methods)};
  options.vulkan = std::ranges::count(apis, Api::Vulkan) > 0;
  options.openGl = std::ranges::count(apis, Api::OpenGl) > 0;
  if (options.openGl && isProcessor(name)) {
    throw UsageError("--api opengl needs an OpenGL device, which cpu is not: leave it out, or --device cpu");
  }
  return options;
}

void closeValidated(Device& device) {
  std::vector<std::string> errors;
  if (device.gl() != nullptr) errors = device.gl()->validationErrors();
  if (device.gpu() != nullptr) {
    device.gpu()->close(); // what was not destroyed by now is a validation error
    const std::vector<std::string> more = device.gpu()->validationErrors();
    errors.insert(errors.end(), more.begin(), more.end());
  }
  if (errors.empty()) return;
  throw std::runtime_error(
      fmt::format("the validation layer reports {} errors, the first: {}", errors.size(), errors[0]));
}

} // namespace vitrail::tool
