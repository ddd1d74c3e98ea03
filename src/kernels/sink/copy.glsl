// The sink (sink/blend.glsl says what one is) that copies lists out, as VitrailCopyHeader of vitrail/layout.h
// describes. All of a list goes out in order: there is no rest, and a class that makes one is not for it.
#ifndef VITRAIL_COPY_GLSL
#define VITRAIL_COPY_GLSL

#include "target.glsl"
#include "vitrail/sort.glsl"

layout(VITRAIL_BOUND(0, VITRAIL_BINDING_COPY), std430) buffer CopyBlock {
  VitrailCopyHeader copy;
  uvec2 copied[]; // two words of what lies behind: a VitrailCopiedList, or a quarter of a VitrailLayer
};

struct VitrailSink {
  uint layers;
  bool complete;
};

// Where this invocation's list goes: its first layer, and how many there is room for.
uint copyFirst = 0u; // Mesa warns of what it cannot see set
uint copyCount = 0u;

VitrailSink vitrailBegin() { return VitrailSink(0u, true); }

void vitrailPut(inout VitrailSink sink, VitrailEntry entry, uint number) {
  if (number >= copyCount) return; // never, unless memory is corrupt
  VitrailLayer layer = vitrailLayerOf(entry.key, entry.word, vitrailNodes());
  uint place = copy.width * copy.height + 4u * (copyFirst + number);
  copied[place] = floatBitsToUint(layer.color.rg);
  copied[place + 1u] = floatBitsToUint(layer.color.ba);
  copied[place + 2u] = uvec2(floatBitsToUint(layer.depth), layer.blend);
  copied[place + 3u] = uvec2(layer.coverage, layer.word);
}

bool vitrailHasEnough(VitrailSink sink) { return false; }
void vitrailEnd(inout VitrailSink sink) {}

#endif
