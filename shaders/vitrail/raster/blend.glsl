// Sorts and blends the fragments of a tile, a work group a tile and a thread a pixel. A thread goes through the
// records that cover its pixel and keeps the nearest VITRAIL_RASTER_KEEP fragments in registers, as keys of depth
// and the record's number in the tile; then it shades these from the front. Pixels that have more, and have not ended,
// take the next in another turn. Nothing is stored but the order of what a turn has kept. A tile that takes too many
// turns, or in which more than VITRAIL_RASTER_KEEP fragments of a pixel have one depth, as far as keys hold it, is left
// to the passes of deep tiles.
#ifndef VITRAIL_RASTER_BLEND_GLSL
#define VITRAIL_RASTER_BLEND_GLSL

#include "batch.glsl"
#include "nearest.glsl"
#include "deep.glsl"
#include "light.glsl"
#include "pages.glsl"

layout(local_size_x = VITRAIL_RASTER_PIXELS) in;

layout(push_constant) uniform VitrailClassBlock { uint vitrailClass; }; // of tiles

layout(VITRAIL_RASTER_BOUND(17), std430) readonly buffer VitrailTileClassBlock {
  VitrailRasterTileClasses vitrailTileClasses;
};

// Of the i-th fragment that a pixel has kept the number of its record in the tile: two a word, or four where a tile has
// no more than VITRAIL_RASTER_PIXELS.
const uint VITRAIL_ORDER_SHIFT = VITRAIL_RASTER_BATCHES > 0u ? 1u : 2u;
const uint VITRAIL_ORDER_BITS = 32u >> VITRAIL_ORDER_SHIFT;
const uint VITRAIL_ORDER_MASK = (1u << VITRAIL_ORDER_BITS) - 1u;
const uint VITRAIL_ORDER_LAST = (1u << VITRAIL_ORDER_SHIFT) - 1u;
shared uint vitrailKeptOrder[(VITRAIL_RASTER_KEEP >> VITRAIL_ORDER_SHIFT) * VITRAIL_RASTER_PIXELS];
shared uint vitrailGoesOn[2]; // in turns
shared uint vitrailTooShort;
// The tile and how many records it has: looked up where they are asked for again, so that no register has to hold them
// meanwhile.
shared uvec2 vitrailTileNow;

uint vitrailTile; // which it is
uint vitrailAlikeFirst; // of the fragments that are blended
ivec2 vitrailInTile;

uint vitrailOrderAt(uint i) {
  return vitrailKeptOrder[(i >> VITRAIL_ORDER_SHIFT) * VITRAIL_RASTER_PIXELS + vitrailThread] >>
             (VITRAIL_ORDER_BITS * (i & VITRAIL_ORDER_LAST)) & VITRAIL_ORDER_MASK;
}
void vitrailSetOrder(uint i, uint number) {
  uint shift = VITRAIL_ORDER_BITS * (i & VITRAIL_ORDER_LAST);
  uint at = (i >> VITRAIL_ORDER_SHIFT) * VITRAIL_RASTER_PIXELS + vitrailThread;
  vitrailKeptOrder[at] = (vitrailKeptOrder[at] & ~(VITRAIL_ORDER_MASK << shift)) | number << shift;
}

// Of each page of the tile where the tile's first record would be if all were side by side: what vitrailRecordOf()
// gives, without a branch or a look at memory. There from the first barrier on.
shared uint vitrailPageStarts[VITRAIL_RASTER_MOST_PAGES];

void vitrailSharePages(uint count) {
  uint page = vitrailThread;
  if (page > vitrailPageOf(count - 1u)) return;
  uint place = page == 0u ? vitrailFirstPlace(vitrailTile) : vitrailTiles[vitrailWordOfPage(vitrailTile, page)];
  vitrailPageStarts[page] = place - vitrailFirstOfPage(page);
}

uint vitrailRecordAt(uint number) { return vitrailPageStarts[vitrailPageOf(number)] + number; }
uint vitrailAlikeRecord(uint i) { return vitrailRecordAt(vitrailOrderAt(vitrailAlikeFirst + i)); }

