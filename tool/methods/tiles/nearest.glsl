// The nearest TILES_KEEP (8, 16 or 32) of any keys, sorted in registers: arrays whose indices are all constants.
#ifndef VITRAIL_TOOL_TILES_NEAREST_GLSL
#define VITRAIL_TOOL_TILES_NEAREST_GLSL

uint nearestKeys[TILES_KEEP];
uint newKeys[8];

#define TILES_SORT(keys, a, b) { \
  uint less = min(keys[a], keys[b]); \
  keys[b] = max(keys[a], keys[b]); \
  keys[a] = less; \
}

// The shortest network for eight, of 19 comparisons (Knuth, "The art of computer programming", volume 3, 5.3.4).
void sortNewKeys() {
#define SORT_NEW(a, b) TILES_SORT(newKeys, a, b)
  SORT_NEW(0, 2) SORT_NEW(1, 3) SORT_NEW(4, 6) SORT_NEW(5, 7)
  SORT_NEW(0, 4) SORT_NEW(1, 5) SORT_NEW(2, 6) SORT_NEW(3, 7)
  SORT_NEW(0, 1) SORT_NEW(2, 3) SORT_NEW(4, 5) SORT_NEW(6, 7)
  SORT_NEW(2, 4) SORT_NEW(3, 5)
  SORT_NEW(1, 4) SORT_NEW(3, 6)
  SORT_NEW(1, 2) SORT_NEW(3, 4) SORT_NEW(5, 6)
#undef SORT_NEW
}

// Batcher's merge of what first rises and then falls, by halves.
#define MERGE_KEYS(a, b) TILES_SORT(nearestKeys, a, b)
#define MERGE_2(a) MERGE_KEYS(a, a + 1)
#define MERGE_4(a) MERGE_KEYS(a, a + 2) MERGE_KEYS(a + 1, a + 3) MERGE_2(a) MERGE_2(a + 2)
#define MERGE_8(a) \
  MERGE_KEYS(a, a + 4) MERGE_KEYS(a + 1, a + 5) MERGE_KEYS(a + 2, a + 6) MERGE_KEYS(a + 3, a + 7) \
  MERGE_4(a) MERGE_4(a + 4)
#define MERGE_16(a) \
  MERGE_KEYS(a, a + 8) MERGE_KEYS(a + 1, a + 9) MERGE_KEYS(a + 2, a + 10) MERGE_KEYS(a + 3, a + 11) \
  MERGE_KEYS(a + 4, a + 12) MERGE_KEYS(a + 5, a + 13) MERGE_KEYS(a + 6, a + 14) MERGE_KEYS(a + 7, a + 15) \
  MERGE_8(a) MERGE_8(a + 8)
#define MERGE_32(a) \
  MERGE_KEYS(a, a + 16) MERGE_KEYS(a + 1, a + 17) MERGE_KEYS(a + 2, a + 18) MERGE_KEYS(a + 3, a + 19) \
  MERGE_KEYS(a + 4, a + 20) MERGE_KEYS(a + 5, a + 21) MERGE_KEYS(a + 6, a + 22) MERGE_KEYS(a + 7, a + 23) \
  MERGE_KEYS(a + 8, a + 24) MERGE_KEYS(a + 9, a + 25) MERGE_KEYS(a + 10, a + 26) MERGE_KEYS(a + 11, a + 27) \
  MERGE_KEYS(a + 12, a + 28) MERGE_KEYS(a + 13, a + 29) MERGE_KEYS(a + 14, a + 30) MERGE_KEYS(a + 15, a + 31) \
  MERGE_16(a) MERGE_16(a + 16)
#if TILES_KEEP == 8
#define MERGE_ALL MERGE_8(0)
#define EACH_KEPT(what) what(0) what(1) what(2) what(3) what(4) what(5) what(6) what(7)
#elif TILES_KEEP == 16
#define MERGE_ALL MERGE_16(0)
#define EACH_KEPT(what) \
  what(0) what(1) what(2) what(3) what(4) what(5) what(6) what(7) \
  what(8) what(9) what(10) what(11) what(12) what(13) what(14) what(15)
#else
#define MERGE_ALL MERGE_32(0)
#define EACH_KEPT(what) \
  what(0) what(1) what(2) what(3) what(4) what(5) what(6) what(7) \
  what(8) what(9) what(10) what(11) what(12) what(13) what(14) what(15) \
  what(16) what(17) what(18) what(19) what(20) what(21) what(22) what(23) \
  what(24) what(25) what(26) what(27) what(28) what(29) what(30) what(31)
#endif

// Eight sorted keys among the nearest ones. The nearest of those that there is no room for.
uint mergeNewKeys() {
  uint left = 0xffffffffu;
#define KEEP_NEW(i) \
  left = min(left, max(nearestKeys[TILES_KEEP - 8 + i], newKeys[7 - i])); \
  nearestKeys[TILES_KEEP - 8 + i] = min(nearestKeys[TILES_KEEP - 8 + i], newKeys[7 - i]);
  KEEP_NEW(0) KEEP_NEW(1) KEEP_NEW(2) KEEP_NEW(3) KEEP_NEW(4) KEEP_NEW(5) KEEP_NEW(6) KEEP_NEW(7)
#undef KEEP_NEW
  MERGE_ALL
  return left;
}

#endif
