// Records of a tile, VITRAIL_RASTER_PIXELS at a time, by a work group with a thread for each pixel: a thread finds out
// which of them cover its pixel.
#extension GL_KHR_shader_subgroup_shuffle : require
#ifndef VITRAIL_RASTER_BATCH_GLSL
#define VITRAIL_RASTER_BATCH_GLSL

#include "samples.glsl"

const uint VITRAIL_BATCHED = VITRAIL_RASTER_BATCHES > 1u ? 2u * VITRAIL_RASTER_PIXELS : VITRAIL_RASTER_PIXELS;
shared uint vitrailBatchMasks[2u * VITRAIL_BATCHED]; // that each covers: upper pixels of all, lower ones
shared vec4 vitrailBatchPlanes[VITRAIL_BATCHED];
// How much nearer than on its plane each may be, anywhere in the tile.
shared float vitrailBatchSlacks[VITRAIL_BATCHED];

uint vitrailThread; // set by main()

ivec2 vitrailFirstPixel(uint tile) {
  return ivec2(tile % vitrailRaster.tilesX, tile / vitrailRaster.tilesX) * 8 + ivec2(0, vitrailRaster.top);
}
bool vitrailIsInside(ivec2 pixel) { return pixel.x < int(vitrailRaster.width) && pixel.y < int(vitrailRaster.bottom); }

// Each vitrailThread loads one, or none, of the tile with that first pixel, and of two batches two; the place is the
// thread's, or in the second batch. A barrier has to come before and after.
void vitrailLoadBatch(uint place, bool any_, uint record, ivec2 corner) {
  uvec2 mask = any_ ? vitrailRecords[record].xy : uvec2(0u);
  if (any_) {
    vec4 plane = uintBitsToFloat(vitrailRecords[vitrailRaster.recordCapacity + record]);
    float slack = vitrailDepthSlack(plane, corner + 7);
    if (VITRAIL_RASTER_SAMPLES > 1u) slack += 0.5 * (abs(plane.y) + abs(plane.z));
    vitrailBatchPlanes[place] = plane;
    vitrailBatchSlacks[place] = slack;
  }
  vitrailBatchMasks[place] = mask.x;
  vitrailBatchMasks[VITRAIL_BATCHED + place] = mask.y;
}

// With VITRAIL_RASTER_SHUFFLES threads are side by side in subgroups of at least 32 that can hand each other words.
// Turns 32 words of a subgroup by the diagonal: bit i of word k is bit k of word i (Warren, "Hacker's Delight", 7-3).
// Two words of each thread, each for itself. What comes in again at the other end of a word is not kept.
uvec2 vitrailTransposed(uvec2 words) {
  uint lane = vitrailThread & 31u;
  uint low = 0xffffu;
  for (uint step = 16u; step != 0u; step >>= 1) {
    bool isLow = (lane & step) == 0u;
    uint keep = isLow ? low : ~low;
    uint left = isLow ? step : 32u - step;
    uvec2 other = subgroupShuffleXor(words, step);
    words = (words & keep) | ((other << left | other >> (32u - left)) & ~keep);
    low ^= low << (step >> 1);
  }
  return words;
}

// Whether a fragment of a batch is behind the opaque surfaces at all samples, of which the farthest is given.
bool vitrailIsHidden(uint inBatch, float depth, float farthest) {
  return depth + vitrailBatchSlacks[inBatch] < farthest;
}

// Those that cover the vitrailThread's pixel, a bit each, of the first batch or of the one that begins there, which has
// so many (or more than there is room for). All threads together.
uvec2 vitrailCovering(uint begin, uint count) {
  uint first = (vitrailThread >> 5) * VITRAIL_BATCHED + begin;
  if (VITRAIL_RASTER_SHUFFLES) {
    uint lane = vitrailThread & 31u;
    return vitrailTransposed(uvec2(vitrailBatchMasks[first + lane], vitrailBatchMasks[first + 32u + lane]));
  }
  uint bit = vitrailThread & 31u;
  uvec2 bits = uvec2(0u);
  uint i = 0u;
  do {
    bits.x |= (vitrailBatchMasks[first + i] >> bit & 1u) << i;
  } while (++i < min(count, 32u));
  if (count > 32u) {
    i = 0u;
    do {
      bits.y |= (vitrailBatchMasks[first + 32u + i] >> bit & 1u) << i;
    } while (++i < min(count - 32u, 32u));
  }
  return bits;
}

uint vitrailFirstBit(uvec2 bits) { return bits.x != 0u ? uint(findLSB(bits.x)) : 32u + uint(findLSB(bits.y)); }

uint vitrailTakeBit(inout uvec2 bits) {
  uint first = vitrailFirstBit(bits);
  if (bits.x != 0u) {
    bits.x &= bits.x - 1u;
  } else {
    bits.y &= bits.y - 1u;
  }
  return first;
}

#endif
