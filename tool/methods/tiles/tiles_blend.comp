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
shared uint sharedNearest; // of the records that are sorted
shared uint sharedFarthest;
shared uint sharedCrowded; // whether some bucket holds many

const int BUCKET_BITS = 8;
const uint BUCKETS_OF_THREAD = (1u << BUCKET_BITS) / TILES_PIXELS;
const uint MANY_IN_BUCKET = 24u;

uint head = 0u;    // where in the ring the nearest fragment is
uint pending = 0u; // fragments in it

uint ringAt(uint i) { return ((head + i) & (kPending - 1u)) * TILES_PIXELS + thread; }

// Few records are sorted by counting for each how many are nearer, which needs no steps.
void sortFew(uint count, uint first) {
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
}

void exchange(uint low, uint high) {
  uint key = sharedKeys[low];
  uint record = sharedRecords[low];
  sharedKeys[low] = sharedKeys[high];
  sharedRecords[low] = sharedRecords[high];
  sharedKeys[high] = key;
  sharedRecords[high] = record;
}

// Any records that are in shared memory, by a network (Batcher, "Sorting networks and their applications", 1968).
void sortByNetwork(uint count) {
  uint size = 2u * TILES_PIXELS;
  while (size < count) size *= 2u;
  for (uint i = count + thread; i < size; i += TILES_PIXELS) sharedKeys[i] = 0xffffffffu;
  barrier();
  for (uint run = 2u; run <= size; run *= 2u) {
    for (uint step = run / 2u; step > 0u; step /= 2u) {
      for (uint i = thread; i < size / 2u; i += TILES_PIXELS) {
        uint low = 2u * i - (i & (step - 1u));
        uint a = sharedKeys[low];
        uint b = sharedKeys[low + step];
        if ((a > b) == ((low & run) == 0u) && a != b) exchange(low, low + step);
      }
      barrier();
    }
  }
}

// Sorts a bucket, if it holds only a few. False: it holds many.
bool sortBucket(uint begin, uint end) {
  if (end - begin > MANY_IN_BUCKET) return false;
  for (uint i = begin + 1u; i < end; ++i) {
    for (uint k = i; k > begin && sharedKeys[k - 1u] > sharedKeys[k]; --k) exchange(k - 1u, k);
  }
  return true;
}

// Sorts the tile's records: by their depths into buckets, most of which then hold one or two; where one holds many, all
// by a network. Where the buckets are counted, nothing is pending yet.
void sortRecords(uint count, uint first) {
  if (count <= TILES_PIXELS) {
    sortFew(count, first);
    return;
  }
  if (thread == 0u) {
    sharedNearest = 0xffffffffu;
    sharedFarthest = sharedCrowded = 0u;
  }
  for (uint i = 0u; i < BUCKETS_OF_THREAD; ++i) pendingKeys[BUCKETS_OF_THREAD * thread + i] = 0u;
  barrier();
  uint nearest = 0xffffffffu;
  uint farthest = 0u;
  for (uint i = thread; i < count; i += TILES_PIXELS) {
    uint key = pairs[first + i].x;
    nearest = min(nearest, key);
    farthest = max(farthest, key);
  }
  atomicMin(sharedNearest, nearest);
  atomicMax(sharedFarthest, farthest);
  barrier();
  nearest = sharedNearest;
  int digits = findMSB(sharedFarthest - nearest) + 1;
  int shift = max(digits - BUCKET_BITS, 0);
  for (uint i = thread; i < count; i += TILES_PIXELS) {
    atomicAdd(pendingKeys[(pairs[first + i].x - nearest) >> shift], 1u);
  }
  barrier();
  uint sum = 0u;
  for (uint i = 0u; i < BUCKETS_OF_THREAD; ++i) sum += pendingKeys[BUCKETS_OF_THREAD * thread + i];
  pendingRecords[thread] = sum;
  barrier();
  uint begin = 0u;
  for (uint i = 0u; i < thread; ++i) begin += pendingRecords[i];
  for (uint i = 0u; i < BUCKETS_OF_THREAD; ++i) {
    uint inBucket = pendingKeys[BUCKETS_OF_THREAD * thread + i];
    pendingKeys[BUCKETS_OF_THREAD * thread + i] = begin;
    begin += inBucket;
  }
  barrier();
  for (uint i = thread; i < count; i += TILES_PIXELS) {
    uvec2 pair = pairs[first + i];
    uint place = atomicAdd(pendingKeys[(pair.x - nearest) >> shift], 1u);
    sharedKeys[place] = pair.x;
    sharedRecords[place] = pair.y;
  }
  barrier();
  for (uint i = 0u; i < BUCKETS_OF_THREAD; ++i) { // each now ends where the next began
    uint bucket = i * TILES_PIXELS + thread;
    if (!sortBucket(bucket > 0u ? pendingKeys[bucket - 1u] : 0u, pendingKeys[bucket])) sharedCrowded = 1u;
  }
  barrier();
  if (sharedCrowded != 0u) sortByNetwork(count);
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
