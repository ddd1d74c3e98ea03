// The Vulkan device that the tool renders on, headless.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <volk.h>

#include "features.h"
#include "gpu_error.h"

namespace vitrail::tool {

inline constexpr const char* kVulkanApi = "Vulkan 1.3"; // what it draws with

// What `vitrail info` shows of a device.
struct DeviceSummary {
  std::uint32_t index = 0; // what --device takes
  std::string name;
  std::string kind;     // "discrete GPU", "integrated GPU", "virtual GPU", "CPU", "other"
  std::string driver;   // name and version, as the driver words them
  std::string identity; // identityOf()
  std::uint32_t apiVersion = 0;
  std::string missing;                  // empty: the tool can render on it; else what it lacks, in words
  std::uint32_t maxPictureSide = 0;     // pixels (maxImageDimension2D)
  std::uint64_t maxBindingBytes = 0;    // what one shader can reach of one buffer (maxStorageBufferRange)
  std::uint64_t maxAllocationBytes = 0; // the largest single allocation (maxMemoryAllocationSize)
  std::uint64_t memoryBytes = 0;        // the largest device-local heap
  GpuFeatures features;
  bool timestamps = false; // false: passes are not timed
};

// What measurements of a device are remembered by: its name and its driver, in words. Not by where it is plugged in;
// and nothing is known of a device whose driver has changed.
std::string identityOf(const VkPhysicalDeviceProperties& properties);

// A GPU, not a CPU driver, that the tool can render on.
bool isUsableGpu(const DeviceSummary& device);

struct GpuOptions {
  // "" takes the best device (discrete, integrated, virtual, CPU; the first of a kind), a number the device of that
  // index, anything else a device whose name contains it, in any case.
  std::string device;
  // Runs under the Khronos validation layer with synchronization validation; a missing layer is a GpuError.
  bool validate = false;
  bool onlyGpus = false; // isUsableGpu()
  // For windows: what the instance is made with beside the tool's own, and whether a queue family shows pictures in
  // them. With it a device that does has VK_KHR_swapchain, and `onlyPresenting` leaves the others out.
  std::vector<const char*> instanceExtensions{};
  std::function<bool(VkInstance, VkPhysicalDevice, std::uint32_t queueFamily)> presents{};
  bool onlyPresenting = false;
};

// Instance, device and one queue with graphics and compute, made for Vulkan 1.3 with dynamic rendering,
// synchronization2 and those of GpuFeatures that the device has. Several threads may use it at once.
class Gpu {
 public:
  explicit Gpu(const GpuOptions& options);
  ~Gpu();
  Gpu(const Gpu&) = delete;
  Gpu& operator=(const Gpu&) = delete;

  VkInstance instance() const;
  VkPhysicalDevice physicalDevice() const;
  VkDevice device() const;
  std::uint32_t queueFamily() const;
  bool presents() const; // GpuOptions::presents
  const VkPhysicalDeviceProperties& properties() const;
  // What the device was made with.
  const GpuFeatures& features() const;
  const VkPhysicalDeviceMemoryProperties& memoryProperties() const;
  // The largest single allocation, in bytes.
  std::uint64_t maxAllocation() const;
  std::uint64_t localMemory() const; // bytes of the largest device-local heap

  // The queue's calls, one at a time: what a thread submits comes behind all that any has submitted before.
  VkResult submit(const VkSubmitInfo2& info, VkFence fence);
  VkResult present(const VkPresentInfoKHR& info);
  VkResult waitIdle(); // for all that was submitted

  // Destroys the device, so that validationErrors() also tells of objects that outlived it. Nothing else may be called
  // afterwards.
  void close();

  // The validation layer's errors so far, one text each. Empty where validation is off.
  std::vector<std::string> validationErrors() const;

  // Accounting of device memory, for FrameReport::peakBytes. Every allocation of the tool is added and subtracted.
  void memoryAllocated(std::uint64_t bytes);
  void memoryFreed(std::uint64_t bytes);
  std::uint64_t memoryHeld() const;
  std::uint64_t peakMemory() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// All Vulkan devices of this machine, in the loader's order. Throws GpuError where there is no Vulkan loader or driver.
std::vector<DeviceSummary> listDevices();

} // namespace vitrail::tool
