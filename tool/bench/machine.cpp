#include "machine.h"

#include <fmt/format.h>

#include <vitrail/types.h>

#include "../render/cpu_still.h"

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kGpuRounds = 31;
constexpr std::uint32_t kGpuWarmups = 3;
constexpr std::uint32_t kSlowRounds = 3;
constexpr std::uint32_t kSlowWarmups = 1;

} // namespace

Machine machineOf(const Device& device) {
  Machine machine;
  machine.processor = processorDevice();
  const Gl* gl = device.gl();
  if (device.gpu() == nullptr && gl != nullptr) {
    machine.device = gl->name();
    machine.driver = gl->driver();
    machine.api = gl->api();
    machine.isCpu = gl->isCpu();
    return machine;
  }
  if (device.gpu() == nullptr) {
    machine.device = machine.processor;
    machine.driver =
        fmt::format("Vitrail {}.{}.{}", VITRAIL_VERSION_MAJOR, VITRAIL_VERSION_MINOR, VITRAIL_VERSION_PATCH);
    machine.api = "CPU";
    machine.isCpu = true;
    machine.hasDevice = false;
    return machine;
  }
  const Gpu& gpu = *device.gpu();
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &driver;
  vkGetPhysicalDeviceProperties2(gpu.physicalDevice(), &properties);
  machine.device = gpu.properties().deviceName;
  machine.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
  machine.api = kVulkanApi;
  if (gl != nullptr) machine.api += fmt::format(" and {} ({}, {})", gl->api(), gl->name(), gl->driver());
  machine.isCpu = gpu.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  return machine;
}

std::uint32_t roundsOn(const Machine& machine, std::optional<std::uint32_t> asked) {
  return asked.value_or(machine.isSlow() ? kSlowRounds : kGpuRounds);
}

std::uint32_t warmupsOn(const Machine& machine, std::optional<std::uint32_t> asked) {
  return asked.value_or(machine.isSlow() ? kSlowWarmups : kGpuWarmups);
}

} // namespace vitrail::tool
