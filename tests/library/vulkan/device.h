// The Vulkan device that the tests run on, under the Khronos validation layer with synchronization validation.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include <volk.h>

#include "../backend.h"

namespace vitrail::tests::vulkan {

// A zeroed Vulkan structure of its type.
template <typename Struct>
Struct zeroed(VkStructureType type) {
  Struct value{};
  value.sType = type;
  return value;
}

// Throws HostError where `result` is an error.
void check(VkResult result, const std::string& call);

// An instance, the best device that the machine has (GPUs before CPU drivers) and a queue that draws and computes, with
// dynamic rendering, synchronization2, and what Features names where the device has it.
class Device {
 public:
  // Throws HostError where there is no such device, or no validation layer.
  Device();
  ~Device() { close(); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  // Destroys everything: what outlived it is among the errors then.
  void close();

  [[nodiscard]] VkInstance instance() const { return instance_; }
  [[nodiscard]] VkPhysicalDevice physicalDevice() const { return physicalDevice_; }
  [[nodiscard]] VkDevice get() const { return device_; }
  [[nodiscard]] VkQueue queue() const { return queue_; }
  [[nodiscard]] std::uint32_t queueFamily() const { return queueFamily_; }
  [[nodiscard]] const VkPhysicalDeviceLimits& limits() const { return limits_; }
  [[nodiscard]] bool isCpu() const { return isCpu_; } // a driver that runs on the CPU
  [[nodiscard]] const Features& features() const { return features_; }

  // A type of memory among the allowed ones that has all of the properties; throws HostError where there is none.
  [[nodiscard]] std::uint32_t memoryType(std::uint32_t allowed, VkMemoryPropertyFlags properties) const;

  // What the validation layer has said since the last call.
  [[nodiscard]] std::vector<std::string> takeErrors();

 private:
  static VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                  VkDebugUtilsMessageTypeFlagsEXT types,
                                                  const VkDebugUtilsMessengerCallbackDataEXT* data, void* self);
  VkDebugUtilsMessengerCreateInfoEXT messengerInfo();
  void makeInstance();
  void choose();
  void findFeatures();
  void makeDevice();

  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDevice physicalDevice_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  std::uint32_t queueFamily_ = 0;
  VkPhysicalDeviceLimits limits_{};
  bool isCpu_ = false;
  VkPhysicalDeviceMemoryProperties memory_{};
  Features features_;
  std::mutex mutex_; // messages arrive on any thread
  std::vector<std::string> errors_;
};

} // namespace vitrail::tests::vulkan
