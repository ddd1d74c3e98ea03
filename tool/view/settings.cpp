#include "settings.h"

#include <stdexcept>
#include <utility>

#include "../methods/methods.h"
#include "../methods/shared/device_needs.h"

namespace vitrail::tool {

namespace {

constexpr const char* kUnsorted = "unsorted";

// Why a device does not draw by a method; empty: it does.
std::string lackOf(const Device& device, std::string_view name) {
  const MethodTraits& traits = traitsOf(name);
  if (traits.onProcessor || (device.gl() != nullptr && traits.makeGl != nullptr)) return {};
  if (device.gpu() != nullptr) return lackFor(*device.gpu(), name);
  if (device.gl() != nullptr) return "the method " + std::string(name) + " is not there with OpenGL";
  return "the method " + std::string(name) + " needs a Vulkan device";
}

// Whether it can leave surfaces out.
bool canPeel(const MethodOptions& method) {
  try {
    MethodOptions checked = method;
    if (traitsOf(method.name).onProcessor) checked.api = Api::Vulkan;
    checkPictureOptions(checked, false, true);
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

} // namespace

std::vector<std::string> methodsOf(const Device& device) {
  std::vector<std::string> names;
  for (const std::string_view name : methodNames()) {
    if (lackOf(device, name).empty()) names.emplace_back(name);
  }
  return names;
}

std::vector<MissingMethod> missingMethodsOf(const Device& device) {
  std::vector<MissingMethod> missing;
  for (const std::string_view name : methodNames()) {
    if (std::string lack = lackOf(device, name); !lack.empty()) missing.push_back({std::string(name), std::move(lack)});
  }
  return missing;
}

void chooseMethod(RenderArguments& arguments, const std::string& name) {
  const MethodOptions before = arguments.method;
  const MethodTraits& traits = traitsOf(name);
  MethodOptions& method = arguments.method;
  method = {};
  method.name = name;
  const bool keepsApi = traits.makeGl != nullptr || traits.onProcessor; // which needs none, and goes back to it
  if (keepsApi) method.api = before.api;
  if (traits.takes(kTakesSamples)) method.samples = before.samples;
  if (traits.takes(kTakesNodes)) method.nodes = before.nodes;
  if (traits.takes(kTakesResolve)) method.resolve = before.resolve;
  if (traits.takes(kTakesListBuild)) method.listBuild = before.listBuild;
  if (traits.takes(kTakesMsaaResolve)) method.msaaResolve = before.msaaResolve;
  if (traits.takes(kTakesLayers)) method.maxLayers = before.maxLayers;
  if (traits.takes(kTakesPasses)) method.passes = before.passes;
  if (!traits.takes(kTakesMemoryBudget)) arguments.memoryBudget.reset();
  if (traits.takes(kTakesSorting)) method.sorted = before.sorted;
  try {
    MethodOptions checked = method;
    if (traits.onProcessor) checked.api = Api::Vulkan;
    checkMethodOptions(checked);
  } catch (const std::invalid_argument&) { // they exclude each other here
    const Api api = method.api;
    method = {};
    method.name = name;
    method.api = api;
  }
  if (!canPeel(method)) arguments.peel.reset();
}

void choosePeel(RenderArguments& arguments, std::uint32_t count) {
  if (count > 0 && arguments.method.name == kListMethod) { // what does not go with it
    arguments.method.sorted = true;
    arguments.method.maxLayers = 0;
    arguments.method.nodeCapacity = 0;
    arguments.method.msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  }
  if (count > 0 && !canPeel(arguments.method)) {
    chooseMethod(arguments, std::string(arguments.method.name == kTilesMethod ? kListMethod : kCpuMethod));
  }
  arguments.peel.reset();
  if (count > 0) arguments.peel = count;
}

bool Sorting::isOn(const RenderArguments& arguments) {
  return arguments.method.name != kUnsorted && arguments.method.sorted;
}

bool Sorting::isChoice(const Device& device) { return device.gpu() != nullptr || device.gl() != nullptr; }

void Sorting::set(RenderArguments& arguments, bool on) {
  if (on == isOn(arguments)) return;
  if (arguments.method.name == kListMethod && arguments.method.api == Api::Vulkan) {
    arguments.method.sorted = on;
    if (on) return;
    arguments.peel.reset(); // what does not go with it
    arguments.method.maxLayers = 0;
    arguments.method.nodeCapacity = 0;
    arguments.method.msaaResolve = VITRAIL_MSAA_RESOLVE_PER_PIXEL;
  } else if (!on) {
    sorted_.method = arguments.method;
    sorted_.memoryBudget = arguments.memoryBudget;
    hasSorted_ = true;
    chooseMethod(arguments, kUnsorted);
  } else if (hasSorted_) {
    arguments.method = sorted_.method;
    arguments.memoryBudget = sorted_.memoryBudget;
  } else {
    chooseMethod(arguments, std::string(kListMethod));
  }
}

} // namespace vitrail::tool
