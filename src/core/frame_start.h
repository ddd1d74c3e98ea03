// What every backend does on the host's side when a frame is begun, or a part of its lists copied.
#pragma once

#include <cstdint>

#include "call_order.h"
#include "frame_numbers.h"
#include "growth.h"
#include "target_rules.h"

namespace vitrail {

// Starts a frame for which the host says `given`; `open`: the last one was not ended. True: it has the number of the
// last one, which was dropped (FrameNumbers::begin). What is wrong with the number is logged.
bool startFrame(FrameNumbers& frames, CallOrder& order, Growth& growth, const Log& log, std::uint64_t given, bool open);

// What a host asks to be copied, and where to.
struct CopyRequest {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool hasBuffer = false;
  std::uint64_t offset = 0;
  std::uint64_t size = 0;         // bytes from the offset on
  const char* sizeCall = nullptr; // the API's call that tells how many are needed
};

// Whether that can be copied of a frame with this area; logs why not. `prefix` is what the API's calls begin with.
bool canCopy(const Log& log, const char* prefix, const TargetInfo& info, const VitrailRect& area,
             const CopyRequest& request);

} // namespace vitrail
