// Numbers and passes as the tables for people tell them: of a benchmark, of a comparison, of a frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "../bench/measurement.h"

namespace vitrail::tool {

inline constexpr std::size_t kColumns = 120; // that a table may have

// What is said of where measurements were taken, in lines: of a CPU device, and of the method `cpu`, if it is there.
std::string notesOn(const Machine& machine, bool hasCpuMethod);

// "3.142"; from a second on "1234.5".
std::string milliseconds(double value);

// "1.08", or "-" where there is none.
std::string ratio(double value);

// "12.3 MiB"
std::string mebibytes(std::uint64_t bytes);

// The passes of a measurement and their medians, behind `label`, on as many lines as they take.
std::string passTimesOf(const std::string& label, const Measurement& measured);

} // namespace vitrail::tool
