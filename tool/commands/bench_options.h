// What `vitrail bench` was asked for, with every text already understood.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "../bench/matrix.h"
#include "../bench/sweep.h"
#include "../scene/load.h"
#include "warnings.h"

namespace vitrail::tool {

struct BenchArguments : WarningOptions {
  std::string model; // empty: built-in scenes
  LoadOptions load;
  std::vector<std::string> scenes;
  std::vector<std::uint32_t> counts; // none, one for all scenes, or one each
  BenchMatrix matrix;
  std::vector<SweepKind> sweeps;
  std::vector<std::uint32_t> caps; // of the sweep over them; none: its own
  Overflow overflow = Overflow::Grow;
  std::uint32_t width = 0; // 0: by the kind of device, and of a sweep over resolutions its own
  std::uint32_t height = 0;
  std::optional<float> opacity;
  std::optional<std::uint32_t> repeats; // default: by the kind of device
  std::optional<std::uint32_t> warmups;
  std::string device;
  std::string json;   // empty: no report
  std::string csv;    // empty: none
  std::string folder; // empty: no page
};

// Adds the options to a command. Texts that cannot be understood end the parse with a CLI::ValidationError.
void addBenchOptions(CLI::App& command, BenchArguments& arguments);

// Checks what one option alone does not show, and fills in the default scenes. Throws UsageError.
void checkBenchArguments(const CLI::App& command, BenchArguments& arguments);

std::string benchHelp();

} // namespace vitrail::tool