// The source of a fragment that is blended alone is asked for while the one before is shaded. Not where all records of
// a tile came at once: there it takes a register more than it saves time.
const bool VITRAIL_ASKS_AHEAD = VITRAIL_RASTER_BATCHES > 0u;
uvec2 vitrailSourceAt(uint i) { return vitrailRecords[vitrailRecordAt(vitrailOrderAt(i))].zw; }
uvec2 vitrailSourceAhead(uint i) { return VITRAIL_ASKS_AHEAD ? vitrailSourceAt(i) : uvec2(0u); }

uvec2 vitrailAloneSource;
VitrailSurface vitrailAlikeSurface(uint i, ivec2 pixel, bool alone) {
  if (VITRAIL_ASKS_AHEAD && alone) return vitrailSurfaceOf(vitrailAloneSource, pixel);
  return vitrailSurfaceOf(vitrailSourceAt(vitrailAlikeFirst + i), pixel);
}

uint vitrailExactKey(uint number) {
  vec4 plane = uintBitsToFloat(vitrailRecords[vitrailRaster.recordCapacity + vitrailRecordAt(number)]);
  return vitrailDistance(vitrailDepthOn(plane, vitrailInTile));
}
bool vitrailIsBefore(uint a, uint b) {
  uint keyA = vitrailExactKey(a);
  uint keyB = vitrailExactKey(b);
  return keyA < keyB || (keyA == keyB && vitrailSourceBefore(vitrailRecordAt(a), vitrailRecordAt(b)));
}

// The bits of a key that hold the record's number in the tile: two at least. Above them is as much of the depth as has
// room.
uint vitrailNumbers;
uint vitrailNumbersOf(uint count) { return (1u << max(uint(findMSB(max(count, 2u) * 2u - 1u)), 2u)) - 1u; }
// Of a depth from 0 to 1: vitrailDistance(), which has 30 bits, from the highest bit on.
uint vitrailKeyOf(float depth, uint number) {
  return ((0xfe000000u - 4u * floatBitsToUint(depth)) & ~vitrailNumbers) | number;
}

// Takes one of a batch's fragments that cover the pixel, or none where there is none any more.
#define VITRAIL_TAKE_KEY(i) { \
  if (VITRAIL_RASTER_BATCHES > 1u && (bits.x | bits.y) == 0u) { \
    bits = more; \
    more = uvec2(0u); \
    begin = VITRAIL_RASTER_PIXELS; \
  } \
  if (bits.x == 0u) { \
    bits.x = bits.y; \
    bits.y = 0u; \
    begin |= 32u; \
  } \
  bool isThere = bits.x != 0u; \
  uint highest = uint(findMSB(bits.x)) & 31u; \
  bits.x &= ~(1u << highest); \
  uint number = begin | highest; \
  float depth = vitrailDepthOn(vitrailBatchPlanes[number], vitrailInTile); \
  uint key = vitrailKeyOf(depth, base | number); \
  bool isHidden = vitrailIsHidden(number, depth, farthest); /* asked in any case: a branch takes longer */ \
  if (key < from || isHidden) isThere = false; \
  vitrailNewKeys[i] = isThere ? key : VITRAIL_NO_FRAGMENT; \
}

// A record of a batch, or none. `isFirst`: of the first one, before which no barrier comes.
void vitrailLoadNumber(uint place, uint number, uint count, bool isFirst, ivec2 corner) {
  uint record = 0u;
  if (number < count) record = isFirst ? vitrailRecordOf(vitrailTile, number) : vitrailRecordAt(number);
  vitrailLoadBatch(place, number < count, record, corner);
}

