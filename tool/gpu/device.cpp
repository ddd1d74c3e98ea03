#include "device.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "features.h"
#include "vk.h"

namespace vitrail::tool {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* kNoDriver = "no Vulkan driver found: install mesa-vulkan-drivers";

// What the validation layer said. Messages arrive on any thread that calls Vulkan.
class ValidationLog {
 public:
  void add(std::string message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
  }
  std::vector<std::string> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> messages_;
};

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/,
                                         VkDebugUtilsMessageTypeFlagsEXT types,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* log) {
  // General messages are the loader's (a driver that could not be opened, for example): not about our calls.
  if ((types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT) != 0) {
    static_cast<ValidationLog*>(log)->add(data->pMessage);
  }
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationLog& log) {
  auto info = vkStruct<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = onMessage;
  info.pUserData = &log;
  return info;
}

bool hasLayer(const char* name) {
  std::uint32_t count = 0;
  check(vkEnumerateInstanceLayerProperties(&count, nullptr), "vkEnumerateInstanceLayerProperties");
  std::vector<VkLayerProperties> layers(count);
  check(vkEnumerateInstanceLayerProperties(&count, layers.data()), "vkEnumerateInstanceLayerProperties");
  return std::any_of(layers.begin(), layers.end(),
                     [&](const VkLayerProperties& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

// `layer` null: what the loader and the drivers offer, else what that layer adds.
bool hasInstanceExtension(const char* layer, const char* name) {
  std::uint32_t count = 0;
  check(vkEnumerateInstanceExtensionProperties(layer, &count, nullptr), "vkEnumerateInstanceExtensionProperties");
  std::vector<VkExtensionProperties> extensions(count);
  check(vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data()),
        "vkEnumerateInstanceExtensionProperties");
  return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& extension) {
    return std::strcmp(extension.extensionName, name) == 0;
  });
}

void openLoader() {
  if (volkInitialize() != VK_SUCCESS) {
    throw GpuError("there is no Vulkan loader on this machine: install libvulkan1 and mesa-vulkan-drivers");
  }
  if (volkGetInstanceVersion() < VK_API_VERSION_1_3) {
    throw GpuError("the Vulkan loader of this machine is older than 1.3: install a newer libvulkan1");
  }
}

// With `log`, the instance runs under the validation layer and reports to it from its creation to its destruction.
VkInstance createInstance(ValidationLog* log, std::vector<const char*> extensions = {}) {
  openLoader();
  auto application = vkStruct<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
  application.pApplicationName = "vitrail";
  application.apiVersion = VK_API_VERSION_1_3;
  auto info = vkStruct<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
  info.pApplicationInfo = &application;

  // The layer brings the debug utilities itself where neither the loader nor a driver has them.
  const bool debugUtils = hasInstanceExtension(nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) || log != nullptr;
  if (debugUtils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

  const VkValidationFeatureEnableEXT enabled = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  auto features = vkStruct<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = &enabled;
  VkDebugUtilsMessengerCreateInfoEXT messenger{};
  if (log != nullptr) {
    if (!hasLayer(kValidationLayer)) {
      throw GpuError("the Vulkan validation layer is not installed: install vulkan-validationlayers");
    }
    extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    messenger = messengerInfo(*log);
    features.pNext = &messenger;
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
  }
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();

  VkInstance instance = VK_NULL_HANDLE;
  const VkResult result = vkCreateInstance(&info, nullptr, &instance);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) throw GpuError(kNoDriver);
  check(result, "vkCreateInstance");
  // Device functions too are called through the loader: several devices, of several drivers, may be alive at once.
  volkLoadInstance(instance);
  return instance;
}

std::string kindOf(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "CPU";
    default:
      return "other";
  }
}

std::vector<VkQueueFamilyProperties> queueFamilies(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  return families;
}

// The first family that draws and computes.
std::optional<std::uint32_t> findQueueFamily(VkPhysicalDevice device) {
  const std::vector<VkQueueFamilyProperties> families = queueFamilies(device);
  constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if ((families[i].queueFlags & kNeeded) == kNeeded && families[i].queueCount > 0) return i;
  }
  return std::nullopt;
}

