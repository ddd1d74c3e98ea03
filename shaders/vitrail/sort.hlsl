// sort.glsl for HLSL, as list.hlsl takes it: sorting fragments in registers, by insertion. Every array index is a
// constant, so that the array never becomes memory. Fragments with equal keys are ordered by the host's word.
#ifndef VITRAIL_SORT_HLSL
#define VITRAIL_SORT_HLSL

// A fragment that is being sorted: its key (node.hlsl), its node's index, the host's word.
struct VitrailEntry {
  uint4 key;
  uint index;
  uint word;
};

VitrailEntry vitrailEntry(uint4 key, uint index, uint word) {
  VitrailEntry entry;
  entry.key = key;
  entry.index = index;
  entry.word = word;
  return entry;
}

// Behind every fragment.
VitrailEntry vitrailLast() { return vitrailEntry(uint4(0xffffffffu, 0xffffffffu, 0u, 0u), 0xffffffffu, 0u); }

// Whether one entry is in front of another; where all is equal by the node: no two are.
bool vitrailBefore(VitrailEntry a, VitrailEntry b) {
  uint before = uint(a.index < b.index);
  before = uint(a.word < b.word) | (uint(a.word == b.word) & before);
  before = uint(a.key.w < b.key.w) | (uint(a.key.w == b.key.w) & before);
  before = uint(a.key.z < b.key.z) | (uint(a.key.z == b.key.z) & before);
  before = uint(a.key.y < b.key.y) | (uint(a.key.y == b.key.y) & before);
  before = uint(a.key.x < b.key.x) | (uint(a.key.x == b.key.x) & before);
  return before != 0u;
}

// Puts two entries into ascending order.
void vitrailExchange(inout VitrailEntry a, inout VitrailEntry b) {
  bool swap = vitrailBefore(b, a);
  uint4 key = swap ? b.key : a.key;
  uint index = swap ? b.index : a.index;
  uint word = swap ? b.word : a.word;
  b.key = swap ? a.key : b.key;
  b.index = swap ? a.index : b.index;
  b.word = swap ? a.word : b.word;
  a.key = key;
  a.index = index;
  a.word = word;
}

// Inserts an entry into 16 ascending ones; the last falls out and is returned.
VitrailEntry vitrailInsert(inout VitrailEntry e[16], VitrailEntry entry) {
  [unroll] for (uint i = 0u; i < 16u; ++i) vitrailExchange(e[i], entry);
  return entry;
}

// Drops the first of 16 ascending entries.
void vitrailShift(inout VitrailEntry e[16]) {
  [unroll] for (uint i = 0u; i < 15u; ++i) e[i] = e[i + 1u];
  e[15] = vitrailLast();
}

#endif
