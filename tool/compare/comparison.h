// Transparency methods against the exact picture: what each gets wrong and what it costs.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "../bench/machine.h"
#include "../bench/matrix.h"
#include "../bench/measurement.h"
#include "../image/metrics.h"
#include "../render/device.h"

namespace vitrail::tool {

struct ComparedMethod {
  Measurement measurement; // its costs, and what its frame held
  Picture picture;
  Difference difference; // to the exact picture
};

// A method that the device or the options do not allow, and why.
struct RefusedMethod {
  std::string name; // as labelOf() has it
  std::string reason;
};

struct Comparison : Machine {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 1;
  MethodLimits limits;
  std::uint32_t repeats = 0;
  std::uint32_t warmups = 0;
  std::string scene;                  // what the picture is of, in words
  std::optional<std::uint32_t> count; // of a built-in scene, where it was chosen
  std::uint64_t triangles = 0;
  std::vector<std::string> warnings; // of the scene
  Picture exact;
  bool isEmpty = false; // it shows the background alone
  FrameReport exactFrame;
  // The fragments of each pixel at its centre, whatever the samples, and the most that a pixel has.
  Plane layers;
  std::uint32_t layersMax = 0;
  std::vector<ComparedMethod> methods; // of each API the baseline, then as asked for
  std::vector<RefusedMethod> refused;
};

struct ComparisonRun {
  std::vector<std::string> methods; // of methodNames(); none: all of them
  std::vector<Api> apis = {Api::Vulkan};
  std::uint32_t samples = 1;
  MethodLimits limits;
  RenderOptions picture;
  std::optional<float> opacity; // of every material
  std::uint32_t repeats = 1;    // as BenchRun's
  std::uint32_t warmups = 1;
  std::function<void(const std::string& step)> progress; // told of every step, for people who wait
};

// The exact picture is that of linked-list with hdr nodes and as many samples, of `cpu` where there is no Vulkan
// device. Costs are measured as `vitrail bench` measures them, the methods' frames taking turns, and compared with the
// baseline's (bench/matrix.h), which is always there. Leaves `scene` and `count` to the caller. Throws GpuError where
// the exact picture cannot be drawn, std::runtime_error where nothing in it is transparent.
Comparison compareMethods(Device& device, const Scene& scene, const ComparisonRun& run);

} // namespace vitrail::tool