bool hasFormat(VkPhysicalDevice device, VkFormat format, VkFormatFeatureFlags needed) {
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(device, format, &properties);
  return (properties.optimalTilingFeatures & needed) == needed;
}

// Whether a device shows pictures as `options` want it.
bool presents(VkInstance instance, VkPhysicalDevice device, const GpuOptions& options) {
  if (!options.presents) return true;
  const std::optional<std::uint32_t> family = findQueueFamily(device);
  return family && hasDeviceExtension(device, VK_KHR_SWAPCHAIN_EXTENSION_NAME) &&
         options.presents(instance, device, *family);
}

// What keeps the tool from rendering on a device, in words; empty where nothing does.
std::string missingIn(VkPhysicalDevice device, std::uint32_t apiVersion) {
  if (apiVersion < VK_API_VERSION_1_3) return "Vulkan 1.3";
  auto features13 = vkStruct<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  auto features = vkStruct<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
  features.pNext = &features13;
  vkGetPhysicalDeviceFeatures2(device, &features);

  std::vector<std::string> missing;
  if (features13.dynamicRendering == VK_FALSE) missing.emplace_back("dynamic rendering");
  if (features13.synchronization2 == VK_FALSE) missing.emplace_back("synchronization2");
  if (features.features.fragmentStoresAndAtomics == VK_FALSE) missing.emplace_back("fragment stores and atomics");
  if (!hasFormat(device, VK_FORMAT_R16G16B16A16_SFLOAT,
                 VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT)) {
    missing.emplace_back("16-bit float colour images that compute shaders can write");
  }
  if (!hasFormat(device, VK_FORMAT_D32_SFLOAT, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT)) {
    missing.emplace_back("32-bit float depth");
  }
  if (!findQueueFamily(device)) missing.emplace_back("a queue for both graphics and compute");
  return fmt::format("{}", fmt::join(missing, ", "));
}

std::uint64_t largestLocalHeap(VkPhysicalDevice device) {
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(device, &memory);
  VkDeviceSize largest = 0;
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    const VkMemoryHeap& heap = memory.memoryHeaps[i];
    if ((heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0) largest = std::max(largest, heap.size);
  }
  return largest;
}

bool hasTimestamps(VkPhysicalDevice device) {
  const std::optional<std::uint32_t> family = findQueueFamily(device);
  return family && queueFamilies(device)[*family].timestampValidBits > 0;
}

DeviceSummary summarize(VkPhysicalDevice device, std::uint32_t index) {
  auto driver = vkStruct<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
  auto maintenance3 =
      vkStruct<VkPhysicalDeviceMaintenance3Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES);
  auto properties = vkStruct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
  vkGetPhysicalDeviceProperties(device, &properties.properties);
  const std::uint32_t apiVersion = properties.properties.apiVersion;
  if (apiVersion >= VK_API_VERSION_1_2) { // where the driver's own words became core
    driver.pNext = &maintenance3;
    properties.pNext = &driver;
    vkGetPhysicalDeviceProperties2(device, &properties);
  }

  DeviceSummary summary;
  summary.index = index;
  summary.name = properties.properties.deviceName;
  summary.kind = kindOf(properties.properties.deviceType);
  summary.driver = std::string_view(driver.driverInfo).empty()
                       ? std::string(driver.driverName)
                       : fmt::format("{} {}", driver.driverName, driver.driverInfo);
  if (summary.driver.empty()) summary.driver = "unknown";
  summary.identity = identityOf(properties.properties);
  summary.apiVersion = apiVersion;
  summary.missing = missingIn(device, apiVersion);
  summary.maxPictureSide = properties.properties.limits.maxImageDimension2D;
  summary.maxBindingBytes = properties.properties.limits.maxStorageBufferRange;
  summary.maxAllocationBytes = maintenance3.maxMemoryAllocationSize;
  summary.memoryBytes = largestLocalHeap(device);
  if (summary.missing.empty()) summary.features = supportedFeatures(device);
  summary.timestamps = hasTimestamps(device);
  return summary;
}

