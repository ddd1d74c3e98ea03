// Keeping up to 16 fragments sorted in registers. Every array index is a constant, so that the array never becomes
// memory: a loop over a dynamically indexed local array is slow on GPUs, and one driver was seen to sort it wrongly.
#ifndef VITRAIL_SORT_GLSL
#define VITRAIL_SORT_GLSL

// A fragment's sorting key: x grows away from the viewer, y is the colour word, which orders equal depths. The key is
// the whole fragment, so two fragments with one key are the same and their order is of no consequence.
bool vitrailBefore(uvec2 a, uvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

// Behind every fragment.
const uvec2 VITRAIL_LAST_KEY = uvec2(0xffffffffu);
const uvec2 VITRAIL_LAST_KEYS[16] = uvec2[16](VITRAIL_LAST_KEY, VITRAIL_LAST_KEY, VITRAIL_LAST_KEY, VITRAIL_LAST_KEY,
                                              VITRAIL_LAST_KEY, VITRAIL_LAST_KEY, VITRAIL_LAST_KEY, VITRAIL_LAST_KEY,
                                              VITRAIL_LAST_KEY, VITRAIL_LAST_KEY, VITRAIL_LAST_KEY, VITRAIL_LAST_KEY,
                                              VITRAIL_LAST_KEY, VITRAIL_LAST_KEY, VITRAIL_LAST_KEY, VITRAIL_LAST_KEY);

// Puts two keys into ascending order.
void vitrailExchange(inout uvec2 a, inout uvec2 b) {
  bool swap = vitrailBefore(b, a);
  uvec2 low = swap ? b : a;
  b = swap ? a : b;
  a = low;
}

// Inserts a key into 16 ascending ones; the largest falls out.
void vitrailInsert(inout uvec2 k[16], uvec2 key) {
  vitrailExchange(k[0], key); vitrailExchange(k[1], key); vitrailExchange(k[2], key); vitrailExchange(k[3], key);
  vitrailExchange(k[4], key); vitrailExchange(k[5], key); vitrailExchange(k[6], key); vitrailExchange(k[7], key);
  vitrailExchange(k[8], key); vitrailExchange(k[9], key); vitrailExchange(k[10], key); vitrailExchange(k[11], key);
  vitrailExchange(k[12], key); vitrailExchange(k[13], key); vitrailExchange(k[14], key); vitrailExchange(k[15], key);
}

// Drops the first of 16 ascending keys.
void vitrailShift(inout uvec2 k[16]) {
  k[0] = k[1]; k[1] = k[2]; k[2] = k[3]; k[3] = k[4]; k[4] = k[5]; k[5] = k[6]; k[6] = k[7]; k[7] = k[8]; k[8] = k[9];
  k[9] = k[10]; k[10] = k[11]; k[11] = k[12]; k[12] = k[13]; k[13] = k[14]; k[14] = k[15]; k[15] = VITRAIL_LAST_KEY;
}

#endif
