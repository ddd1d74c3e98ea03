// What the user of a window chooses, and what follows from it.
#pragma once

#include <string>
#include <vector>

#include "../commands/render_options.h"
#include "../render/device.h"

namespace vitrail::tool {

// The methods that draw on a device, by name.
std::vector<std::string> methodsOf(const Device& device);
// All others, with the reason.
struct MissingMethod {
  std::string name;
  std::string reason;
};
std::vector<MissingMethod> missingMethodsOf(const Device& device);

// Draws by another method: what it does not take of the options of the one before is as it is by default.
void chooseMethod(RenderArguments& arguments, const std::string& name);

// Leaves out so many of the nearest surfaces of each pixel, by the method of now where that can, else by the method
// cpu.
void choosePeel(RenderArguments& arguments, std::uint32_t count);

// As the fragments are sorted, or not: linked-list on a Vulkan device blends its lists in the order in which fragments
// arrived; instead of other methods unsorted draws, which blends in the order of drawing.
class Sorting {
 public:
  [[nodiscard]] static bool isOn(const RenderArguments& arguments);
  // Whether the device can draw without.
  [[nodiscard]] static bool isChoice(const Device& device);
  void set(RenderArguments& arguments, bool on);

 private:
  RenderArguments sorted_; // the method to go back to
  bool hasSorted_ = false;
};

} // namespace vitrail::tool
