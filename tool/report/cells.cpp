#include "cells.h"

#include <cmath>

#include <fmt/format.h>

namespace vitrail::tool {

std::string notesOn(const Machine& machine, bool hasCpuMethod) {
  std::string notes;
  if (machine.isCpu && machine.hasDevice)
    notes = "This device is a CPU: only the ratios say something, its times are the machine's.\n";
  if (!hasCpuMethod) return notes;
  return notes + (machine.hasDevice ? fmt::format("The method cpu is drawn by {}.\nIts times are by the clock, and its "
                                                  "cost is that of the whole frame.\n",
                                                  machine.processor)
                                    : "Times are by the clock, and the cost is that of the whole frame.\n");
}

std::string milliseconds(double value) { return fmt::format("{:.{}f}", value, value < 1000.0 ? 3 : 1); }

std::string ratio(double value) { return std::isfinite(value) ? fmt::format("{:.2f}", value) : "-"; }

std::string mebibytes(std::uint64_t bytes) {
  return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1024.0 * 1024.0));
}

std::string passTimesOf(const std::string& label, const Measurement& measured) {
  std::string text;
  std::string line = label;
  const std::size_t indent = line.size();
  for (const auto& [name, spread] : measured.passes) {
    const std::string pass = fmt::format("{} {}", name, milliseconds(spread.median));
    if (line.size() > indent && line.size() + 3 + pass.size() > kColumns) { // ", " before it, "," behind it
      text.append(line).append(",\n");
      line = std::string(indent, ' ');
    }
    line.append(line.size() > indent ? ", " : "").append(pass);
  }
  return text.append(line).append("\n");
}

} // namespace vitrail::tool
