// Sorts and blends the fragments of a tile, a work group a tile and a thread a pixel. A thread goes through the
// records that cover its pixel and keeps the nearest TILES_KEEP fragments in registers, as keys of depth and the
// record's number in the tile; then it shades these from the front. Pixels that have more, and have not ended, take
// the next in another turn. Nothing is stored but the order of what a turn has kept. A tile that takes too many turns,
// or in which more than TILES_KEEP fragments of a pixel have one depth, as far as keys hold it, is left to
// tiles_deep_*.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#ifndef TILES_KEEP
#define TILES_KEEP 16
#endif
#include "blending.glsl"
#include "batch.glsl"
#include "nearest.glsl"
#include "tiles_deep.glsl"

layout(local_size_x = TILES_PIXELS) in;

layout(constant_id = 3) const bool kOneBatch = false; // whether the tile has up to TILES_PIXELS records
layout(constant_id = 5) const uint kClass = 0u;

layout(set = 3, binding = 17, std430) readonly buffer ClassBlock { TilesClasses classes; };

shared uint sharedOrder[TILES_KEEP / 2 * TILES_PIXELS]; // numbers of kept records, two a word
shared uint sharedGoesOn[2]; // in turns
shared uint sharedTooShort;

uint firstPair; // of the tile
uint alikeFirst; // of the fragments that are blended
ivec2 inTile;

// Of the i-th fragment that was kept: the number of its record in the tile.
uint orderAt(uint i) { return sharedOrder[(i >> 1) * TILES_PIXELS + thread] >> (16u * (i & 1u)) & 0xffffu; }
void setOrder(uint i, uint number) {
  uint shift = 16u * (i & 1u);
  uint at = (i >> 1) * TILES_PIXELS + thread;
  sharedOrder[at] = (sharedOrder[at] & ~(0xffffu << shift)) | number << shift;
}

uint recordOf(uint number) { return pairs[firstPair + number].y; }
uint alikeRecord(uint i) { return recordOf(orderAt(alikeFirst + i)); }
Surface alikeSurface(uint i, ivec2 pixel) {
  uint number = orderAt(alikeFirst + i);
  uvec2 pair = pairs[firstPair + number];
  return shadeFragment(records[2u * pair.y].zw, pair.x, pixel, vec2(tiles.width, tiles.height));
}

uint exactKey(uint number) { return keyOf(depthOn(uintBitsToFloat(records[2u * recordOf(number) + 1u]), inTile)); }
bool isBefore(uint a, uint b) {
  uint keyA = exactKey(a);
  uint keyB = exactKey(b);
  return keyA < keyB || (keyA == keyB && sourceBefore(recordOf(a), recordOf(b)));
}

uint numberBits; // of keys, which hold as much of the depth as there is room for above the record's number
uint depthOf(uint key) { return key >> numberBits; }

// Takes one of a batch's fragments that cover the pixel, or none where there is none any more.
#define TAKE_KEY(i) { \
  bool isLow = bits.x != 0u; \
  uint word = isLow ? bits.x : bits.y; \
  uint number = uint(findLSB(word)) + (isLow ? 0u : 32u); \
  bool isThere = word != 0u; \
  word &= word - 1u; \
  if (isLow) bits.x = word; else bits.y = word; \
  uint inBatch = number & (TILES_PIXELS - 1u); \
  float depth = depthOn(sharedPlanes[inBatch], inTile); \
  uint key = (keyOf(depth) >> (numberBits - 2u)) << numberBits | (base + number); \
  if (key < from || isHidden(inBatch, depth, farthest)) isThere = false; \
  newKeys[i] = isThere ? key : NO_FRAGMENT; \
}

// Finds the nearest fragments of a pixel whose keys are not below `from`: the nearest key of those that were left.
uint findNearest(uint count, uint from, ivec2 corner, float farthest, bool ended, bool isFirst) {
  uint left = NO_FRAGMENT;
  bool isEmpty = true;
#define FORGET(i) nearestKeys[i] = NO_FRAGMENT;
  EACH_KEPT(FORGET)
  uint base = 0u;
  for (; base < count; base += TILES_PIXELS) {
    if (isFirst || !kOneBatch) {
      if (!isFirst || base > 0u) barrier(); // all have left the last batch
      uint number = base + thread;
      loadBatch(number < count, number < count ? recordOf(number) : 0u, corner);
      barrier();
    }
    uvec2 bits = covering();
    if (ended) bits = uvec2(0u);
    while ((bits.x | bits.y) != 0u) {
      TAKE_KEY(0) TAKE_KEY(1) TAKE_KEY(2) TAKE_KEY(3)
      newKeys[4] = newKeys[5] = newKeys[6] = newKeys[7] = NO_FRAGMENT;
      if ((bits.x | bits.y) != 0u) {
        TAKE_KEY(4) TAKE_KEY(5) TAKE_KEY(6) TAKE_KEY(7)
      }
      sortNewKeys();
      if (isEmpty) {
#define TAKE_NEW(i) nearestKeys[i] = newKeys[i];
        TAKE_NEW(0) TAKE_NEW(1) TAKE_NEW(2) TAKE_NEW(3) TAKE_NEW(4) TAKE_NEW(5) TAKE_NEW(6) TAKE_NEW(7)
        isEmpty = false;
      } else {
        left = min(left, mergeNewKeys());
      }
    }
    if ((bits.x | bits.y) != 0u) sharedTooShort = 1u; // the driver has ended the loop
  }
  if (base < count) sharedTooShort = 1u; // as above
  return left;
}

