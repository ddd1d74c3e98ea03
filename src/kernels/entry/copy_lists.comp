// Copies the sorted lists of a rectangle out (VitrailCopyHeader of vitrail/layout.h): one thread a pixel, between the
// collecting and the target's next frame, before the resolve or after it. Long lists are relinked in order on the way;
// no picture changes by that.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SORT_WORDS
#include "target.glsl"

uint vitrailWordOf(uint index) {
  return vitrailParameters.userWords != 0u ? vitrailLoadWord(index, vitrailNodes()) : 0u;
}

#include "list/parts.glsl"
#include "sink/copy.glsl"
#include "list/long.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Hands the list over to the sink, which there is room for.
VitrailSink copyList(uint pixelIndex) {
  uint head = vitrailHeads[pixelIndex];
  if (copyCount > VITRAIL_SHORT_LIST) {
    VitrailSink sink = vitrailLong(head, nodesInUse());
    vitrailHeads[pixelIndex] = head;
    return sink;
  }
  VitrailWalk walk = VitrailWalk(head, 0u, nodesInUse());
  return vitrailShort(walk);
}

// Copies a list, if all of it can be. Returns its first layer, and their number.
uvec2 copyPixel(uint pixelIndex) {
  VitrailWalk walk = VitrailWalk(vitrailHeads[pixelIndex], 0u, nodesInUse());
  while (vitrailMore(walk)) { // drivers that count turns get fewer of them
    vitrailStep(walk);
    if (vitrailMore(walk)) vitrailStep(walk);
    if (vitrailMore(walk)) vitrailStep(walk);
    if (vitrailMore(walk)) vitrailStep(walk);
  }
  copyCount = walk.count;
  if (copyCount == 0u) return uvec2(0u);
  copyFirst = atomicAdd(copy.layers, copyCount);
  bool fits = copyFirst < copy.capacity && copyCount <= copy.capacity - copyFirst;
  bool whole = false;
  if (fits && !vitrailMore(walk) && !overflowed()) whole = copyList(pixelIndex).complete;
  return uvec2(whole ? copyFirst : VITRAIL_END, copyCount);
}

void main() {
  uvec2 place = gl_GlobalInvocationID.xy; // in the rectangle
  if (place.x >= copy.width || place.y >= copy.height) return;
  uvec2 local = place + uvec2(copy.x, copy.y) - uvec2(vitrailParameters.x, vitrailParameters.y);
  uvec2 list = uvec2(0u);
  if (isInArea(local)) list = copyPixel(pixelIndexOf(local)); // not left of it or above: those are far beyond
  copied[place.y * copy.width + place.x] = list;
}
