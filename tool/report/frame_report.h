// What a render tells about its frame: as JSON for programs, as one line for people.
#pragma once

#include <string>

#include "../render/renderer.h"

namespace vitrail::tool {

// The JSON document of --json, which is an interface: names and units stay.
std::string toJson(const FrameReport& report);

// One line without a newline: size, fragments, layers, time, device.
std::string toSummary(const FrameReport& report);

} // namespace vitrail::tool
