#include "frame_start.h"

#include "pool.h"

namespace vitrail {

bool startFrame(FrameNumbers& frames, CallOrder& order, Growth& growth, const Log& log, std::uint64_t given,
                bool open) {
  // Begun over an open one, what it has may be what the host meant for that one; the same number says otherwise.
  if (open && (given == 0 || given != frames.newest())) order.setMisused();
  if (frames.any() && given != 0 && given < frames.newest()) {
    log.warn("frame %llu is begun after frame %llu: frame numbers rise", static_cast<unsigned long long>(given),
             static_cast<unsigned long long>(frames.newest()));
    growth.forget(); // what was read of later frames is no news any more
  }
  return frames.begin(given, open);
}

bool canCopy(const Log& log, const char* prefix, const TargetInfo& info, const VitrailRect& area,
             const CopyRequest& request) {
  const std::uint64_t pixels = std::uint64_t{request.width} * request.height;
  const bool inside = pixels != 0 && request.x >= std::int64_t{area.x} && request.y >= std::int64_t{area.y} &&
                      request.x + request.width <= std::int64_t{area.x} + area.width &&
                      request.y + request.height <= std::int64_t{area.y} + area.height;
  const std::uint64_t bytes = copyBytes(pixels, info.copyLayers);
  if (info.copyLayers == 0) {
    log.error("%sCopyLists: the target was made without copyLayers", prefix);
  } else if (!inside) {
    log.error("%sCopyLists: %ux%u pixels at %lld,%lld are not inside the frame's area, %ux%u at %u,%u", prefix,
              request.width, request.height, static_cast<long long>(request.x), static_cast<long long>(request.y),
              area.width, area.height, area.x, area.y);
  } else if (pixels > info.copyLayers) {
    log.error("%sCopyLists: %llu pixels; copyLayers %u is the most", prefix, static_cast<unsigned long long>(pixels),
              info.copyLayers);
  } else if (!request.hasBuffer || request.offset % 4 != 0) {
    log.error("%sCopyLists needs a buffer, and an offset that is a multiple of 4", prefix);
  } else if (request.size < bytes) {
    log.error("%sCopyLists: size %llu; %llu bytes are written, as %s says", prefix,
              static_cast<unsigned long long>(request.size), static_cast<unsigned long long>(bytes), request.sizeCall);
  } else {
    return true;
  }
  return false;
}

} // namespace vitrail