// Finds the nearest fragments of a pixel whose keys are not below `from`: the nearest key of those that were left.
uint vitrailFindNearest(uint count, uint from, ivec2 corner, float farthest, bool ended, bool isFirst) {
  uint left = VITRAIL_NO_FRAGMENT;
  bool isEmpty = true;
#define VITRAIL_FORGET(i) vitrailNearestKeys[i] = VITRAIL_NO_FRAGMENT;
  VITRAIL_EACH_KEPT(VITRAIL_FORGET)
  uint base = 0u;
  for (; base < count; base += VITRAIL_BATCHED) {
    if (isFirst || VITRAIL_RASTER_BATCHES > 0u) {
      if (!isFirst || base > 0u) barrier(); // all have left the last batch
      vitrailLoadNumber(vitrailThread, base + vitrailThread, count, isFirst && base == 0u, corner);
      if (VITRAIL_RASTER_BATCHES > 1u) {
        uint second = VITRAIL_RASTER_PIXELS + vitrailThread;
        vitrailLoadNumber(second, base + second, count, isFirst && base == 0u, corner);
      }
      barrier();
    }
    uvec2 bits = vitrailCovering(0u, count - base);
    uvec2 more = uvec2(0u); // of the second batch, which begins there
    uint begin = 0u;
    if (VITRAIL_RASTER_BATCHES > 1u && base + VITRAIL_RASTER_PIXELS < count) {
      more = vitrailCovering(VITRAIL_RASTER_PIXELS, count - base - VITRAIL_RASTER_PIXELS);
    }
    if (ended) bits = more = uvec2(0u);
    while ((bits.x | bits.y | more.x | more.y) != 0u) {
      VITRAIL_TAKE_KEY(0) VITRAIL_TAKE_KEY(1) VITRAIL_TAKE_KEY(2) VITRAIL_TAKE_KEY(3)
      vitrailNewKeys[4] = vitrailNewKeys[5] = vitrailNewKeys[6] = vitrailNewKeys[7] = VITRAIL_NO_FRAGMENT;
      if ((bits.x | bits.y | more.x | more.y) != 0u) {
        VITRAIL_TAKE_KEY(4) VITRAIL_TAKE_KEY(5) VITRAIL_TAKE_KEY(6) VITRAIL_TAKE_KEY(7)
        vitrailSortNewKeys();
      } else {
        vitrailSortFourKeys();
      }
      if (isEmpty) {
#define VITRAIL_TAKE_NEW(i) vitrailNearestKeys[i] = vitrailNewKeys[i];
        VITRAIL_EACH_OF_8(VITRAIL_TAKE_NEW, 0)
        isEmpty = false;
      } else {
        left = min(left, vitrailMergeNewKeys());
      }
    }
    if ((bits.x | bits.y | more.x | more.y) != 0u) vitrailTooShort = 1u; // the driver has ended the loop
  }
  if (base < count) vitrailTooShort = 1u; // as above
  return left;
}

// Puts fragments whose keys hold the same depth in order. Those that have one depth indeed stay ties.
void vitrailSettle(inout uint ties, uint count) {
  uint left = count > 1u ? ties & ((1u << (count - 1u)) - 1u) : 0u;
  ties = 0u;
  while (left != 0u) { // each thread goes to its own next run
    uint first = uint(findLSB(left));
    uint last = first + uint(findLSB(~(left >> first)));
    left &= ~((1u << last) - (1u << first));
    if (last > first + 1u) {
      for (uint i = first + 1u; i <= last; ++i) {
        for (uint k = i; k > first; --k) {
          uint a = vitrailOrderAt(k - 1u);
          uint b = vitrailOrderAt(k);
          if (vitrailIsBefore(a, b)) break;
          vitrailSetOrder(k - 1u, b);
          vitrailSetOrder(k, a);
        }
      }
    }
    uint a = vitrailOrderAt(first);
    uint keyA = vitrailExactKey(a);
    for (uint i = first + 1u; i <= last; ++i) {
      uint b = vitrailOrderAt(i);
      uint keyB = vitrailExactKey(b);
      if (keyA == keyB) ties |= 1u << (i - 1u);
      bool isPair = last == first + 1u; // as most are: not in order yet
      if (isPair && (keyB < keyA || (keyA == keyB && vitrailSourceBefore(vitrailRecordAt(b), vitrailRecordAt(a))))) {
        vitrailSetOrder(first, b);
        vitrailSetOrder(last, a);
      }
      keyA = keyB;
    }
  }
}

#ifdef VITRAIL_MULTISAMPLED
uint vitrailSamplesOf(uint number) { return vitrailCoveredSamples(vitrailRecordAt(number), vitrailThread); }

