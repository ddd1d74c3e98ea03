// What pictures are drawn on: a Vulkan device, an OpenGL device, the processor by Vitrail's own rasteriser.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../gpu/device.h"
#include "../methods/method_options.h"
#include "../opengl/gl.h"
#include "../stage/draw_order.h"
#include "renderer.h"

namespace vitrail::tool {

// What --device calls the processor, in any case.
inline constexpr std::string_view kProcessor = "cpu";
bool isProcessor(std::string_view device);

// What to open where no device is named.
enum class Wish {
  Fastest,      // a GPU, else the processor
  Processor,    // no Vulkan device
  Vulkan,       // the best Vulkan device, a CPU driver too
  VulkanIfThere // the same, else the processor alone
};

struct DeviceOptions {
  std::string name; // as --device has it: kProcessor, or a device as GpuOptions has it; empty: by `wish`
  bool validate = false;
  Wish wish = Wish::Fastest;
  bool vulkan = true;  // false: no Vulkan device, whatever is wished
  bool openGl = false; // an OpenGL device beside it
  // As GpuOptions has them, of windows that may show the Vulkan device's pictures.
  std::vector<const char*> instanceExtensions{};
  std::function<bool(VkInstance, VkPhysicalDevice, std::uint32_t queueFamily)> presents{};
};

// The processor is always there and takes the method `cpu`; the Vulkan device takes all others, and the OpenGL device
// those with Api::OpenGl. Where there is no Vulkan device the processor counts layers too (kLayerCount).
class Device {
 public:
  // Loads Vulkan only where a Vulkan device is named or wished for, or where there may be a GPU (gpu/presence.h).
  // Throws GpuError.
  explicit Device(const DeviceOptions& options);

  // Null: there is none.
  [[nodiscard]] Gpu* gpu() const { return gpu_.get(); }
  [[nodiscard]] Gl* gl() const { return gl_.get(); } // the same of OpenGL
  // The exact method of choice, with its API: Vulkan where there is a device.
  [[nodiscard]] MethodOptions exactMethod() const;

  // Throws GpuError, also where a method needs a Vulkan device and there is none.
  std::unique_ptr<Renderer> makeRenderer(const Scene& scene, std::optional<float> opacity, DrawOrder order,
                                         const MethodOptions& method) const;
  // The same of a scene that nobody else needs (StillRenderer).
  std::unique_ptr<Renderer> makeRenderer(Scene&& scene, std::optional<float> opacity,
                                         const MethodOptions& method) const;

 private:
  bool onProcessor(const MethodOptions& method) const;
  Gpu& vulkan() const;

  Gl& openGl() const;

  std::unique_ptr<Gpu> gpu_;
  std::unique_ptr<Gl> gl_;
  std::string reason_; // why there is no Vulkan device
};

} // namespace vitrail::tool