std::vector<VkPhysicalDevice> enumerate(VkInstance instance) {
  std::uint32_t count = 0;
  check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> devices(count);
  check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
  devices.resize(count);
  if (devices.empty()) throw GpuError(kNoDriver);
  return devices;
}

std::vector<DeviceSummary> summarizeAll(const std::vector<VkPhysicalDevice>& devices) {
  std::vector<DeviceSummary> summaries;
  summaries.reserve(devices.size());
  for (VkPhysicalDevice device : devices) {
    summaries.push_back(summarize(device, static_cast<std::uint32_t>(summaries.size())));
  }
  return summaries;
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

// Whether `device` is what the user named; an empty name means any device that can render.
bool matches(const DeviceSummary& device, const std::string& wanted) {
  if (wanted.empty()) return device.missing.empty();
  if (std::all_of(wanted.begin(), wanted.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) {
    return std::to_string(device.index) == wanted;
  }
  return lower(device.name).find(wanted) != std::string::npos;
}

// Devices that can render come first, then the faster kinds.
int rank(const DeviceSummary& device) {
  constexpr std::string_view kKinds[] = {"discrete GPU", "integrated GPU", "virtual GPU", "CPU", "other"};
  const auto* const kind = std::find(std::begin(kKinds), std::end(kKinds), device.kind);
  return static_cast<int>(kind - std::begin(kKinds)) + (device.missing.empty() ? 0 : 100);
}

DeviceSummary choose(const std::vector<DeviceSummary>& devices, const GpuOptions& options) {
  const std::string& wanted = options.device;
  const std::string name = lower(wanted);
  const DeviceSummary* best = nullptr;
  std::vector<std::string> known;
  for (const DeviceSummary& device : devices) {
    known.push_back(fmt::format("{}: {}{}", device.index, device.name,
                                device.missing.empty() ? "" : fmt::format(" (lacks {})", device.missing)));
    if (options.onlyGpus && !isUsableGpu(device)) continue;
    if (matches(device, name) && (best == nullptr || rank(device) < rank(*best))) best = &device;
  }
  if (best == nullptr) {
    throw GpuError(wanted.empty() ? fmt::format("no device can render; devices: {}", fmt::join(known, "; "))
                                  : fmt::format("no device '{}'; devices: cpu; {}", wanted, fmt::join(known, "; ")));
  }
  if (!best->missing.empty()) throw GpuError(fmt::format("{} cannot render: it lacks {}", best->name, best->missing));
  return *best;
}

} // namespace

struct Gpu::Impl {
  ValidationLog log;
  VkInstance instance = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::mutex queueMutex;
  std::uint32_t queueFamily = 0;
  bool presents = false;
  VkPhysicalDeviceProperties properties{};
  GpuFeatures features;
  VkPhysicalDeviceMemoryProperties memoryProperties{};
  std::uint64_t maxAllocation = 0;
  std::atomic<std::uint64_t> memory{0};
  std::atomic<std::uint64_t> peak{0};

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();
  void createMessenger();
  void createDevice(bool swapchain);
};

Gpu::Impl::~Impl() {
  const std::size_t known = log.messages().size();
  if (device != VK_NULL_HANDLE) vkDestroyDevice(device, nullptr);
  if (messenger != VK_NULL_HANDLE) vkDestroyDebugUtilsMessengerEXT(instance, messenger, nullptr);
  if (instance != VK_NULL_HANDLE) vkDestroyInstance(instance, nullptr);
  // Nobody can ask for these any more (objects that outlive a device that nobody closed), so they end the program: a
  // leak must fail a test.
  const std::vector<std::string> messages = log.messages();
  for (std::size_t i = known; i < messages.size(); ++i) std::fprintf(stderr, "%s\n", messages[i].c_str());
  if (messages.size() > known) std::abort();
}

void Gpu::Impl::createMessenger() {
  const VkDebugUtilsMessengerCreateInfoEXT info = messengerInfo(log);
  check(vkCreateDebugUtilsMessengerEXT(instance, &info, nullptr, &messenger), "vkCreateDebugUtilsMessengerEXT");
}

void Gpu::Impl::createDevice(bool swapchain) {
  const float priority = 1.0F;
  auto queueInfo = vkStruct<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
  queueInfo.queueFamilyIndex = queueFamily;
  queueInfo.queueCount = 1;
  queueInfo.pQueuePriorities = &priority;

  VkPhysicalDeviceFeatures supported{};
  vkGetPhysicalDeviceFeatures(physicalDevice, &supported);
  auto features13 = vkStruct<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  features13.dynamicRendering = VK_TRUE;
  features13.synchronization2 = VK_TRUE;
  auto features12 = vkStruct<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
  features12.pNext = &features13;
  features12.bufferDeviceAddress = features.bufferDeviceAddress ? VK_TRUE : VK_FALSE;
  features12.shaderSampledImageArrayNonUniformIndexing = features.nonUniformTextures ? VK_TRUE : VK_FALSE;
  features12.shaderBufferInt64Atomics = features.int64Atomics ? VK_TRUE : VK_FALSE;
  auto interlock = vkStruct<VkPhysicalDeviceFragmentShaderInterlockFeaturesEXT>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADER_INTERLOCK_FEATURES_EXT);
  interlock.fragmentShaderPixelInterlock = VK_TRUE;
  if (features.fragmentInterlock) features13.pNext = &interlock;
  auto enabled = vkStruct<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
  enabled.pNext = &features12;
  enabled.features.fragmentStoresAndAtomics = VK_TRUE;
  enabled.features.dualSrcBlend = features.dualSourceBlending ? VK_TRUE : VK_FALSE;
  enabled.features.largePoints = features.largePoints ? VK_TRUE : VK_FALSE;
  enabled.features.sampleRateShading = features.sampleRateShading ? VK_TRUE : VK_FALSE;
  enabled.features.geometryShader = features.primitiveNumbers ? VK_TRUE : VK_FALSE;
  enabled.features.shaderInt64 = features.int64Atomics ? VK_TRUE : VK_FALSE;
  enabled.features.shaderSampledImageArrayDynamicIndexing = features.nonUniformTextures ? VK_TRUE : VK_FALSE;
  enabled.features.independentBlend = features.independentBlending ? VK_TRUE : VK_FALSE;
  enabled.features.shaderClipDistance = features.clipPlanes > 0 ? VK_TRUE : VK_FALSE;
  enabled.features.fullDrawIndexUint32 = supported.fullDrawIndexUint32; // for meshes beyond 16.7 M vertices

  std::vector<const char*> extensions;
  if (swapchain) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  if (features.postDepthCoverage) extensions.push_back(VK_EXT_POST_DEPTH_COVERAGE_EXTENSION_NAME);
  if (features.fragmentInterlock) extensions.push_back(VK_EXT_FRAGMENT_SHADER_INTERLOCK_EXTENSION_NAME);
  if (features.middleSamples != 0) extensions.push_back(VK_EXT_SAMPLE_LOCATIONS_EXTENSION_NAME);
  auto info = vkStruct<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
  info.pNext = &enabled;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queueInfo;
  check(vkCreateDevice(physicalDevice, &info, nullptr, &device), "vkCreateDevice");
  vkGetDeviceQueue(device, queueFamily, 0, &queue);
  setDebugName(device, VK_OBJECT_TYPE_DEVICE, device, "device");
  setDebugName(device, VK_OBJECT_TYPE_QUEUE, queue, "queue");
}

