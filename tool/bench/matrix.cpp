#include "matrix.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "../methods/methods.h"

namespace vitrail::tool {

namespace {

// Whether the node format, the resolve and the list build of a method can be chosen.
bool hasChoices(std::string_view method) {
  const MethodTraits& traits = traitsOf(method);
  return traits.takes(kTakesNodes) && traits.takes(kTakesResolve) && traits.takes(kTakesListBuild);
}

bool same(const MethodOptions& a, const MethodOptions& b) {
  return a.name == b.name && a.samples == b.samples && a.nodes == b.nodes && a.resolve == b.resolve &&
         a.listBuild == b.listBuild;
}

bool holds(const BenchSettings& settings, const MethodOptions& options) {
  const auto isIt = [&](const MethodOptions& each) { return same(each, options); };
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

// Adds what a method has at a sample count.
void addMethod(BenchSettings& settings, std::string_view method, std::uint32_t samples, const BenchMatrix& matrix) {
  MethodOptions options;
  options.name = method;
  options.samples = samples;
  options = withLimits(options, matrix.limits);
  if (!hasChoices(method)) return addSetting(settings, options);
  for (const VitrailNodeFormat nodes : matrix.nodes) {
    for (const VitrailResolve resolve : matrix.resolves) {
      for (const VitrailListBuild listBuild : matrix.listBuilds) {
        options.nodes = nodes;
        options.resolve = resolve;
        options.listBuild = listBuild;
        addSetting(settings, options);
      }
    }
  }
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
    addMethod(settings, kBaselineMethod, samples, matrix);
    for (const std::string_view method : methods) addMethod(settings, method, samples, matrix);
  }
  return settings;
}

std::string describe(const MethodOptions& options) {
  std::string text = options.name;
  if (hasChoices(options.name)) text.append(", ").append(nameOf(options.nodes));
  if (options.samples > 1) text.append(", ").append(std::to_string(options.samples)).append(" samples");
  if (hasChoices(options.name) && options.resolve != VITRAIL_RESOLVE_DEFAULT) {
    text.append(", ").append(nameOf(options.resolve));
  }
  if (hasChoices(options.name) && options.listBuild != VITRAIL_LIST_BUILD_DEFAULT) {
    text.append(", list build ").append(nameOf(options.listBuild));
  }
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
