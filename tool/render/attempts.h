// What renderers on a device have in common, whatever the API: how often a picture is drawn, and what is told of it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "../methods/method_options.h"
#include "renderer.h"

namespace vitrail::tool {

// Draws until the method has room for every fragment. `draw` says whether it had, `stats` what it counted. Throws
// GpuError where the device `name` never has, or does not let shaders sort what there is.
FrameStats drawUntilComplete(const std::string& name, const std::function<bool()>& draw,
                             const std::function<FrameStats()>& stats);

// The report of a picture, without the device's name, API and memory.
FrameReport reportOf(const FrameStats& stats, const RenderOptions& picture, const MethodOptions& method,
                     const PassTimes& passes);

// Whether a picture may show the background alone: one without a gradient. Most pictures show at once that there is
// more.
bool mayBeBackground(const RenderOptions& picture, const RenderResult& drawn);

// Why a picture that leaves out the nearest surfaces is like one that does not.
std::string nothingPeeledWarning();

// Warns where points are drawn with another size than the scene's. `drawn` is that of the device `name`.
void warnOfPoints(const Scene& scene, float drawn, const std::string& name, std::vector<std::string>& warnings);

} // namespace vitrail::tool
