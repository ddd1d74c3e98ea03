#include "matrix.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "../methods/methods.h"

namespace vitrail::tool {

namespace {

// Whether the node format, the resolve and the list build of a method can be chosen.
bool hasChoices(std::string_view method) {
  const MethodTraits& traits = traitsOf(method);
  return traits.takes(kTakesNodes) && traits.takes(kTakesResolve) && traits.takes(kTakesListBuild);
}

bool holds(const BenchSettings& settings, const MethodOptions& options) {
  const auto isIt = [&](const MethodOptions& each) { return each == options; };
  return std::ranges::any_of(settings.measured, isIt) ||
         std::ranges::any_of(settings.skipped, isIt, &SkippedSetting::options);
}

void addSetting(BenchSettings& settings, const MethodOptions& options) {
  if (holds(settings, options)) return;
  try {
    checkMethodOptions(options);
    settings.measured.push_back(options);
  } catch (const std::invalid_argument& error) {
    settings.skipped.push_back({options, error.what()});
  }
}

// Each setting with every one of the values, where the method has the option.
template <typename Value>
void expand(std::vector<MethodOptions>& all, MethodOption option, Value MethodOptions::*member,
            const std::vector<Value>& values) {
  if (!traitsOf(all.front().name).takes(option)) return;
  std::vector<MethodOptions> expanded;
  for (const MethodOptions& options : all) {
    for (const Value value : values) {
      expanded.push_back(options);
      expanded.back().*member = value;
    }
  }
  all = std::move(expanded);
}

// Adds what a method has at a sample count.
void addMethod(BenchSettings& settings, std::string_view method, std::uint32_t samples, Api api,
               const BenchMatrix& matrix) {
  MethodOptions options;
  options.name = method;
  options.api = api;
  options.samples = samples;
  std::vector<MethodOptions> all{withLimits(options, matrix.limits)};
  expand(all, kTakesNodes, &MethodOptions::nodes, matrix.nodes);
  expand(all, kTakesResolve, &MethodOptions::resolve, matrix.resolves);
  expand(all, kTakesListBuild, &MethodOptions::listBuild, matrix.listBuilds);
  expand(all, kTakesMsaaResolve, &MethodOptions::msaaResolve, matrix.msaaResolves);
  expand(all, kTakesStencilMark, &MethodOptions::stencilMark, matrix.stencilMarks);
  expand(all, kTakesOverflow, &MethodOptions::nodeCapacity, matrix.nodeCapacities);
  expand(all, kTakesMemoryBudget, &MethodOptions::memoryBudget, matrix.memoryBudgets);
  if (!matrix.layers.empty()) expand(all, kTakesLayers, &MethodOptions::maxLayers, matrix.layers);
  for (const MethodOptions& each : all) addSetting(settings, each);
}

// The processor draws once, beside the first API; of OpenGL's methods those that are not there are left out where all
// are meant.
bool isMeasuredWith(std::string_view method, Api api, const BenchMatrix& matrix) {
  const MethodTraits& traits = traitsOf(method);
  if (traits.onProcessor) return api == matrix.apis.front();
  return api == Api::Vulkan || traits.makeGl != nullptr || !matrix.methods.empty();
}

} // namespace

MethodOptions withLimits(MethodOptions options, const MethodLimits& limits) {
  const MethodTraits& traits = traitsOf(options.name);
  if (traits.takes(kTakesLayers)) options.maxLayers = limits.layers;
  if (traits.takes(kTakesPasses)) options.passes = limits.passes;
  return options;
}

void checkLimits(const std::vector<std::string>& methods, const MethodLimits& limits) {
  const auto check = [&](MethodOption bit, std::uint32_t MethodOptions::*option, std::uint32_t limit) {
    const auto hasIt = [&](const std::string& name) { return traitsOf(name).takes(bit); };
    if (limit == 0 || methods.empty() || std::ranges::any_of(methods, hasIt)) return;
    MethodOptions options;
    options.name = methods.front();
    options.*option = limit;
    checkMethodOptions(options); // says whose option it is
  };
  check(kTakesLayers, &MethodOptions::maxLayers, limits.layers);
  check(kTakesPasses, &MethodOptions::passes, limits.passes);
}

std::string describe(const MethodLimits& limits) {
  std::string text;
  if (limits.layers > 0) text += fmt::format(" --layers {}", limits.layers);
  if (limits.passes > 0) text += fmt::format(" --passes {}", limits.passes);
  return text.empty() ? text : fmt::format("Of the methods that have the option:{}\n", text);
}

BenchSettings configurationsOf(const BenchMatrix& matrix) {
  std::vector<std::string_view> methods(matrix.methods.begin(), matrix.methods.end());
  if (methods.empty()) methods.assign(methodNames().begin(), methodNames().end());
  BenchSettings settings;
  for (const std::uint32_t samples : matrix.samples) {
    for (const Api api : matrix.apis) {
      addMethod(settings, kBaselineMethod, samples, api, matrix);
      for (const std::string_view method : methods) {
        if (isMeasuredWith(method, api, matrix)) addMethod(settings, method, samples, api, matrix);
      }
    }
  }
  return settings;
}

std::string labelOf(const MethodOptions& options) {
  const bool isUsual = options.api == Api::Vulkan || traitsOf(options.name).onProcessor;
  return isUsual ? options.name : options.name + ", OpenGL";
}

std::string describe(const MethodOptions& options) {
  std::string text = labelOf(options);
  if (hasChoices(options.name)) text.append(", ").append(nameOf(options.nodes));
  if (options.samples > 1) text.append(", ").append(std::to_string(options.samples)).append(" samples");
  if (hasChoices(options.name) && options.resolve != VITRAIL_RESOLVE_DEFAULT) {
    text.append(", ").append(nameOf(options.resolve));
  }
  if (hasChoices(options.name) && options.listBuild != VITRAIL_LIST_BUILD_DEFAULT) {
    text.append(", list build ").append(nameOf(options.listBuild));
  }
  if (options.msaaResolve != VITRAIL_MSAA_RESOLVE_PER_PIXEL) text.append(", ").append(nameOf(options.msaaResolve));
  if (options.stencilMark != StencilMark::On) text.append(", stencil mark ").append(nameOf(options.stencilMark));
  if (options.nodeCapacity > 0) text += fmt::format(", {} nodes at most", options.nodeCapacity);
  if (options.memoryBudget > 0) text += fmt::format(", in {} MiB", options.memoryBudget);
  if (options.maxLayers > 0)
    text += fmt::format(", {} {}", options.maxLayers, options.maxLayers > 1 ? "layers" : "layer");
  if (options.passes > 0) text += fmt::format(", {} {}", options.passes, options.passes > 1 ? "passes" : "pass");
  return text;
}

std::string describeWithoutSamples(MethodOptions options) {
  options.samples = 1;
  return describe(options);
}

} // namespace vitrail::tool
