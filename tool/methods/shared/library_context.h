// The library's context on the tool's device.
#pragma once

#include <string>

#include "../../gpu/device.h"

#include <vitrail/vulkan.h>

#include <vitrail/vitrail.hpp>

namespace vitrail::tool {

// Makes a context with the features that the device was made with. `reason` outlives it, and keeps the last error that
// the library logs.
VkResult makeLibraryContext(Gpu& gpu, std::string& reason, vulkan::Context& context);

} // namespace vitrail::tool
