// What a frame's descriptors must be like, what their zeros stand for, and what follows from them for all stages.
#pragma once

#include <cstdint>
#include <span>

#include "core/log.h"
#include "raster/cpu/frame.h"

namespace vitrail::raster {

// Whether a frame and its draws are as vitrail/cpu.h describes them; else the log says why.
VitrailResult checkFrame(const Log& log, const VitrailCpuFrame* frame, const VitrailCpuDraw* draws,
                         std::uint32_t count);

// Fills in the defaults of a frame that was checked and plans its jobs. What cannot change the picture is left out.
// `counts`: Frame's. Throws std::bad_alloc.
void prepareFrame(Frame& frame, const VitrailCpuFrame& info, std::span<const VitrailCpuDraw> draws,
                  std::uint32_t threads, bool counts);

} // namespace vitrail::raster
