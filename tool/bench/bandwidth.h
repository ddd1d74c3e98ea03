// Measures how fast a device moves memory, as the floor under the time of every frame.
#pragma once

#include "../gpu/device.h"

namespace vitrail::tool {

// Bytes a second that the best of several copies of one large buffer to another moved, each byte counted once for
// reading and once for writing. Copies by compute shader and by vkCmdCopyBuffer are tried. The buffers are far larger
// than a cache: 256 MiB on a GPU, 64 MiB on a CPU device. Throws GpuError where the queue has no timestamps.
double measureBandwidth(Gpu& gpu);

} // namespace vitrail::tool
