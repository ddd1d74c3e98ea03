// What devices may lack that methods cannot do without, of all methods in one table.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "../../gpu/device.h"

namespace vitrail::tool {

// Storage buffers that a shader of the method tiles binds.
constexpr std::uint32_t kTilesBuffers = 29;

// Why a device does not run a method, in a line: "Abacus has no fragment shader interlock, which the method interlock
// needs: use loop". Empty: it does, but for what depends on the scene and on the memory.
std::string lackFor(const Gpu& gpu, std::string_view method);

// Throws GpuError with that line.
void requireDevice(const Gpu& gpu, std::string_view method);

} // namespace vitrail::tool
