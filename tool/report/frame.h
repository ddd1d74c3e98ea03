// What a render tells about its frame: as JSON for programs, as one line for people.
#pragma once

#include <string>

#include "../render/frame_report.h"

namespace vitrail::tool {

// The JSON document of `vitrail render --json`.
std::string toJson(const FrameReport& report);

// One line without a newline: size, fragments, layers, time, device.
std::string toSummary(const FrameReport& report);

} // namespace vitrail::tool
