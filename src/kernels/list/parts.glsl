// Where the parts of a long list begin, 16 fragments each, so that several invocations can follow it at once: one that
// follows it alone waits for memory at every node. Of the pool (list/walk.glsl) only.
#ifndef VITRAIL_PARTS_GLSL
#define VITRAIL_PARTS_GLSL

#include "list/walk.glsl"

// Steps over a node without looking at it.
void vitrailStep(inout VitrailWalk walk) {
  walk.index = vitrailLoadNext(walk.index, vitrailNodes()) & vitrailNextMask(vitrailNodes());
  ++walk.count;
}

// Where the next part begins, VITRAIL_END at the end of the list; steps over it.
uint vitrailFindPart(inout VitrailWalk walk) {
  if (!vitrailMore(walk)) return VITRAIL_END;
  uint start = walk.index;
  for (uint i = 0u; i < VITRAIL_SHORT_LIST && vitrailMore(walk); ++i) vitrailStep(walk);
  return start;
}

struct VitrailParts {
  uvec3 near; // the second to the fourth part
  uvec4 far;  // the fifth to the eighth part
};

// Walks on to the end of a list, of which one part has been walked.
VitrailParts vitrailFindParts(inout VitrailWalk walk) {
  VitrailParts parts;
  parts.near.x = vitrailFindPart(walk);
  parts.near.y = vitrailFindPart(walk);
  parts.near.z = vitrailFindPart(walk);
  parts.far.x = vitrailFindPart(walk);
  parts.far.y = vitrailFindPart(walk);
  parts.far.z = vitrailFindPart(walk);
  parts.far.w = vitrailFindPart(walk);
  while (vitrailMore(walk)) vitrailStep(walk);
  return parts;
}

#endif