// Puts fragments whose keys hold the same depth in order.
void settle(uint ties, uint count) {
  for (uint i = 1u; i < count; ++i) {
    for (uint k = i; k > 0u && (ties >> (k - 1u) & 1u) != 0u; --k) {
      uint a = orderAt(k - 1u);
      uint b = orderAt(k);
      if (isBefore(a, b)) break;
      setOrder(k - 1u, b);
      setOrder(k, a);
    }
  }
}

// How many fragments from the i-th on have one depth.
uint alikeFrom(uint i, uint ties, uint count) {
  uint alike = 1u;
  if ((ties >> i & 1u) == 0u) return alike;
  uint key = exactKey(orderAt(i));
  while (i + alike < count && (ties >> (i + alike - 1u) & 1u) != 0u && exactKey(orderAt(i + alike)) == key) ++alike;
  return alike;
}

void main() {
  thread = gl_LocalInvocationIndex;
  uint place = flatGroup();
  if (place >= classes.of[kClass].count) return;
  uint tile = tileList[kClass * tiles.tilesX * tiles.tilesY + place];
  uint count = tileRecords[tile].x;
  firstPair = tileRecords[tile].y;
  inTile = ivec2(thread & 7u, thread >> 3);
  ivec2 corner = firstPixel(tile);
  ivec2 pixel = corner + inTile;
  bool inside = isInside(pixel);
  if (!inside) pixel = ivec2(0);
  PixelLight light = lightBehind(pixel);
  float farthest = farthestDepth(pixel);
  numberBits = max(uint(findMSB(max(count, 2u) * 2u - 1u)), 2u); // keys of depths have 30
  bool isEmpty = true;
  bool ended = !inside;
  bool isFirst = true;
  uint from = 0u;
  if (thread == 0u) {
    sharedTooShort = 0u;
    sharedGoesOn[0] = 0u;
  }
  uint batches = (count + TILES_PIXELS - 1u) / TILES_PIXELS;
  uint turns = max(tiles.mostVisits / batches, 1u);
  for (uint i = 0u; i < turns; ++i) {
    uint turn = i & 1u;
    uint left = findNearest(count, from, corner, farthest, ended, isFirst);
    isFirst = false;
    // All of a depth that some were left of come in the next turn.
    uint end = left == NO_FRAGMENT ? NO_FRAGMENT : depthOf(left) << numberBits;
    uint kept = 0u;
    uint ties = 0u;
    uint numbers = (1u << numberBits) - 1u;
#define COUNT_KEPT(i) \
    if (nearestKeys[i] < end) ++kept; \
    if (i + 1 < TILES_KEEP && nearestKeys[i + 1 < TILES_KEEP ? i + 1 : i] != NO_FRAGMENT && \
        depthOf(nearestKeys[i]) == depthOf(nearestKeys[i + 1 < TILES_KEEP ? i + 1 : i])) ties |= 1u << i;
    EACH_KEPT(COUNT_KEPT)
#define STORE_KEPT(i) \
    if ((i & 1) == 0) \
      sharedOrder[i / 2 * TILES_PIXELS + thread] = (nearestKeys[i] & numbers) | (nearestKeys[i | 1] & numbers) << 16;
    EACH_KEPT(STORE_KEPT)
    if (ties != 0u) settle(ties, kept);
    uint k = 0u;
#ifndef TILES_MSAA // of several samples it came out slower
    // Up to the first that has the depth of another, which most pixels have not: nothing waits for what these take.
    for (; k < kept && !ended; ++k) {
      if ((ties >> k & 1u) != 0u && alikeFrom(k, ties, kept) > 1u) break;
      alikeFirst = k;
      blendAlike(light, pixel, thread, 1u);
      isEmpty = false;
      if (hasEnough(light)) ended = true;
    }
#endif
    uint singles = 0u; // at one depth, more than whose order their colours decide
    while (k < kept && !ended) {
      uint alike = singles > 0u ? 1u : alikeFrom(k, ties, kept);
      if (alike > TILES_TIES) singles = alike;
      if (singles > 0u) {
        --singles;
        alike = 1u;
      }
      alikeFirst = k;
      blendAlike(light, pixel, thread, alike);
      isEmpty = false;
      k += alike;
      if (hasEnough(light)) ended = true;
    }
    if (k < kept && !ended) sharedTooShort = 1u; // as above
    if (left == NO_FRAGMENT) ended = true;
    if (!ended && kept == 0u) { // more than there is room for have one depth
      sharedTooShort = 1u;
      ended = true;
    }
    from = end;
    if (!ended) sharedGoesOn[turn] = 1u;
    barrier();
    if (sharedGoesOn[turn] == 0u) break;
    if (thread == 0u) sharedGoesOn[turn ^ 1u] = 0u;
    barrier();
  }
  if (!ended) sharedTooShort = 1u; // too many turns, or as above
  barrier();
  if (sharedTooShort != 0u) {
    if (thread == 0u) addDeep(tile, count);
    return;
  }
  if (inside && !isEmpty) blendOver(pixel, light);
}
