// What devices may lack that methods cannot do without.
#pragma once

#include <string_view>

#include "../../gpu/device.h"

namespace vitrail::tool {

// Throws GpuError unless the device `has` it: "Abacus has no fragment shader interlock, which the method interlock
// needs: use loop".
void requireOf(const Gpu& gpu, bool has, std::string_view lack, std::string_view method, std::string_view instead);

// The same of fragment shader interlock (VK_EXT_fragment_shader_interlock).
void requireInterlock(const Gpu& gpu, std::string_view method);

} // namespace vitrail::tool
