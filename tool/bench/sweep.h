// Sweeps: one thing about a picture grows from step to step, and all else stays.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../methods/method_options.h"

namespace vitrail::tool {

enum class SweepKind { Layers, Triangles, Resolution, Samples, Cap };

inline constexpr std::array kSweepKinds{SweepKind::Layers, SweepKind::Triangles, SweepKind::Resolution,
                                        SweepKind::Samples, SweepKind::Cap};

// "layers", "triangles", "resolution", "samples", "cap".
std::string_view nameOf(SweepKind kind);

// The sweep of that name; nothing for another text.
std::optional<SweepKind> sweepNamed(std::string_view name);

// Where a measurement stands in a sweep.
struct SweepPlace {
  SweepKind kind = SweepKind::Layers;
  double value = 0.0; // layers, triangles, pixels, samples, or layers that are blended exactly
  std::string label;  // the same for people: "8", "131 k", "1280x720"
};

// One step: what differs from the other steps, and the rest.
struct SweepStep {
  std::optional<std::uint32_t> panes; // of the scene planes: layers
  std::uint32_t splits = 0;           // how often every triangle is split into four (scene/split.h): triangles
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 1;
  std::uint32_t cap = 0; // MethodLimits::layers; 0: what was chosen
};

// What a sweep starts from.
struct SweepStart {
  bool isSlow = false; // few and small steps: a frame takes long there
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 1;
  std::uint64_t triangles = 0;                   // of the scene: bounds the splits
  std::vector<std::uint32_t> caps = {8, 16, 32}; // in rising order
};

// The steps of a sweep, the smallest first. There is at least one.
std::vector<SweepStep> planSweep(SweepKind kind, const SweepStart& start);

// A setting without what the sweep changes, so that it has one name at all steps.
MethodOptions withoutStep(MethodOptions options, SweepKind kind);

// The place of a step whose scene turned out to have this many triangles.
SweepPlace placeOf(SweepKind kind, const SweepStep& step, std::uint64_t triangles);

} // namespace vitrail::tool
