#include "matrix.h"

#include <algorithm>

namespace vitrail::tool {

namespace {

constexpr std::uint32_t kMostCompactSamples = 4;

// Whether the node format and the resolve of a method can be chosen.
bool hasChoices(std::string_view method) { return traitsOf(method).nodes && traitsOf(method).resolves; }

bool same(const MethodOptions& a, const MethodOptions& b) {
  return a.name == b.name && a.samples == b.samples && a.nodes == b.nodes && a.resolve == b.resolve;
}

// Adds what a method has at a sample count.
void addMethod(std::vector<MethodOptions>& list, const std::string& method, std::uint32_t samples,
               const BenchMatrix& matrix) {
  const auto add = [&](const MethodOptions& options) {
    const bool known = std::ranges::any_of(list, [&](const MethodOptions& each) { return same(each, options); });
    if (!known) list.push_back(options);
  };
  MethodOptions options;
  options.name = method;
  options.samples = samples;
  if (!traitsOf(method).severalSamples && samples > 1) return;
  if (!hasChoices(method)) return add(options);
  for (const VitrailNodeFormat nodes : matrix.nodes) {
    if (nodes == VITRAIL_NODE_COMPACT && samples > kMostCompactSamples) continue;
    for (const VitrailResolve resolve : matrix.resolves) {
      options.nodes = nodes;
      options.resolve = resolve;
      add(options);
    }
  }
}

} // namespace

std::vector<MethodOptions> configurationsOf(const BenchMatrix& matrix) {
  std::vector<MethodOptions> list;
  for (const std::uint32_t samples : matrix.samples) {
    addMethod(list, std::string(kBaselineMethod), samples, matrix);
    for (const std::string& method : matrix.methods) addMethod(list, method, samples, matrix);
  }
  return list;
}

std::string describe(const MethodOptions& options) {
  std::string text = options.name;
  if (hasChoices(options.name)) text.append(", ").append(nameOf(options.nodes));
  if (options.samples > 1) text.append(", ").append(std::to_string(options.samples)).append(" samples");
  if (hasChoices(options.name) && options.resolve != VITRAIL_RESOLVE_DEFAULT) {
    text.append(", ").append(nameOf(options.resolve));
  }
  return text;
}

} // namespace vitrail::tool
