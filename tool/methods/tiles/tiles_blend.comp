// Sorts and blends the fragments of a tile, a work group a tile and a thread a pixel. The tile's records are sorted by
// their nearest depths and then walked: a thread keeps the fragments that it has met in a short list, in order, and
// shades the nearest once no record that is still to come can be before it. So a pixel ends where enough is hidden, and
// of records that do not cross each other the list holds only a few. Where it is too short, the tile is left to
// tiles_deep_*.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#include "blending.glsl"
#include "batch.glsl"
#include "tiles_deep.glsl"

layout(local_size_x = TILES_PIXELS) in;

layout(constant_id = 3) const uint kRecords = 256u; // at most that the tile has: a power of two
layout(constant_id = 4) const uint kPending = 16u;  // fragments that a list holds: a power of two
layout(constant_id = 5) const bool kSecondClass = false;

layout(set = 3, binding = 17, std430) readonly buffer ClassBlock { TilesClasses classes; };

shared uint sharedKeys[kRecords]; // sorted: of records the nearest depth, and their number
shared uint sharedRecords[kRecords];
shared uint pendingKeys[kPending * TILES_PIXELS];
shared uint pendingRecords[kPending * TILES_PIXELS];
shared uint sharedGoesOn[2]; // in turns
shared uint sharedTooShort;

uint head = 0u;    // where in the ring the nearest fragment is
uint pending = 0u; // fragments in it

uint ringAt(uint i) { return ((head + i) & (kPending - 1u)) * TILES_PIXELS + thread; }

// Sorts the tile's records: few by counting for each how many are nearer, which needs no steps, more by a network
// (Batcher, "Sorting networks and their applications", 1968).
void sortRecords(uint count, uint first) {
  if (count <= TILES_PIXELS) {
    uvec2 mine = thread < count ? pairs[first + thread] : uvec2(0xffffffffu);
    pendingKeys[thread] = mine.x; // nothing is pending yet
    barrier();
    uint place = 0u;
    for (uint i = 0u; i < count; ++i) {
      uint other = pendingKeys[i];
      place += other < mine.x || (other == mine.x && i < thread) ? 1u : 0u;
    }
    if (thread < count) {
      sharedKeys[place] = mine.x;
      sharedRecords[place] = mine.y;
    }
    barrier();
    return;
  }
  uint size = 2u * TILES_PIXELS;
  while (size < count) size *= 2u;
  for (uint i = thread; i < size; i += TILES_PIXELS) {
    uvec2 pair = i < count ? pairs[first + i] : uvec2(0xffffffffu);
    sharedKeys[i] = pair.x;
    sharedRecords[i] = pair.y;
  }
  barrier();
  for (uint run = 2u; run <= size; run *= 2u) {
    for (uint step = run / 2u; step > 0u; step /= 2u) {
      for (uint i = thread; i < size / 2u; i += TILES_PIXELS) {
        uint low = 2u * i - (i & (step - 1u));
        uint high = low + step;
        uint a = sharedKeys[low];
        uint b = sharedKeys[high];
        if ((a > b) == ((low & run) == 0u) && a != b) {
          sharedKeys[low] = b;
          sharedKeys[high] = a;
          uint record = sharedRecords[low];
          sharedRecords[low] = sharedRecords[high];
          sharedRecords[high] = record;
        }
      }
      barrier();
    }
  }
}

void insert(uint key, uint record) {
  uint i = pending;
  while (i > 0u) {
    uint before = ringAt(i - 1u);
    uint other = pendingKeys[before];
    if (other < key || (other == key && !sourceBefore(record, pendingRecords[before]))) break;
    uint to = ringAt(i);
    pendingKeys[to] = other;
    pendingRecords[to] = pendingRecords[before];
    --i;
  }
  uint to = ringAt(i);
  pendingKeys[to] = key;
  pendingRecords[to] = record;
  ++pending;
}

uint alikeRecord(uint i) { return pendingRecords[ringAt(i)]; }

// Blends the nearest fragments of the list, all that have one depth.
void blendNearest(inout PixelLight light, ivec2 pixel) {
  uint key = pendingKeys[ringAt(0u)];
  uint alike = 1u;
  while (alike < pending && pendingKeys[ringAt(alike)] == key) ++alike;
  blendAlike(light, pixel, thread, alike);
  head += alike;
  pending -= alike;
}

void main() {
  thread = gl_LocalInvocationIndex;
  uint number = flatGroup();
  if (number >= (kSecondClass ? classes.middling.count : classes.shallow.count)) return;
  uint tile = tileList[kSecondClass ? tiles.tilesX * tiles.tilesY - 1u - number : number];
  uint count = tileRecords[tile].x;
  ivec2 inTile = ivec2(thread & 7u, thread >> 3);
  ivec2 pixel = firstPixel(tile) + inTile;
  bool inside = isInside(pixel);
  if (thread == 0u) sharedTooShort = 0u;
  sortRecords(count, tileRecords[tile].y);
  float farthest = inside ? farthestDepth(pixel) : 2.0;
  PixelLight light = lightBehind(inside ? pixel : ivec2(0));
  bool isEmpty = true;
  bool ended = !inside;
  bool tooShort = false;
  uint batches = (count + TILES_PIXELS - 1u) / TILES_PIXELS;
  for (uint batch = 0u; batch < batches; ++batch) {
    if (thread == 0u) sharedGoesOn[batch & 1u] = 0u;
    uint number_ = batch * TILES_PIXELS + thread;
    loadBatch(number_ < count, number_ < count ? sharedRecords[number_] : 0u);
    barrier();
    if (!ended) sharedGoesOn[batch & 1u] = 1u;
    uvec2 bits = covering();
    if (ended) bits = uvec2(0u);
    uint next = batch + 1u < batches ? sharedKeys[(batch + 1u) * TILES_PIXELS] : 0xffffffffu;
    while (!ended) {
      while ((bits.x | bits.y) != 0u && pending < kPending) {
        uint i = takeBit(bits);
        vec4 plane = sharedPlanes[i];
        float depth = depthOn(plane, inTile);
        if (isHidden(plane, depth, pixel, farthest)) continue;
        insert(keyOf(depth), sharedRecords[batch * TILES_PIXELS + i]);
      }
      bool more = (bits.x | bits.y) != 0u;
      uint i = more ? firstBit(bits) : 0u;
      uint horizon = more ? sharedKeys[batch * TILES_PIXELS + i] : next;
      bool blended = false;
      while (pending > 0u && pendingKeys[ringAt(0u)] < horizon) {
        blendNearest(light, pixel);
        blended = true;
        isEmpty = false;
        if (hasEnough(light)) {
          ended = true;
          break;
        }
      }
      if (!more) break;
      if (!blended && pending == kPending) tooShort = ended = true;
    }
    barrier();
    if (sharedGoesOn[batch & 1u] == 0u) break;
  }
  // Also where a driver has ended a loop that it took for endless.
  if (!ended && pending > 0u) tooShort = true;
  if (tooShort) sharedTooShort = 1u;
  barrier();
  if (sharedTooShort != 0u) {
    if (thread == 0u) addDeep(tile, count);
    return;
  }
  if (inside && !isEmpty) blendOver(pixel, light);
}
