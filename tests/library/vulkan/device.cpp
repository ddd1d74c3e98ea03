#include "device.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

namespace vitrail::tests::vulkan {

namespace {

constexpr const char* kLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* kKeepingLayer = "VK_LAYER_VITRAIL_keeping"; // tests/kept
constexpr VkFormat kDepthStencil = VK_FORMAT_D32_SFLOAT_S8_UINT;

std::optional<std::uint32_t> drawingFamily(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    if ((families[i].queueFlags & kBoth) == kBoth) return i;
  }
  return {};
}

bool serves(VkPhysicalDevice device) {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(device, &properties);
  if (properties.apiVersion < VK_API_VERSION_1_3 || !drawingFamily(device)) return false;
  auto of13 = zeroed<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  auto features = zeroed<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
  features.pNext = &of13;
  vkGetPhysicalDeviceFeatures2(device, &features);
  return of13.dynamicRendering == VK_TRUE && of13.synchronization2 == VK_TRUE &&
         features.features.fragmentStoresAndAtomics == VK_TRUE;
}

// Smaller is better.
std::size_t rankOf(VkPhysicalDevice device) {
  constexpr std::array kBestFirst = {VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU,
                                     VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU, VK_PHYSICAL_DEVICE_TYPE_CPU};
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(device, &properties);
  return static_cast<std::size_t>(std::find(kBestFirst.begin(), kBestFirst.end(), properties.deviceType) -
                                  kBestFirst.begin());
}

bool hasExtension(VkPhysicalDevice device, const char* name) {
  std::uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const VkExtensionProperties& one) { return std::strcmp(one.extensionName, name) == 0; });
}

VkSampleCountFlags imageSamples(VkPhysicalDevice device, VkFormat format, VkImageUsageFlags usage) {
  VkImageFormatProperties properties{};
  const VkResult found = vkGetPhysicalDeviceImageFormatProperties(
      device, format, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL, usage | VK_IMAGE_USAGE_SAMPLED_BIT, 0, &properties);
  return found == VK_SUCCESS ? properties.sampleCounts : 0;
}

} // namespace

void check(VkResult result, const std::string& call) {
  if (result < 0) throw HostError(call + " failed: VkResult " + std::to_string(result));
}

Device::Device() {
  makeInstance();
  choose();
  findFeatures();
  makeDevice();
}

void Device::close() {
  if (device_ != VK_NULL_HANDLE) vkDestroyDevice(device_, nullptr);
  if (messenger_ != VK_NULL_HANDLE) vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
  if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
  device_ = VK_NULL_HANDLE;
  messenger_ = VK_NULL_HANDLE;
  instance_ = VK_NULL_HANDLE;
}

