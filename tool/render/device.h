// What pictures are drawn on: a Vulkan device, the processor by Vitrail's own rasteriser, or both.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "../gpu/device.h"
#include "../methods/method_options.h"
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
  std::string name; // as --device has it: kProcessor, or a Vulkan device as GpuOptions has it; empty: by `wish`
  bool validate = false;
  Wish wish = Wish::Fastest;
};

// The processor is always there and takes the method `cpu`; the Vulkan device takes all others. Where there is none the
// processor counts layers too (kLayerCount).
class Device {
 public:
  // Loads Vulkan only where a Vulkan device is named or wished for, or where there may be a GPU (gpu/presence.h).
  // Throws GpuError.
  explicit Device(const DeviceOptions& options);

  // Null: there is none.
  [[nodiscard]] Gpu* gpu() const { return gpu_.get(); }
  // The exact method of choice.
  [[nodiscard]] std::string_view exactMethod() const;

  // Throws GpuError, also where a method needs a Vulkan device and there is none.
  std::unique_ptr<Renderer> makeRenderer(const Scene& scene, std::optional<float> opacity, DrawOrder order,
                                         const MethodOptions& method) const;
  // The same of a scene that nobody else needs (StillRenderer).
  std::unique_ptr<Renderer> makeRenderer(Scene&& scene, std::optional<float> opacity,
                                         const MethodOptions& method) const;

 private:
  bool onProcessor(const MethodOptions& method) const;
  Gpu& vulkan() const;

  std::unique_ptr<Gpu> gpu_;
  std::string reason_; // why there is no Vulkan device
};

} // namespace vitrail::tool
