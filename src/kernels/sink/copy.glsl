// The sink (sink/blend.glsl says what one is) that copies lists out, as VitrailCopy of vitrail/layout.h describes. All
// of a list goes out in order: there is no rest, and a class that makes one is not for it.
#ifndef VITRAIL_COPY_GLSL
#define VITRAIL_COPY_GLSL

#include "target.glsl"
#include "vitrail/sort.glsl"

layout(set = 0, binding = VITRAIL_BINDING_COPY, std430) buffer CopyBlock {
  VitrailCopy copy;
  VitrailCopiedList copiedLists[];
};
layout(set = 0, binding = VITRAIL_BINDING_COPY, std430) buffer CopiedLayersBlock { VitrailLayer copiedLayers[]; };

struct VitrailSink {
  uint layers;
  bool complete;
  uint copied;
};

// Where this invocation's list goes: its first layer, and how many there is room for.
uint copyFirst;
uint copyCount;

VitrailSink vitrailBegin() { return VitrailSink(0u, true, 0u); }

void vitrailPut(inout VitrailSink sink, VitrailEntry entry, uint number) {
  if (number >= copyCount) return; // never, unless memory is corrupt
  uint first = VITRAIL_COPY_FIRST_LAYER(copy.width * copy.height) + copyFirst;
  copiedLayers[first + number] = vitrailLayerOf(entry.key, entry.word, vitrailNodes());
  ++sink.copied;
}

bool vitrailHasEnough(VitrailSink sink) { return false; }
void vitrailEnd(inout VitrailSink sink) {}

#endif
