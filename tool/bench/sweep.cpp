#include "sweep.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "short_count.h"

namespace vitrail::tool {

namespace {

constexpr std::array<std::string_view, kSweepKinds.size()> kNames{"layers", "triangles", "resolution", "samples",
                                                                  "cap"};

constexpr std::uint32_t kMostPanes = 64;
constexpr std::uint32_t kMostPanesIfSlow = 32;
constexpr std::uint64_t kMostTriangles = 10'000'000;
constexpr std::uint64_t kMostTrianglesIfSlow = 600'000;
constexpr std::uint32_t kMostSamples = 8;

using Size = std::pair<std::uint32_t, std::uint32_t>;
constexpr std::array<Size, 5> kSizes{{{320, 180}, {640, 360}, {1280, 720}, {1920, 1080}, {3840, 2160}}};
constexpr std::array<Size, 4> kSizesIfSlow{{{160, 90}, {320, 180}, {640, 360}, {960, 540}}};

void addSizes(std::vector<SweepStep>& steps, const SweepStep& base, bool isSlow) {
  const auto add = [&](const Size& size) {
    SweepStep step = base;
    std::tie(step.width, step.height) = size;
    steps.push_back(step);
  };
  if (isSlow) {
    std::ranges::for_each(kSizesIfSlow, add);
  } else {
    std::ranges::for_each(kSizes, add);
  }
}

} // namespace

std::string_view nameOf(SweepKind kind) { return kNames.at(static_cast<std::size_t>(kind)); }

std::optional<SweepKind> sweepNamed(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return kSweepKinds.at(static_cast<std::size_t>(found - kNames.begin()));
}

std::vector<SweepStep> planSweep(SweepKind kind, const SweepStart& start) {
  const SweepStep base{{}, 0, start.width, start.height, start.samples, 0};
  std::vector<SweepStep> steps;
  SweepStep step = base;
  switch (kind) {
    case SweepKind::Layers:
      for (std::uint32_t panes = 1; panes <= (start.isSlow ? kMostPanesIfSlow : kMostPanes); panes *= 2) {
        step.panes = panes;
        steps.push_back(step);
      }
      break;
    case SweepKind::Triangles: {
      const std::uint64_t most = start.isSlow ? kMostTrianglesIfSlow : kMostTriangles;
      steps.push_back(step);
      for (std::uint64_t count = start.triangles * 4; count > 0 && count <= most; count *= 4) {
        ++step.splits;
        steps.push_back(step);
      }
      break;
    }
    case SweepKind::Resolution:
      addSizes(steps, base, start.isSlow);
      break;
    case SweepKind::Samples:
      for (std::uint32_t samples = 1; samples <= kMostSamples; samples *= 2) {
        step.samples = samples;
        steps.push_back(step);
      }
      break;
    case SweepKind::Cap:
      for (const std::uint32_t cap : start.caps) {
        step.cap = cap;
        steps.push_back(step);
      }
      break;
  }
  return steps;
}

MethodOptions withoutStep(MethodOptions options, SweepKind kind) {
  if (kind == SweepKind::Samples) options.samples = 1;
  if (kind == SweepKind::Cap) options.maxLayers = 0;
  return options;
}

SweepPlace placeOf(SweepKind kind, const SweepStep& step, std::uint64_t triangles) {
  switch (kind) {
    case SweepKind::Layers:
      return {kind, static_cast<double>(step.panes.value_or(0)), fmt::format("{}", step.panes.value_or(0))};
    case SweepKind::Triangles:
      return {kind, static_cast<double>(triangles), shortCount(triangles)};
    case SweepKind::Resolution:
      return {kind, static_cast<double>(step.width) * step.height, fmt::format("{}x{}", step.width, step.height)};
    case SweepKind::Cap:
      return {kind, static_cast<double>(step.cap), fmt::format("{}", step.cap)};
    case SweepKind::Samples:
      break;
  }
  return {kind, static_cast<double>(step.samples), fmt::format("{}", step.samples)};
}

} // namespace vitrail::tool
