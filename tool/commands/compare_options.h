// What `vitrail compare` was asked for, with every text already understood.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "../bench/matrix.h"
#include "scene_options.h"

namespace vitrail::tool {

struct CompareArguments : SceneArguments {
  std::vector<std::string> files;   // two pictures, models, or none: a built-in scene
  std::vector<std::string> methods; // none: all
  std::vector<Api> apis = {Api::Vulkan};
  std::uint32_t samples = 1;
  MethodLimits limits;
  std::optional<std::uint32_t> repeats; // default: by the kind of device
  std::optional<std::uint32_t> warmups;
  std::string folder;  // empty: no page and no pictures
  std::string heatmap; // empty: none
  std::string json;    // empty: no report
  std::string device;
  bool validate = false;

  bool pictures() const; // whether two of them are compared
};

// Adds the options to a command. Texts that cannot be understood end the parse with a CLI::ValidationError.
void addCompareOptions(CLI::App& command, CompareArguments& arguments);

// Checks what one option alone does not show, and takes the models from the files. Throws UsageError.
void checkCompareArguments(const CLI::App& command, CompareArguments& arguments);

// Has the marks of withSceneHelp(), withDeviceHelp() and withApiHelp().
extern const char* const kCompareHelp;

} // namespace vitrail::tool
