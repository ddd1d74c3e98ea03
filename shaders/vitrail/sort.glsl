// Sorting fragments in registers, by insertion. Every array index is a constant, so that the array never becomes
// memory: a loop over a dynamically indexed local array is slow on GPUs, and one driver was seen to sort it wrongly.
//
// Define before the include VITRAIL_SORT_WORDS where fragments with equal keys are to be ordered by the host's word.
#ifndef VITRAIL_SORT_GLSL
#define VITRAIL_SORT_GLSL

// A fragment that is being sorted: its key (node.glsl), and its node's index where that is asked for.
struct VitrailEntry {
  uvec4 key;
  uint index;
#ifdef VITRAIL_SORT_WORDS
  uint word;
#endif
};

// Behind every fragment. The last two words are those that formats leave empty: where all entries have 0 there,
// compilers see that they need no registers and no comparisons.
#ifdef VITRAIL_SORT_WORDS
const VitrailEntry VITRAIL_LAST = VitrailEntry(uvec4(0xffffffffu, 0xffffffffu, 0u, 0u), 0xffffffffu, 0u);
#else
const VitrailEntry VITRAIL_LAST = VitrailEntry(uvec4(0xffffffffu, 0xffffffffu, 0u, 0u), 0xffffffffu);
#endif
#define VITRAIL_LAST_4 VITRAIL_LAST, VITRAIL_LAST, VITRAIL_LAST, VITRAIL_LAST
#define VITRAIL_LAST_16 VITRAIL_LAST_4, VITRAIL_LAST_4, VITRAIL_LAST_4, VITRAIL_LAST_4

// Without && and ||, which would be branches: compilers took minutes over the networks.
bool vitrailBefore(uvec4 a, uvec4 b) {
  uint before = uint(a.w < b.w);
  before = uint(a.z < b.z) | (uint(a.z == b.z) & before);
  before = uint(a.y < b.y) | (uint(a.y == b.y) & before);
  before = uint(a.x < b.x) | (uint(a.x == b.x) & before);
  return before != 0u;
}

// Whether one entry is in front of another.
#ifdef VITRAIL_SORT_WORDS
bool vitrailEntryBefore(VitrailEntry a, VitrailEntry b) { // where all is equal by the node: no two are
  uint before = uint(a.index < b.index);
  before = uint(a.word < b.word) | (uint(a.word == b.word) & before);
  return vitrailBefore(a.key, b.key) || (a.key == b.key && before != 0u);
}
#define VITRAIL_BEFORE(a, b) vitrailEntryBefore(a, b)
#else
#define VITRAIL_BEFORE(a, b) vitrailBefore(a.key, b.key)
#endif

// Puts two entries into ascending order.
void vitrailExchange(inout VitrailEntry a, inout VitrailEntry b) {
  bool swap = VITRAIL_BEFORE(b, a);
  uvec4 key = mix(a.key, b.key, bvec4(swap));
  uint index = mix(a.index, b.index, swap);
  b.key = mix(b.key, a.key, bvec4(swap));
  b.index = mix(b.index, a.index, swap);
  a.key = key;
  a.index = index;
#ifdef VITRAIL_SORT_WORDS
  uint word = mix(a.word, b.word, swap);
  b.word = mix(b.word, a.word, swap);
  a.word = word;
#endif
}

// Inserts an entry into 16 ascending ones; the last falls out and is returned.
VitrailEntry vitrailInsert(inout VitrailEntry e[16], VitrailEntry entry) {
#define VITRAIL_PASS(i) vitrailExchange(e[i], entry);
  VITRAIL_PASS(0) VITRAIL_PASS(1) VITRAIL_PASS(2) VITRAIL_PASS(3)
  VITRAIL_PASS(4) VITRAIL_PASS(5) VITRAIL_PASS(6) VITRAIL_PASS(7)
  VITRAIL_PASS(8) VITRAIL_PASS(9) VITRAIL_PASS(10) VITRAIL_PASS(11)
  VITRAIL_PASS(12) VITRAIL_PASS(13) VITRAIL_PASS(14) VITRAIL_PASS(15)
  return entry;
}

// Drops the first of 16 ascending entries.
void vitrailShift(inout VitrailEntry e[16]) {
  e[0] = e[1]; e[1] = e[2]; e[2] = e[3]; e[3] = e[4]; e[4] = e[5]; e[5] = e[6]; e[6] = e[7]; e[7] = e[8]; e[8] = e[9];
  e[9] = e[10]; e[10] = e[11]; e[11] = e[12]; e[12] = e[13]; e[13] = e[14]; e[14] = e[15]; e[15] = VITRAIL_LAST;
}

#endif
