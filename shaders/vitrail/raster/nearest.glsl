// The nearest VITRAIL_RASTER_KEEP (8, 16 or 32) of any keys, sorted in registers: arrays whose indices are all
// constants. What is beyond VITRAIL_RASTER_KEEP no pipeline has.
#ifndef VITRAIL_RASTER_NEAREST_GLSL
#define VITRAIL_RASTER_NEAREST_GLSL

#include "frame.glsl"

uint vitrailNearestKeys[VITRAIL_RASTER_MOST_KEPT];
uint vitrailNewKeys[8];

#define VITRAIL_SORT_KEYS(keys, a, b) { \
  uint less = min(keys[a], keys[b]); \
  keys[b] = max(keys[a], keys[b]); \
  keys[a] = less; \
}

// The shortest network for eight, of 19 comparisons (Knuth, "The art of computer programming", volume 3, 5.3.4).
void vitrailSortNewKeys() {
#define VITRAIL_SORT_NEW(a, b) VITRAIL_SORT_KEYS(vitrailNewKeys, a, b)
  VITRAIL_SORT_NEW(0, 2) VITRAIL_SORT_NEW(1, 3) VITRAIL_SORT_NEW(4, 6) VITRAIL_SORT_NEW(5, 7)
  VITRAIL_SORT_NEW(0, 4) VITRAIL_SORT_NEW(1, 5) VITRAIL_SORT_NEW(2, 6) VITRAIL_SORT_NEW(3, 7)
  VITRAIL_SORT_NEW(0, 1) VITRAIL_SORT_NEW(2, 3) VITRAIL_SORT_NEW(4, 5) VITRAIL_SORT_NEW(6, 7)
  VITRAIL_SORT_NEW(2, 4) VITRAIL_SORT_NEW(3, 5)
  VITRAIL_SORT_NEW(1, 4) VITRAIL_SORT_NEW(3, 6)
  VITRAIL_SORT_NEW(1, 2) VITRAIL_SORT_NEW(3, 4) VITRAIL_SORT_NEW(5, 6)
}

// The same where there are only the first four.
void vitrailSortFourKeys() {
  VITRAIL_SORT_NEW(0, 2) VITRAIL_SORT_NEW(1, 3) VITRAIL_SORT_NEW(0, 1) VITRAIL_SORT_NEW(2, 3) VITRAIL_SORT_NEW(1, 2)
}
#undef VITRAIL_SORT_NEW

// Batcher's merge of what first rises and then falls, by halves.
#define VITRAIL_MERGE_KEYS(a, b) VITRAIL_SORT_KEYS(vitrailNearestKeys, a, b)
#define VITRAIL_MERGE_2(a) VITRAIL_MERGE_KEYS(a, a + 1)
#define VITRAIL_MERGE_4(a) \
  VITRAIL_MERGE_KEYS(a, a + 2) VITRAIL_MERGE_KEYS(a + 1, a + 3) \
  VITRAIL_MERGE_2(a) VITRAIL_MERGE_2(a + 2)
#define VITRAIL_MERGE_8(a) \
  VITRAIL_MERGE_KEYS(a, a + 4) VITRAIL_MERGE_KEYS(a + 1, a + 5) VITRAIL_MERGE_KEYS(a + 2, a + 6) \
  VITRAIL_MERGE_KEYS(a + 3, a + 7) \
  VITRAIL_MERGE_4(a) VITRAIL_MERGE_4(a + 4)
#define VITRAIL_MERGE_16(a) \
  VITRAIL_MERGE_KEYS(a, a + 8) VITRAIL_MERGE_KEYS(a + 1, a + 9) VITRAIL_MERGE_KEYS(a + 2, a + 10) \
  VITRAIL_MERGE_KEYS(a + 3, a + 11) VITRAIL_MERGE_KEYS(a + 4, a + 12) VITRAIL_MERGE_KEYS(a + 5, a + 13) \
  VITRAIL_MERGE_KEYS(a + 6, a + 14) VITRAIL_MERGE_KEYS(a + 7, a + 15) \
  VITRAIL_MERGE_8(a) VITRAIL_MERGE_8(a + 8)
#define VITRAIL_MERGE_32(a) \
  VITRAIL_MERGE_KEYS(a, a + 16) VITRAIL_MERGE_KEYS(a + 1, a + 17) VITRAIL_MERGE_KEYS(a + 2, a + 18) \
  VITRAIL_MERGE_KEYS(a + 3, a + 19) VITRAIL_MERGE_KEYS(a + 4, a + 20) VITRAIL_MERGE_KEYS(a + 5, a + 21) \
  VITRAIL_MERGE_KEYS(a + 6, a + 22) VITRAIL_MERGE_KEYS(a + 7, a + 23) VITRAIL_MERGE_KEYS(a + 8, a + 24) \
  VITRAIL_MERGE_KEYS(a + 9, a + 25) VITRAIL_MERGE_KEYS(a + 10, a + 26) VITRAIL_MERGE_KEYS(a + 11, a + 27) \
  VITRAIL_MERGE_KEYS(a + 12, a + 28) VITRAIL_MERGE_KEYS(a + 13, a + 29) VITRAIL_MERGE_KEYS(a + 14, a + 30) \
  VITRAIL_MERGE_KEYS(a + 15, a + 31) \
  VITRAIL_MERGE_16(a) VITRAIL_MERGE_16(a + 16)
#define VITRAIL_EACH_OF_8(what, a) \
  what((a)) what((a + 1)) what((a + 2)) what((a + 3)) what((a + 4)) what((a + 5)) what((a + 6)) what((a + 7))
#define VITRAIL_EACH_KEPT(what) \
  VITRAIL_EACH_OF_8(what, 0) \
  if (VITRAIL_RASTER_KEEP > 8u) { \
    VITRAIL_EACH_OF_8(what, 8) \
  } \
  if (VITRAIL_RASTER_KEEP > 16u) { \
    VITRAIL_EACH_OF_8(what, 16) \
    VITRAIL_EACH_OF_8(what, 24) \
  }

// Eight sorted keys among the nearest ones. The nearest of those that there is no room for.
uint vitrailMergeNewKeys() {
  uint left = 0xffffffffu;
#define VITRAIL_KEEP_NEW(i) \
  left = min(left, max(vitrailNearestKeys[i], vitrailNewKeys[7 - (i & 7)])); \
  vitrailNearestKeys[i] = min(vitrailNearestKeys[i], vitrailNewKeys[7 - (i & 7)]);
  if (VITRAIL_RASTER_KEEP == 8u) {
    VITRAIL_EACH_OF_8(VITRAIL_KEEP_NEW, 0)
    VITRAIL_MERGE_8(0)
  } else if (VITRAIL_RASTER_KEEP == 16u) {
    VITRAIL_EACH_OF_8(VITRAIL_KEEP_NEW, 8)
    VITRAIL_MERGE_16(0)
  } else {
    VITRAIL_EACH_OF_8(VITRAIL_KEEP_NEW, 24)
    VITRAIL_MERGE_32(0)
  }
#undef VITRAIL_KEEP_NEW
  return left;
}

#endif
