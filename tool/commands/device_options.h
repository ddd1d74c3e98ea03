// Which device draws: the options that render, compare and bench share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "../render/device.h"

namespace vitrail::tool {

// A help page with the lines of --device in place of the mark @device@.
std::string withDeviceHelp(const std::string& page);

// What comparisons and benchmarks of these methods open, where none stands for all.
Wish wishFor(const std::vector<std::string>& methods);

// Destroys the device once all that was made on it is gone. Throws std::runtime_error where the validation layer has
// reported errors.
void closeValidated(Device& device);

} // namespace vitrail::tool
