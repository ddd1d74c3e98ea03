#include "warnings.h"

#include <cstdio>
#include <stdexcept>

#include <fmt/format.h>

#include "../scene/message.h"

namespace vitrail::tool {

void addWarningOptions(CLI::App& command, WarningOptions& options) {
  command.add_flag("--quiet", options.quiet);
  command.add_flag("--strict", options.strict);
}

void reportWarnings(std::span<const std::string> warnings, const WarningOptions& options) {
  if (warnings.empty()) return;
  if (options.strict) {
    const std::size_t others = warnings.size() - 1;
    const std::string more = others > 0 ? fmt::format(" (and {} more)", others) : "";
    throw std::runtime_error(fmt::format("{}{}; without --strict this is a warning", warnings.front(), more));
  }
  if (options.quiet) return;
  for (const std::string& line : warnings) fmt::print(stderr, "vitrail: warning: {}\n", printable(line));
}

} // namespace vitrail::tool