// Where fragments whose keys hold the same depth cover no sample together, as the two halves of a flat quad do along
// their diagonal, it does not matter which of them is in front: they come by their first samples, and are ties no more.
// This saves looking up depths and sources, and shading them several times.
void vitrailPartTies(inout uint ties, uint count) {
  uint left = count > 1u ? ties & ((1u << (count - 1u)) - 1u) : 0u;
  while (left != 0u) { // each thread goes to its own next one
    uint first = uint(findLSB(left));
    uint last = first + uint(findLSB(~(left >> first))); // of the run
    uint run = (1u << last) - (1u << first);
    left &= ~run;
    uint a = vitrailOrderAt(first);
    uint b = vitrailOrderAt(first + 1u);
    uint samplesA = vitrailSamplesOf(a);
    uint samplesB = vitrailSamplesOf(b);
    uint twice = samplesA & samplesB;
    uint all = samplesA | samplesB;
    for (uint i = first + 2u; i <= last; ++i) {
      uint samples = vitrailSamplesOf(vitrailOrderAt(i));
      twice |= all & samples;
      all |= samples;
    }
    if (twice != 0u) continue;
    ties &= ~run;
    if (findLSB(samplesA) > findLSB(samplesB)) {
      vitrailSetOrder(first, b);
      vitrailSetOrder(first + 1u, a);
    }
    for (uint i = first + 2u; i <= last; ++i) {
      uint number = vitrailOrderAt(i);
      uint at = i;
      int lowest = findLSB(vitrailSamplesOf(number));
      for (; at > first; --at) {
        uint before = vitrailOrderAt(at - 1u);
        if (findLSB(vitrailSamplesOf(before)) < lowest) break;
        vitrailSetOrder(at, before);
      }
      vitrailSetOrder(at, number);
    }
  }
}
#endif

// How many fragments from the i-th on have one depth.
uint vitrailAlikeFrom(uint i, uint ties) { return 1u + uint(findLSB(~(ties >> i))); }

