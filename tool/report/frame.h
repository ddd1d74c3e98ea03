// What a render tells about its frame: as JSON for programs, as one line for people.
#pragma once

#include <span>
#include <string>

#include "../render/frame_report.h"

namespace vitrail::tool {

// The JSON document of `vitrail render --json`.
std::string toJson(const FrameReport& report);

// One line without a newline: size, fragments, layers, time, device.
std::string toSummary(const FrameReport& report);

// A picture of a turn and the file that it is in.
struct NamedFrame {
  std::string file;
  FrameReport report;
};

// The same of the pictures of a turn, of which there is at least one; `warnings` are of all of them.
std::string toJson(std::span<const NamedFrame> frames, std::span<const std::string> warnings);
std::string toSummary(std::span<const NamedFrame> frames);

} // namespace vitrail::tool
