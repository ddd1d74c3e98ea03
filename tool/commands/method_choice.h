// Which exact method draws on a GPU where nobody named one: fragment lists, or the rasteriser in compute shaders, where
// that is faster there. Both are measured once on a device, and that is remembered in a file of the user's.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "../gpu/device.h"
#include "../scene/scene.h"

namespace vitrail::tool {

// What a method takes for one of the scenes that are measured.
struct MethodCost {
  double firstMs = 0.0; // from nothing to its first picture, by the clock: most of it goes into pipelines
  double nextMs = 0.0;  // of the device, for each picture after it
  bool operator==(const MethodCost&) const = default;
};

// Of each of these scenes, in order. Without `tiles`: the device does not offer it.
struct MethodCosts {
  std::vector<MethodCost> lists;
  std::vector<MethodCost> tiles;
  bool operator==(const MethodCosts&) const = default;
};

// $XDG_CACHE_HOME/vitrail/methods.json, or ~/.cache/vitrail/methods.json. Nothing where neither is named.
std::optional<std::filesystem::path> methodMemory();

// What this version of the tool remembers of a device (DeviceSummary::identity); nothing where that is nothing, or
// where the file cannot be read.
std::optional<MethodCosts> rememberedCosts(const std::filesystem::path& memory, const std::string& identity);
// Keeps it, beside what is remembered of other devices. Where the file cannot be written, nothing is remembered.
void rememberCosts(const std::filesystem::path& memory, const std::string& identity, const MethodCosts& costs);

// Draws the scenes by both methods, which takes a few seconds. Throws GpuError.
MethodCosts measureMethods(Gpu& gpu);

// Which of the two takes less for so many pictures of one scene: tiles where it does in each that was measured.
std::string fasterMethod(const MethodCosts& costs, std::uint64_t pictures);

// Fewer are drawn by lists, whatever is remembered: they are not worth a measurement, and what they look like to the
// bit does not hang on whether there was one.
inline constexpr std::uint64_t kManyPictures = 100;
// As many pictures as a window draws: what is made once does not count.
inline constexpr std::uint64_t kPicturesOfAWindow = 100'000;

// The method for so many pictures of any scene. It is measured where nothing is remembered, and `onMeasure` is called
// before. Of few pictures, on drivers for CPUs, and where nothing can be measured or remembered, it is fragment lists.
// Throws DeviceLost.
std::string methodFor(Gpu& gpu, std::uint64_t pictures, const std::function<void()>& onMeasure);

// Whether tiles draws that scene as fragment lists do.
bool drawsAlike(const Scene& scene);

} // namespace vitrail::tool
