#include "device.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "../gpu/presence.h"
#include "../methods/methods.h"
#include "cpu_still.h"
#include "gl_still.h"
#include "still.h"

namespace vitrail::tool {

bool isProcessor(std::string_view device) {
  return std::ranges::equal(device, kProcessor, [](unsigned char a, char b) { return std::tolower(a) == b; });
}

Device::Device(const DeviceOptions& options) {
  if (options.openGl) gl_ = std::make_unique<Gl>(GlOptions{options.name, options.validate});
  if (!options.vulkan) {
    reason_ = "add vulkan to --api";
    return;
  }
  if (isProcessor(options.name) || (options.name.empty() && options.wish == Wish::Processor)) {
    reason_ = options.name.empty() ? "name one with --device" : "leave --device cpu out";
    return;
  }
  GpuOptions gpu{options.name, options.validate, false, options.instanceExtensions, options.presents, false};
  if (!options.name.empty() || options.wish == Wish::Vulkan) {
    gpu_ = std::make_unique<Gpu>(gpu);
    return;
  }
  const bool onlyGpus = options.wish == Wish::Fastest;
  if (onlyGpus && !mayHaveGpu()) return;
  try {
    gpu.onlyGpus = onlyGpus;
    gpu_ = std::make_unique<Gpu>(gpu);
  } catch (const GpuError& error) { // the processor can do it too
    reason_ = error.what();
  }
}

MethodOptions Device::exactMethod() const {
  MethodOptions exact;
  exact.name = gpu_ || gl_ ? kListMethod : kCpuMethod;
  exact.api = !gpu_ && gl_ ? Api::OpenGl : Api::Vulkan;
  return exact;
}

Gl& Device::openGl() const {
  if (gl_) return *gl_;
  throw GpuError("there is no OpenGL device: add --api opengl");
}

Gpu& Device::vulkan() const {
  if (gpu_) return *gpu_;
  throw GpuError("methods but cpu need a Vulkan device: " + reason_);
}

bool Device::onProcessor(const MethodOptions& method) const {
  return traitsOf(method.name).onProcessor || (!gpu_ && method.name == kLayerCount);
}

std::unique_ptr<Renderer> Device::makeRenderer(const Scene& scene, std::optional<float> opacity, DrawOrder order,
                                               const MethodOptions& method) const {
  if (onProcessor(method)) return std::make_unique<CpuStillRenderer>(scene, opacity, order, method);
  if (method.api == Api::OpenGl) return std::make_unique<GlStillRenderer>(openGl(), scene, opacity, order, method);
  return std::make_unique<StillRenderer>(vulkan(), scene, opacity, order, method);
}

std::unique_ptr<Renderer> Device::makeRenderer(Scene&& scene, std::optional<float> opacity,
                                               const MethodOptions& method) const {
  if (onProcessor(method)) return std::make_unique<CpuStillRenderer>(std::move(scene), opacity, method);
  if (method.api == Api::OpenGl) return std::make_unique<GlStillRenderer>(openGl(), std::move(scene), opacity, method);
  return std::make_unique<StillRenderer>(vulkan(), std::move(scene), opacity, method);
}

} // namespace vitrail::tool