Gpu::Gpu(const GpuOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->instance = createInstance(options.validate ? &impl_->log : nullptr, options.instanceExtensions);
  if (options.validate) impl_->createMessenger();
  std::vector<VkPhysicalDevice> devices = enumerate(impl_->instance);
  if (options.onlyPresenting) {
    std::erase_if(devices, [&](VkPhysicalDevice device) { return !tool::presents(impl_->instance, device, options); });
  }
  if (devices.empty()) throw GpuError("no Vulkan device shows pictures in a window here");
  const DeviceSummary chosen = choose(summarizeAll(devices), options);
  impl_->physicalDevice = devices[chosen.index];
  impl_->maxAllocation = chosen.maxAllocationBytes;
  impl_->queueFamily = findQueueFamily(impl_->physicalDevice).value(); // choose() made sure that there is one
  vkGetPhysicalDeviceProperties(impl_->physicalDevice, &impl_->properties);
  vkGetPhysicalDeviceMemoryProperties(impl_->physicalDevice, &impl_->memoryProperties);
  impl_->features = supportedFeatures(impl_->physicalDevice);
  impl_->presents = options.presents && tool::presents(impl_->instance, impl_->physicalDevice, options);
  impl_->createDevice(impl_->presents);
}

Gpu::~Gpu() = default;

