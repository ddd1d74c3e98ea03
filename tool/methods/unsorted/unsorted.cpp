#include "unsorted.h"

#include "../shared/fixed_blending.h"

namespace vitrail::tool {

Unsorted::Unsorted(const MethodHost& host, const MethodOptions& options)
    : surfaces_(makeBlendedSurfaces(host, options, "unsorted")) {}

void Unsorted::draw(Frame& frame) {
  cmdBeginBlending(frame);
  frame.drawSurfaces(surfaces_);
  vkCmdEndRendering(frame.commands());
  frame.endPass("blend");
}

} // namespace vitrail::tool
