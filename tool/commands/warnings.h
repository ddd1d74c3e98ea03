// What pictures lack, said to a person.
#pragma once

#include <span>
#include <string>

#include <CLI/CLI.hpp>

namespace vitrail::tool {

struct WarningOptions {
  bool quiet = false;  // says nothing
  bool strict = false; // a warning is an error
};

// --quiet and --strict.
void addWarningOptions(CLI::App& command, WarningOptions& options);

// Writes each as a line of its own to standard error, `vitrail: warning: ...`. Under `strict` throws std::runtime_error
// with the first of them instead.
void reportWarnings(std::span<const std::string> warnings, const WarningOptions& options);

} // namespace vitrail::tool
