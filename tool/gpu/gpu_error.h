// Why a picture cannot be drawn here.
#pragma once

#include <stdexcept>

namespace vitrail::tool {

// A device, driver or memory that cannot do what was asked, the processor too: what() is one line that says what and
// what to do.
struct GpuError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The driver has given the device up: what was made on it is of no use any more, and another one can be opened.
struct DeviceLost : GpuError {
  using GpuError::GpuError;
};

} // namespace vitrail::tool