VkInstance Gpu::instance() const { return impl_->instance; }
VkPhysicalDevice Gpu::physicalDevice() const { return impl_->physicalDevice; }
VkDevice Gpu::device() const { return impl_->device; }
std::uint32_t Gpu::queueFamily() const { return impl_->queueFamily; }
const VkPhysicalDeviceProperties& Gpu::properties() const { return impl_->properties; }
const GpuFeatures& Gpu::features() const { return impl_->features; }
const VkPhysicalDeviceMemoryProperties& Gpu::memoryProperties() const { return impl_->memoryProperties; }

std::uint64_t Gpu::maxAllocation() const { return impl_->maxAllocation; }
std::uint64_t Gpu::localMemory() const { return largestLocalHeap(impl_->physicalDevice); }
bool Gpu::presents() const { return impl_->presents; }

VkResult Gpu::submit(const VkSubmitInfo2& info, VkFence fence) {
  const std::lock_guard lock(impl_->queueMutex);
  return vkQueueSubmit2(impl_->queue, 1, &info, fence);
}

VkResult Gpu::present(const VkPresentInfoKHR& info) {
  const std::lock_guard lock(impl_->queueMutex);
  return vkQueuePresentKHR(impl_->queue, &info);
}

VkResult Gpu::waitIdle() {
  const std::lock_guard lock(impl_->queueMutex);
  return impl_->device == VK_NULL_HANDLE ? VK_SUCCESS : vkDeviceWaitIdle(impl_->device);
}

void Gpu::close() {
  if (impl_->device != VK_NULL_HANDLE) vkDestroyDevice(impl_->device, nullptr);
  impl_->device = VK_NULL_HANDLE;
}

std::vector<std::string> Gpu::validationErrors() const { return impl_->log.messages(); }

void Gpu::memoryAllocated(std::uint64_t bytes) {
  const std::uint64_t held = impl_->memory += bytes;
  std::uint64_t peak = impl_->peak;
  while (held > peak && !impl_->peak.compare_exchange_weak(peak, held)) {
  }
}

void Gpu::memoryFreed(std::uint64_t bytes) { impl_->memory -= bytes; }

std::uint64_t Gpu::memoryHeld() const { return impl_->memory; }

std::uint64_t Gpu::peakMemory() const { return impl_->peak; }

std::string identityOf(const VkPhysicalDeviceProperties& properties) {
  return fmt::format("{}, driver {:x}, {:02x}", static_cast<const char*>(properties.deviceName),
                     properties.driverVersion, fmt::join(properties.pipelineCacheUUID, ""));
}

bool isUsableGpu(const DeviceSummary& device) { return device.missing.empty() && device.kind.ends_with("GPU"); }

std::vector<DeviceSummary> listDevices() {
  VkInstance instance = createInstance(nullptr);
  std::vector<DeviceSummary> devices;
  try {
    devices = summarizeAll(enumerate(instance));
  } catch (...) {
    vkDestroyInstance(instance, nullptr);
    throw;
  }
  vkDestroyInstance(instance, nullptr);
  return devices;
}

} // namespace vitrail::tool
