// The class of lists of at most 32 fragments, the second dispatch of the compute resolve: one invocation sorts a list
// in registers, by a network.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_GROUPS
#include "sink/picture.glsl"
#include "list/short.glsl"

layout(local_size_x = 128) in; // MEDIUM_GROUP_LISTS

// A list of at most 32 fragments; a longer one is not complete.
VitrailSink vitrailMedium(uint head, uint nodeCount) {
  VitrailWalk walk = VitrailWalk(head, 0u, nodeCount);
  VitrailEntry e[32] = VitrailEntry[32](VITRAIL_LAST_16, VITRAIL_LAST_16);
  VITRAIL_TAKE(0) VITRAIL_TAKE(1) VITRAIL_TAKE(2) VITRAIL_TAKE(3)
  VITRAIL_TAKE(4) VITRAIL_TAKE(5) VITRAIL_TAKE(6) VITRAIL_TAKE(7)
  VITRAIL_TAKE(8) VITRAIL_TAKE(9) VITRAIL_TAKE(10) VITRAIL_TAKE(11)
  VITRAIL_TAKE(12) VITRAIL_TAKE(13) VITRAIL_TAKE(14) VITRAIL_TAKE(15)
  VITRAIL_TAKE(16) VITRAIL_TAKE(17) VITRAIL_TAKE(18) VITRAIL_TAKE(19)
  if (vitrailMore(walk)) {
    VITRAIL_TAKE(20) VITRAIL_TAKE(21) VITRAIL_TAKE(22) VITRAIL_TAKE(23)
    VITRAIL_TAKE(24) VITRAIL_TAKE(25) VITRAIL_TAKE(26) VITRAIL_TAKE(27)
    VITRAIL_TAKE(28) VITRAIL_TAKE(29) VITRAIL_TAKE(30) VITRAIL_TAKE(31)
  }
  VitrailSink sink = vitrailBegin();
  sink.layers = walk.count;
  sink.complete = !vitrailMore(walk);
  if (!sink.complete) return sink;
  vitrailSort(e);
  VITRAIL_PUT(0) VITRAIL_PUT(1) VITRAIL_PUT(2) VITRAIL_PUT(3)
  VITRAIL_PUT(4) VITRAIL_PUT(5) VITRAIL_PUT(6) VITRAIL_PUT(7)
  VITRAIL_PUT(8) VITRAIL_PUT(9) VITRAIL_PUT(10) VITRAIL_PUT(11)
  VITRAIL_PUT(12) VITRAIL_PUT(13) VITRAIL_PUT(14) VITRAIL_PUT(15)
  VITRAIL_PUT(16) VITRAIL_PUT(17) VITRAIL_PUT(18) VITRAIL_PUT(19)
  if (walk.count > 20u) {
    VITRAIL_PUT(20) VITRAIL_PUT(21) VITRAIL_PUT(22) VITRAIL_PUT(23)
    VITRAIL_PUT(24) VITRAIL_PUT(25) VITRAIL_PUT(26) VITRAIL_PUT(27)
    VITRAIL_PUT(28) VITRAIL_PUT(29) VITRAIL_PUT(30) VITRAIL_PUT(31)
  }
  vitrailEnd(sink);
  return sink;
}

void main() {
  uint slot = deepGroup() * MEDIUM_GROUP_LISTS + gl_LocalInvocationIndex;
  if (slot >= min(vitrailControl.classes[VITRAIL_CLASS_MEDIUM].count, mediumPixels.length())) return;
  uint pixelIndex = mediumPixels[slot];
  beginPixel(imagePixel(pixelIndex));
  writeDeepPixel(pixelIndex, vitrailMedium(vitrailHeads[pixelIndex], nodesInUse()));
}
