// Which device draws: the options that render, compare and bench share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "../methods/method_options.h"
#include "../render/device.h"

namespace vitrail::tool {

// A help page with the lines of --device in place of the mark @device@.
std::string withDeviceHelp(const std::string& page);
// The same with those of --api in place of @api@. `several`: of a list.
std::string withApiHelp(const std::string& page, bool several);

// --api A of one API, and A,... of several.
void addApi(CLI::App& command, std::optional<Api>& api);
void addApis(CLI::App& command, std::vector<Api>& apis);

// What comparisons and benchmarks of these methods open, where none stands for all.
Wish wishFor(const std::vector<std::string>& methods);
// The device for them, by these APIs. Throws UsageError where the processor is named for OpenGL.
DeviceOptions deviceFor(const std::string& name, bool validate, const std::vector<std::string>& methods,
                        const std::vector<Api>& apis);

// Destroys the Vulkan device once all that was made on it is gone. Throws std::runtime_error where the validation
// layer, or OpenGL's debug output, has reported errors.
void closeValidated(Device& device);

} // namespace vitrail::tool