VkBool32 Device::onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/, VkDebugUtilsMessageTypeFlagsEXT types,
                           const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) {
  // General messages are the loader's, not about our calls.
  if ((types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT) == 0) return VK_FALSE;
  auto* device = static_cast<Device*>(self);
  const std::lock_guard lock(device->mutex_);
  device->errors_.emplace_back(data->pMessage);
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT Device::messengerInfo() {
  auto info = zeroed<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = onMessage;
  info.pUserData = this;
  return info;
}

void Device::makeInstance() {
  check(volkInitialize(), "opening the Vulkan loader (libvulkan1)");
  auto application = zeroed<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
  application.apiVersion = VK_API_VERSION_1_3;
  constexpr VkValidationFeatureEnableEXT kSynchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  const VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo();
  auto validation = zeroed<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
  validation.pNext = &messenger; // for what is said while the instance is made and destroyed
  validation.enabledValidationFeatureCount = 1;
  validation.pEnabledValidationFeatures = &kSynchronization;
  std::vector<const char*> layers;
#ifdef VITRAIL_TEST_NO_VULKAN_LAYERS // Wine's Vulkan has none
  constexpr std::array kExtensions = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
#else
  constexpr std::array kExtensions = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
  layers.push_back(kLayer);
  // Below it, or above (tests/kept): the first is the nearest to the application.
  if (const char* place = std::getenv("VITRAIL_TEST_KEEP_PIPELINES"); place != nullptr) {
    layers.insert(std::string_view(place) == "above" ? layers.begin() : layers.end(), kKeepingLayer);
  }
#endif
  auto info = zeroed<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
  info.pNext = &validation;
  info.pApplicationInfo = &application;
  info.enabledLayerCount = static_cast<std::uint32_t>(layers.size());
  info.ppEnabledLayerNames = layers.data();
  info.enabledExtensionCount = kExtensions.size();
  info.ppEnabledExtensionNames = kExtensions.data();
  check(vkCreateInstance(&info, nullptr, &instance_), "vkCreateInstance under vulkan-validationlayers");
  volkLoadInstance(instance_);
  check(vkCreateDebugUtilsMessengerEXT(instance_, &messenger, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
}

void Device::choose() {
  std::uint32_t count = 0;
  vkEnumeratePhysicalDevices(instance_, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  vkEnumeratePhysicalDevices(instance_, &count, devices.data());
  std::erase_if(devices, [](VkPhysicalDevice device) { return !serves(device); });
  if (devices.empty()) throw HostError("no device with Vulkan 1.3, dynamic rendering and synchronization2");
  physicalDevice_ = *std::min_element(devices.begin(), devices.end(),
                                      [](VkPhysicalDevice a, VkPhysicalDevice b) { return rankOf(a) < rankOf(b); });
  queueFamily_ = drawingFamily(physicalDevice_).value();
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physicalDevice_, &properties);
  limits_ = properties.limits;
  isCpu_ = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  vkGetPhysicalDeviceMemoryProperties(physicalDevice_, &memory_);
}

void Device::findFeatures() {
  auto of12 = zeroed<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
  auto features = zeroed<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
  features.pNext = &of12;
  vkGetPhysicalDeviceFeatures2(physicalDevice_, &features);
  features_.bindingBytes = limits_.maxStorageBufferRange;
  features_.addresses = of12.bufferDeviceAddress == VK_TRUE;
  features_.dualSourceBlending = features.features.dualSrcBlend == VK_TRUE;
  features_.sampleRateShading = features.features.sampleRateShading == VK_TRUE;
  features_.postDepthCoverage = hasExtension(physicalDevice_, VK_EXT_POST_DEPTH_COVERAGE_EXTENSION_NAME);
  const VkSampleCountFlags samples =
      limits_.framebufferColorSampleCounts & limits_.framebufferDepthSampleCounts &
      limits_.sampledImageColorSampleCounts & limits_.sampledImageDepthSampleCounts &
      imageSamples(physicalDevice_, VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) &
      imageSamples(physicalDevice_, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  for (const std::uint32_t count : {2U, 4U, 8U}) { // the flag of a count is its value
    if ((samples & count) != 0) features_.multisampled.push_back(count);
  }
  const VkSampleCountFlags withStencil =
      limits_.framebufferStencilSampleCounts &
      imageSamples(physicalDevice_, kDepthStencil, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  features_.stencil = (withStencil & samples) == samples;
}

void Device::makeDevice() {
  const float priority = 1.0F;
  auto queue = zeroed<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
  queue.queueFamilyIndex = queueFamily_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  auto of13 = zeroed<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  of13.dynamicRendering = VK_TRUE;
  of13.synchronization2 = VK_TRUE;
  auto of12 = zeroed<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
  of12.pNext = &of13;
  of12.bufferDeviceAddress = features_.addresses ? VK_TRUE : VK_FALSE;
  auto enabled = zeroed<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
  enabled.pNext = &of12;
  enabled.features.fragmentStoresAndAtomics = VK_TRUE;
  enabled.features.dualSrcBlend = features_.dualSourceBlending ? VK_TRUE : VK_FALSE;
  enabled.features.sampleRateShading = features_.sampleRateShading ? VK_TRUE : VK_FALSE;
  const char* postDepthCoverage = VK_EXT_POST_DEPTH_COVERAGE_EXTENSION_NAME;
  auto info = zeroed<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
  info.pNext = &enabled;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = features_.postDepthCoverage ? 1 : 0;
  info.ppEnabledExtensionNames = &postDepthCoverage;
  check(vkCreateDevice(physicalDevice_, &info, nullptr, &device_), "vkCreateDevice");
  vkGetDeviceQueue(device_, queueFamily_, 0, &queue_);
}

std::uint32_t Device::memoryType(std::uint32_t allowed, VkMemoryPropertyFlags properties) const {
  for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
    if ((allowed >> i & 1U) != 0 && (memory_.memoryTypes[i].propertyFlags & properties) == properties) return i;
  }
  throw HostError("the device has no memory with the properties " + std::to_string(properties));
}

std::vector<std::string> Device::takeErrors() {
  const std::lock_guard lock(mutex_);
  return std::exchange(errors_, {});
}

} // namespace vitrail::tests::vulkan
