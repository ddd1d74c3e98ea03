// Records of a tile, TILES_PIXELS at a time, by a work group with a thread for each pixel: a thread finds out which of
// them cover its pixel.
#extension GL_KHR_shader_subgroup_shuffle : require
#ifndef VITRAIL_TOOL_TILES_BATCH_GLSL
#define VITRAIL_TOOL_TILES_BATCH_GLSL

#include "samples.glsl"
#include "tiles_frame.glsl"

shared uint sharedMasks[2][TILES_PIXELS]; // the pixels that each covers
shared vec4 sharedPlanes[TILES_PIXELS];
shared float sharedSlacks[TILES_PIXELS]; // how much nearer than on its plane each may be, anywhere in the tile

uint thread; // set by main()

ivec2 firstPixel(uint tile) {
  return ivec2(tile % tiles.tilesX, tile / tiles.tilesX) * 8 + ivec2(0, tiles.top);
}
bool isInside(ivec2 pixel) { return pixel.x < int(tiles.width) && pixel.y < int(tiles.bottom); }

// Each thread loads one, or none, of the tile with that first pixel. A barrier has to come before and after.
void loadBatch(bool any_, uint record, ivec2 corner) {
  uvec2 mask = any_ ? records[2u * record].xy : uvec2(0u);
  if (any_) {
    vec4 plane = uintBitsToFloat(records[2u * record + 1u]);
    float slack = depthSlack(plane, corner + 7);
    if (kSamples > 1u) slack += 0.5 * (abs(plane.y) + abs(plane.z));
    sharedPlanes[thread] = plane;
    sharedSlacks[thread] = slack;
  }
  sharedMasks[0][thread] = mask.x;
  sharedMasks[1][thread] = mask.y;
}

// Whether threads are side by side in subgroups of at least 32 that can hand each other words.
layout(constant_id = 7) const bool kShuffles = false;

// Turns 32 words of a subgroup by the diagonal: bit i of word k is bit k of word i (Warren, "Hacker's Delight", 7-3).
uint transposed(uint word) {
  uint lane = thread & 31u;
  uint low = 0xffffu;
  for (uint step = 16u; step != 0u; step >>= 1) {
    uint other = subgroupShuffleXor(word, step);
    word = (lane & step) == 0u ? (word & low) | (other & low) << step : (other >> step & low) | (word & ~low);
    low ^= low << (step >> 1);
  }
  return word;
}

// Whether a fragment of a batch is behind the opaque surfaces at all samples, of which the farthest is given.
bool isHidden(uint inBatch, float depth, float farthest) { return depth + sharedSlacks[inBatch] < farthest; }

// Those that cover the thread's pixel, a bit each. All threads together.
uvec2 covering() {
  uint half_ = thread >> 5;
  if (kShuffles) {
    uint lane = thread & 31u;
    return uvec2(transposed(sharedMasks[half_][lane]), transposed(sharedMasks[half_][32u + lane]));
  }
  uint bit = thread & 31u;
  uvec2 bits = uvec2(0u);
  for (uint i = 0u; i < 32u; ++i) {
    bits.x |= (sharedMasks[half_][i] >> bit & 1u) << i;
    bits.y |= (sharedMasks[half_][32u + i] >> bit & 1u) << i;
  }
  return bits;
}

uint firstBit(uvec2 bits) { return bits.x != 0u ? uint(findLSB(bits.x)) : 32u + uint(findLSB(bits.y)); }

uint takeBit(inout uvec2 bits) {
  uint first = firstBit(bits);
  if (bits.x != 0u) {
    bits.x &= bits.x - 1u;
  } else {
    bits.y &= bits.y - 1u;
  }
  return first;
}

#endif
