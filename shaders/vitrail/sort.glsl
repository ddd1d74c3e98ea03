// Sorting fragments in registers. Every array index is a constant, so that the array never becomes memory: a loop over
// a dynamically indexed local array is slow on GPUs, and one driver was seen to sort it wrongly.
//
// Two ways: insertion, whose code is short, for drivers that execute both sides of every branch, and, with
// VITRAIL_NETWORKS, Batcher's odd-even merging networks (Knuth, The Art of Computer Programming, volume 3, 5.3.4) of 4,
// 8, 16 and 32, for GPUs.
#ifndef VITRAIL_SORT_GLSL
#define VITRAIL_SORT_GLSL

// A fragment that is being sorted: its key (node.glsl), and its node's index where that is asked for.
struct VitrailEntry {
  uvec4 key;
  uint index;
};

// Behind every fragment. The last two words are those that formats leave empty: where all entries have 0 there,
// compilers see that they need no registers and no comparisons.
const VitrailEntry VITRAIL_LAST = VitrailEntry(uvec4(0xffffffffu, 0xffffffffu, 0u, 0u), 0xffffffffu);
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

// Puts two entries into ascending order.
void vitrailExchange(inout VitrailEntry a, inout VitrailEntry b) {
  bool swap = vitrailBefore(b.key, a.key);
  uvec4 key = mix(a.key, b.key, bvec4(swap));
  uint index = mix(a.index, b.index, swap);
  b.key = mix(b.key, a.key, bvec4(swap));
  b.index = mix(b.index, a.index, swap);
  a.key = key;
  a.index = index;
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

#if VITRAIL_NETWORKS
// The networks, as exchanges of the entries of an array `e`.
#define VITRAIL_X(a, b) vitrailExchange(e[a], e[b]);
#define VITRAIL_NETWORK_4 \
  VITRAIL_X(0, 1) VITRAIL_X(2, 3) VITRAIL_X(0, 2) VITRAIL_X(1, 3) VITRAIL_X(1, 2)
#define VITRAIL_NETWORK_8 \
  VITRAIL_X(0, 1) VITRAIL_X(2, 3) VITRAIL_X(4, 5) VITRAIL_X(6, 7) VITRAIL_X(0, 2) VITRAIL_X(1, 3) VITRAIL_X(4, 6) \
  VITRAIL_X(5, 7) VITRAIL_X(1, 2) VITRAIL_X(5, 6) VITRAIL_X(0, 4) VITRAIL_X(1, 5) VITRAIL_X(2, 6) VITRAIL_X(3, 7) \
  VITRAIL_X(2, 4) VITRAIL_X(3, 5) VITRAIL_X(1, 2) VITRAIL_X(3, 4) VITRAIL_X(5, 6)
#define VITRAIL_NETWORK_16 \
  VITRAIL_X(0, 1) VITRAIL_X(2, 3) VITRAIL_X(4, 5) VITRAIL_X(6, 7) VITRAIL_X(8, 9) VITRAIL_X(10, 11) VITRAIL_X(12, 13) \
  VITRAIL_X(14, 15) VITRAIL_X(0, 2) VITRAIL_X(1, 3) VITRAIL_X(4, 6) VITRAIL_X(5, 7) VITRAIL_X(8, 10) VITRAIL_X(9, 11) \
  VITRAIL_X(12, 14) VITRAIL_X(13, 15) VITRAIL_X(1, 2) VITRAIL_X(5, 6) VITRAIL_X(9, 10) VITRAIL_X(13, 14) \
  VITRAIL_X(0, 4) VITRAIL_X(1, 5) VITRAIL_X(2, 6) VITRAIL_X(3, 7) VITRAIL_X(8, 12) VITRAIL_X(9, 13) VITRAIL_X(10, 14) \
  VITRAIL_X(11, 15) VITRAIL_X(2, 4) VITRAIL_X(3, 5) VITRAIL_X(10, 12) VITRAIL_X(11, 13) VITRAIL_X(1, 2) \
  VITRAIL_X(3, 4) VITRAIL_X(5, 6) VITRAIL_X(9, 10) VITRAIL_X(11, 12) VITRAIL_X(13, 14) VITRAIL_X(0, 8) \
  VITRAIL_X(1, 9) VITRAIL_X(2, 10) VITRAIL_X(3, 11) VITRAIL_X(4, 12) VITRAIL_X(5, 13) VITRAIL_X(6, 14) \
  VITRAIL_X(7, 15) VITRAIL_X(4, 8) VITRAIL_X(5, 9) VITRAIL_X(6, 10) VITRAIL_X(7, 11) VITRAIL_X(2, 4) VITRAIL_X(3, 5) \
  VITRAIL_X(6, 8) VITRAIL_X(7, 9) VITRAIL_X(10, 12) VITRAIL_X(11, 13) VITRAIL_X(1, 2) VITRAIL_X(3, 4) VITRAIL_X(5, 6) \
  VITRAIL_X(7, 8) VITRAIL_X(9, 10) VITRAIL_X(11, 12) VITRAIL_X(13, 14)
#define VITRAIL_NETWORK_32 \
  VITRAIL_X(0, 1) VITRAIL_X(2, 3) VITRAIL_X(4, 5) VITRAIL_X(6, 7) VITRAIL_X(8, 9) VITRAIL_X(10, 11) VITRAIL_X(12, 13) \
  VITRAIL_X(14, 15) VITRAIL_X(16, 17) VITRAIL_X(18, 19) VITRAIL_X(20, 21) VITRAIL_X(22, 23) VITRAIL_X(24, 25) \
  VITRAIL_X(26, 27) VITRAIL_X(28, 29) VITRAIL_X(30, 31) VITRAIL_X(0, 2) VITRAIL_X(1, 3) VITRAIL_X(4, 6) \
  VITRAIL_X(5, 7) VITRAIL_X(8, 10) VITRAIL_X(9, 11) VITRAIL_X(12, 14) VITRAIL_X(13, 15) VITRAIL_X(16, 18) \
  VITRAIL_X(17, 19) VITRAIL_X(20, 22) VITRAIL_X(21, 23) VITRAIL_X(24, 26) VITRAIL_X(25, 27) VITRAIL_X(28, 30) \
  VITRAIL_X(29, 31) VITRAIL_X(1, 2) VITRAIL_X(5, 6) VITRAIL_X(9, 10) VITRAIL_X(13, 14) VITRAIL_X(17, 18) \
  VITRAIL_X(21, 22) VITRAIL_X(25, 26) VITRAIL_X(29, 30) VITRAIL_X(0, 4) VITRAIL_X(1, 5) VITRAIL_X(2, 6) \
  VITRAIL_X(3, 7) VITRAIL_X(8, 12) VITRAIL_X(9, 13) VITRAIL_X(10, 14) VITRAIL_X(11, 15) VITRAIL_X(16, 20) \
  VITRAIL_X(17, 21) VITRAIL_X(18, 22) VITRAIL_X(19, 23) VITRAIL_X(24, 28) VITRAIL_X(25, 29) VITRAIL_X(26, 30) \
  VITRAIL_X(27, 31) VITRAIL_X(2, 4) VITRAIL_X(3, 5) VITRAIL_X(10, 12) VITRAIL_X(11, 13) VITRAIL_X(18, 20) \
  VITRAIL_X(19, 21) VITRAIL_X(26, 28) VITRAIL_X(27, 29) VITRAIL_X(1, 2) VITRAIL_X(3, 4) VITRAIL_X(5, 6) \
  VITRAIL_X(9, 10) VITRAIL_X(11, 12) VITRAIL_X(13, 14) VITRAIL_X(17, 18) VITRAIL_X(19, 20) VITRAIL_X(21, 22) \
  VITRAIL_X(25, 26) VITRAIL_X(27, 28) VITRAIL_X(29, 30) VITRAIL_X(0, 8) VITRAIL_X(1, 9) VITRAIL_X(2, 10) \
  VITRAIL_X(3, 11) VITRAIL_X(4, 12) VITRAIL_X(5, 13) VITRAIL_X(6, 14) VITRAIL_X(7, 15) VITRAIL_X(16, 24) \
  VITRAIL_X(17, 25) VITRAIL_X(18, 26) VITRAIL_X(19, 27) VITRAIL_X(20, 28) VITRAIL_X(21, 29) VITRAIL_X(22, 30) \
  VITRAIL_X(23, 31) VITRAIL_X(4, 8) VITRAIL_X(5, 9) VITRAIL_X(6, 10) VITRAIL_X(7, 11) VITRAIL_X(20, 24) \
  VITRAIL_X(21, 25) VITRAIL_X(22, 26) VITRAIL_X(23, 27) VITRAIL_X(2, 4) VITRAIL_X(3, 5) VITRAIL_X(6, 8) \
  VITRAIL_X(7, 9) VITRAIL_X(10, 12) VITRAIL_X(11, 13) VITRAIL_X(18, 20) VITRAIL_X(19, 21) VITRAIL_X(22, 24) \
  VITRAIL_X(23, 25) VITRAIL_X(26, 28) VITRAIL_X(27, 29) VITRAIL_X(1, 2) VITRAIL_X(3, 4) VITRAIL_X(5, 6) \
  VITRAIL_X(7, 8) VITRAIL_X(9, 10) VITRAIL_X(11, 12) VITRAIL_X(13, 14) VITRAIL_X(17, 18) VITRAIL_X(19, 20) \
  VITRAIL_X(21, 22) VITRAIL_X(23, 24) VITRAIL_X(25, 26) VITRAIL_X(27, 28) VITRAIL_X(29, 30) VITRAIL_X(0, 16) \
  VITRAIL_X(1, 17) VITRAIL_X(2, 18) VITRAIL_X(3, 19) VITRAIL_X(4, 20) VITRAIL_X(5, 21) VITRAIL_X(6, 22) \
  VITRAIL_X(7, 23) VITRAIL_X(8, 24) VITRAIL_X(9, 25) VITRAIL_X(10, 26) VITRAIL_X(11, 27) VITRAIL_X(12, 28) \
  VITRAIL_X(13, 29) VITRAIL_X(14, 30) VITRAIL_X(15, 31) VITRAIL_X(8, 16) VITRAIL_X(9, 17) VITRAIL_X(10, 18) \
  VITRAIL_X(11, 19) VITRAIL_X(12, 20) VITRAIL_X(13, 21) VITRAIL_X(14, 22) VITRAIL_X(15, 23) VITRAIL_X(4, 8) \
  VITRAIL_X(5, 9) VITRAIL_X(6, 10) VITRAIL_X(7, 11) VITRAIL_X(12, 16) VITRAIL_X(13, 17) VITRAIL_X(14, 18) \
  VITRAIL_X(15, 19) VITRAIL_X(20, 24) VITRAIL_X(21, 25) VITRAIL_X(22, 26) VITRAIL_X(23, 27) VITRAIL_X(2, 4) \
  VITRAIL_X(3, 5) VITRAIL_X(6, 8) VITRAIL_X(7, 9) VITRAIL_X(10, 12) VITRAIL_X(11, 13) VITRAIL_X(14, 16) \
  VITRAIL_X(15, 17) VITRAIL_X(18, 20) VITRAIL_X(19, 21) VITRAIL_X(22, 24) VITRAIL_X(23, 25) VITRAIL_X(26, 28) \
  VITRAIL_X(27, 29) VITRAIL_X(1, 2) VITRAIL_X(3, 4) VITRAIL_X(5, 6) VITRAIL_X(7, 8) VITRAIL_X(9, 10) \
  VITRAIL_X(11, 12) VITRAIL_X(13, 14) VITRAIL_X(15, 16) VITRAIL_X(17, 18) VITRAIL_X(19, 20) VITRAIL_X(21, 22) \
  VITRAIL_X(23, 24) VITRAIL_X(25, 26) VITRAIL_X(27, 28) VITRAIL_X(29, 30)

// Sorts the first `count` of 16 entries; those behind are VITRAIL_LAST.
void vitrailSort(inout VitrailEntry e[16], uint count) {
  if (count <= 1u) return;
  if (count <= 4u) {
    VITRAIL_NETWORK_4
  } else if (count <= 8u) {
    VITRAIL_NETWORK_8
  } else {
    VITRAIL_NETWORK_16
  }
}

// Sorts 32 entries.
void vitrailSort(inout VitrailEntry e[32]) { VITRAIL_NETWORK_32 }
#endif

#endif
