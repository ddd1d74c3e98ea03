// The built-in scenes: what tests and benchmarks draw, and what a user can try without a model.
// Each is a pure function of its count and seed: the same values on every machine.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "../camera.h"
#include "../scene.h"

namespace vitrail::tool {

struct BuiltinOptions {
  std::optional<std::uint32_t> count; // default: the scene's own
  std::uint32_t seed = 1;
};

struct BuiltinScene {
  std::string_view name;
  std::string_view summary;      // one line for `vitrail scenes`
  std::string_view countMeaning; // what --count counts, e.g. "spheres"
  std::uint32_t defaultCount;
  std::uint32_t maxCount;
  Scene (*make)(std::uint32_t count, std::uint32_t seed);
};

// All built-in scenes, in the order of `vitrail scenes`.
std::span<const BuiltinScene> builtinScenes();

// Makes a scene by name. Throws std::invalid_argument with a one-line reason for an unknown name (it lists the known
// ones) or a count outside 1 to maxCount.
Scene makeBuiltinScene(std::string_view name, const BuiltinOptions& options);

} // namespace vitrail::tool
