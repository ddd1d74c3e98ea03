// What `vitrail render` was asked for, with every text already understood.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "../methods/method_options.h"
#include "output_format.h"
#include "scene_options.h"

namespace vitrail::tool {

struct RenderArguments : SceneArguments, OutputArguments {
  MethodOptions method;
  std::optional<std::uint32_t> memoryBudget; // MiB
  std::string device;
  std::string json; // empty: no report
  bool validate = false;
};

// Adds the options to a command. Texts that cannot be understood end the parse with a CLI::ValidationError.
void addRenderOptions(CLI::App& command, RenderArguments& arguments);

// Checks what one option alone does not show. Throws UsageError.
void checkRenderArguments(const RenderArguments& arguments);

std::string renderHelp();

} // namespace vitrail::tool
