// What `vitrail render` was asked for, with every text already understood.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "../methods/method_options.h"
#include "../scene/camera.h"
#include "../scene/scene.h"

namespace vitrail::tool {

struct RenderArguments {
  std::string model; // empty: a built-in scene
  std::string scene;
  std::optional<std::uint32_t> count;
  std::optional<std::uint32_t> seed;
  std::string output;
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  std::optional<std::uint32_t> camera;
  std::optional<Orbit> orbit;
  std::optional<float> opacity;
  std::optional<Background> background;
  MethodOptions method;
  std::optional<std::uint32_t> memoryBudget; // MiB
  std::string device;
  std::string json; // empty: no report
  bool validate = false;
  bool quiet = false;
};

// Adds the options to a command. Texts that cannot be understood end the parse with a CLI::ValidationError.
void addRenderOptions(CLI::App& command, RenderArguments& arguments);

// Checks what one option alone does not show. Throws UsageError.
void checkRenderArguments(const RenderArguments& arguments);

extern const char* const kRenderHelp;

} // namespace vitrail::tool