void vitrailBlendTile(uint tile, uint count) {
  vitrailTile = tile;
  vitrailSharePages(count);
  vitrailInTile = ivec2(vitrailThread & 7u, vitrailThread >> 3);
  ivec2 corner = vitrailFirstPixel(tile);
  ivec2 pixel = corner + vitrailInTile;
  bool inside = vitrailIsInside(pixel);
  if (!inside) pixel = ivec2(0);
  VitrailPixelLight light = vitrailLightBehind(pixel);
  vitrailNumbers = vitrailNumbersOf(count);
  bool ended = !inside;
  bool isFirst = true;
  uint from = 0u;
  if (vitrailThread == 0u) {
    vitrailTileNow = uvec2(tile, count);
    vitrailTooShort = 0u;
    vitrailGoesOn[0] = 0u;
  }
  uint turns = 0u; // that are done
  do {
    uint turn = turns & 1u;
    // Asked for in each turn: registers are dearer.
    uint end = vitrailFindNearest(count, from, corner, vitrailFarthestDepth(pixel), ended, isFirst);
    isFirst = false;
    // All of a depth that some were left of come in the next turn.
    if (end != VITRAIL_NO_FRAGMENT) end &= ~vitrailNumbers;
    uint kept = 0u;
    uint ties = 0u;
#define VITRAIL_AFTER(i) (i + 1 < int(VITRAIL_RASTER_MOST_KEPT) ? i + 1 : i)
#define VITRAIL_COUNT_KEPT(i) \
    if (vitrailNearestKeys[i] < end) ++kept; \
    if (i + 1 < VITRAIL_RASTER_KEEP) { \
      uint differ = vitrailNearestKeys[i] ^ vitrailNearestKeys[VITRAIL_AFTER(i)]; /* 0: there are none any more */ \
      if (differ - 1u < vitrailNumbers) ties |= 1u << i; \
    }
    VITRAIL_EACH_KEPT(VITRAIL_COUNT_KEPT)
#define VITRAIL_STORE_KEPT(i) \
    if (VITRAIL_RASTER_BATCHES == 0u) { \
      if ((i & 3) == 0) \
        vitrailKeptOrder[i / 4 * VITRAIL_RASTER_PIXELS + vitrailThread] = \
            (vitrailNearestKeys[i] & vitrailNumbers) | (vitrailNearestKeys[i | 1] & vitrailNumbers) << 8 | \
            (vitrailNearestKeys[i | 2] & vitrailNumbers) << 16 | (vitrailNearestKeys[i | 3] & vitrailNumbers) << 24; \
    } else if ((i & 1) == 0) \
      vitrailKeptOrder[i / 2 * VITRAIL_RASTER_PIXELS + vitrailThread] = \
          (vitrailNearestKeys[i] & vitrailNumbers) | (vitrailNearestKeys[i | 1] & vitrailNumbers) << 16;
    VITRAIL_EACH_KEPT(VITRAIL_STORE_KEPT)
#ifdef VITRAIL_MULTISAMPLED
    if (ties != 0u) vitrailPartTies(ties, kept);
#endif
    if (ties != 0u) vitrailSettle(ties, kept);
    uint k = 0u;
    uvec2 next = kept > 0u ? vitrailSourceAhead(0u) : uvec2(0u);
    // Up to the first that has the depth of another, which most pixels have not.
    for (; k < kept && !ended && (ties >> k & 1u) == 0u; ++k) {
      vitrailAlikeFirst = k;
      vitrailAloneSource = next;
      if (k + 1u < kept) next = vitrailSourceAhead(k + 1u);
      vitrailBlendAlike(light, pixel, vitrailThread, 1u);
      if (vitrailHasEnough(light)) ended = true;
    }
    uint singles = 0u; // at one depth, more than whose order their colours decide
    while (k < kept && !ended) {
      uint alike = singles > 0u ? 1u : vitrailAlikeFrom(k, ties);
      if (alike > VITRAIL_RASTER_TIES) singles = alike;
      if (singles > 0u) {
        --singles;
        alike = 1u;
      }
      vitrailAlikeFirst = k;
      vitrailAloneSource = vitrailSourceAhead(k);
      vitrailBlendAlike(light, pixel, vitrailThread, alike);
      k += alike;
      if (vitrailHasEnough(light)) ended = true;
    }
    if (k < kept && !ended) vitrailTooShort = 1u; // as above
    if (end == VITRAIL_NO_FRAGMENT) ended = true;
    if (!ended && kept == 0u) { // more than there is room for have one depth
      vitrailTooShort = 1u;
      ended = true;
    }
    from = end;
    if (!ended) vitrailGoesOn[turn] = 1u;
    barrier();
    if (vitrailGoesOn[turn] == 0u) break;
    if (vitrailThread == 0u) vitrailGoesOn[turn ^ 1u] = 0u;
    barrier();
    count = vitrailTileNow.y;
    corner = vitrailFirstPixel(vitrailTileNow.x);
    vitrailNumbers = vitrailNumbersOf(count);
    ++turns;
  } while (turns < vitrailRaster.mostVisits / ((count + VITRAIL_RASTER_PIXELS - 1u) / VITRAIL_RASTER_PIXELS));
  if (!ended) vitrailTooShort = 1u; // too many turns, or as above
  barrier();
  if (vitrailTooShort != 0u) {
    if (vitrailThread == 0u) vitrailAddDeep(vitrailTileNow.x, vitrailTileNow.y);
    return;
  }
#ifdef VITRAIL_MULTISAMPLED
  // Also where nothing shows: nobody else writes the pixel.
  if (vitrailIsInside(vitrailFirstPixel(vitrailTileNow.x) + vitrailInTile)) vitrailBlendOver(pixel, light);
#else
  bool isEmpty = VITRAIL_THROUGH(light, 0) == vec4(1.0) && light.color == vec3(0.0); // as where there is no pixel
  if (!isEmpty) vitrailBlendOver(pixel, light);
#endif
}

// There may be more work groups than tiles, or fewer.
void main() {
  vitrailThread = gl_LocalInvocationIndex;
  uint tiles = vitrailRaster.tilesX * vitrailRaster.tilesY;
  uint place = vitrailFlatGroup();
  while (true) {
    // Looked up before it is known whether there is one, as each thing that is waited for takes its time.
    uvec2 listed = vitrailTileList[vitrailClass * tiles + min(place, tiles - 1u)];
    uint all = vitrailTileClasses.of[vitrailClass].count;
    uint count = place < all ? listed.y : 0u;
    if (count == 0u) return;
    vitrailBlendTile(listed.x, count);
    place += gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    if (place >= all) return;
    barrier(); // before the next tile's take the place of what this one's share
  }
}

#endif
