// Sorts and blends the fragments of a tile, a work group a tile and a thread a pixel. The tile's records are sorted by
// their nearest depths and then walked: a thread keeps the fragments that it has met in a short list, in order, and
// shades the nearest once no record that is still to come can be before it. So a pixel ends where enough is hidden, and
// of records that do not cross each other the list holds only a few. Where it is too short, the tile is left to
// tiles_deep_*.comp. More records than there is room for are taken in slabs, from the front: those behind where all
// pixels end are counted, but never sorted.
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
const int BUCKET_BITS = 8;
const uint BUCKETS = 1u << BUCKET_BITS;
const uint BUCKETS_OF_THREAD = BUCKETS / TILES_PIXELS;
const uint MANY_IN_BUCKET = 24u;

shared uint sharedBuckets[BUCKETS]; // of depths: how many records, or where they begin or end
shared uint sharedSums[TILES_PIXELS];
shared uint sharedNearest; // of the records that are left
shared uint sharedFarthest;
shared uint sharedTaken;   // buckets of a slab
shared uint sharedCrowded; // whether some bucket holds many

uint head = 0u;    // where in the ring the nearest fragment is
uint pending = 0u; // fragments in it

uint ringAt(uint i) { return ((head + i) & (kPending - 1u)) * TILES_PIXELS + thread; }

// Few records are sorted by counting for each how many are nearer, which needs no steps.
void sortFew(uint count, uint first) {
  uvec2 mine = thread < count ? pairs[first + thread] : uvec2(0xffffffffu);
  sharedSums[thread] = mine.x;
  barrier();
  uint place = 0u;
  for (uint i = 0u; i < count; ++i) {
    uint other = sharedSums[i];
    place += other < mine.x || (other == mine.x && i < thread) ? 1u : 0u;
  }
  if (thread < count) {
    sharedKeys[place] = mine.x;
    sharedRecords[place] = mine.y;
  }
  barrier();
}

// The same of two records a thread.
void sortSome(uint count, uint first) {
  uint second = thread + TILES_PIXELS;
  uvec2 a = pairs[first + thread];
  uvec2 b = second < count ? pairs[first + second] : uvec2(0xffffffffu);
  sharedBuckets[thread] = a.x;
  sharedBuckets[second] = b.x;
  barrier();
  uvec2 places = uvec2(0u);
  for (uint i = 0u; i < count; ++i) {
    uint other = sharedBuckets[i];
    places.x += other < a.x || (other == a.x && i < thread) ? 1u : 0u;
    places.y += other < b.x || (other == b.x && i < second) ? 1u : 0u;
  }
  sharedKeys[places.x] = a.x;
  sharedRecords[places.x] = a.y;
  if (second < count) {
    sharedKeys[places.y] = b.x;
    sharedRecords[places.y] = b.y;
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

// The sum of the numbers of the threads before this one (Hillis and Steele, "Data parallel algorithms", 1986).
uint sumBefore(uint mine) {
  uint sum = mine;
  for (uint step = 1u; step < TILES_PIXELS; step *= 2u) {
    sharedSums[thread] = sum;
    barrier();
    if (thread >= step) sum += sharedSums[thread - step];
    barrier();
  }
  return sum - mine;
}

// Finds the nearest and the farthest of the records whose keys are not below `from`.
void findRange(uint count, uint first, uint from) {
  if (thread == 0u) {
    sharedNearest = 0xffffffffu;
    sharedFarthest = 0u;
  }
  barrier();
  uint nearest = 0xffffffffu;
  uint farthest = 0u;
  for (uint i = thread; i < count; i += TILES_PIXELS) {
    uint key = pairs[first + i].x;
    if (key < from) continue;
    nearest = min(nearest, key);
    farthest = max(farthest, key);
  }
  // One atomic for all that know of each other.
  if (kShuffles) {
    for (uint step = 1u; step < 32u; step *= 2u) {
      nearest = min(nearest, subgroupShuffleXor(nearest, step));
      farthest = max(farthest, subgroupShuffleXor(farthest, step));
    }
  }
  if (!kShuffles || (thread & 31u) == 0u) {
    atomicMin(sharedNearest, nearest);
    atomicMax(sharedFarthest, farthest);
  }
  barrier();
}

// Counts the records of a range of keys in buckets of 2^shift, and says how many of these, from the front, are no more
// than there is room for. Each then begins where its number says.
uint countBuckets(uint count, uint first, uvec2 range, int shift) {
  for (uint i = 0u; i < BUCKETS_OF_THREAD; ++i) sharedBuckets[BUCKETS_OF_THREAD * thread + i] = 0u;
  if (thread == 0u) sharedTaken = sharedCrowded = 0u;
  barrier();
  for (uint i = thread; i < count; i += TILES_PIXELS) {
    uint key = pairs[first + i].x;
    if (key >= range.x && key <= range.y) atomicAdd(sharedBuckets[(key - range.x) >> shift], 1u);
  }
  barrier();
  uint sum = 0u;
  for (uint i = 0u; i < BUCKETS_OF_THREAD; ++i) sum += sharedBuckets[BUCKETS_OF_THREAD * thread + i];
  uint begin = sumBefore(sum);
  uint taken = 0u;
  for (uint i = 0u; i < BUCKETS_OF_THREAD; ++i) {
    uint bucket = BUCKETS_OF_THREAD * thread + i;
    uint inBucket = sharedBuckets[bucket];
    sharedBuckets[bucket] = begin;
    begin += inBucket;
    if (begin <= kRecords) taken = bucket + 1u;
  }
  atomicMax(sharedTaken, taken);
  barrier();
  return sharedTaken;
}

// The nearest records of those that are left, sorted: by their depths into buckets, most of which then hold one or two;
// where one holds many, all by a network.
struct Slab {
  uint count; // of its records; 0: too many have one depth
  uint end;   // the key behind it, from which the others are
};

Slab sortSlab(uint count, uint first, uint from) {
  if (count <= TILES_PIXELS) {
    sortFew(count, first);
    return Slab(count, 0xffffffffu);
  }
  if (count <= 2u * TILES_PIXELS) {
    sortSome(count, first);
    return Slab(count, 0xffffffffu);
  }
  findRange(count, first, from);
  uvec2 range = uvec2(sharedNearest, sharedFarthest);
  int shift = max(findMSB(range.y - range.x) + 1 - BUCKET_BITS, 0);
  uint taken = countBuckets(count, first, range, shift);
  while (taken == 0u && shift > 0) { // the first alone is too much
    range.y = min(range.y, range.x + (1u << shift) - 1u);
    shift = max(shift - BUCKET_BITS, 0);
    taken = countBuckets(count, first, range, shift);
  }
  if (taken == 0u) return Slab(0u, from);
  uint end = min(range.x + (taken << shift), range.y + 1u);
  for (uint i = thread; i < count; i += TILES_PIXELS) {
    uvec2 pair = pairs[first + i];
    if (pair.x < range.x || pair.x >= end) continue;
    uint place = atomicAdd(sharedBuckets[(pair.x - range.x) >> shift], 1u);
    sharedKeys[place] = pair.x;
    sharedRecords[place] = pair.y;
  }
  barrier();
  for (uint i = 0u; i < BUCKETS_OF_THREAD; ++i) { // each now ends where the next began
    uint bucket = i * TILES_PIXELS + thread;
    if (bucket >= taken) continue;
    if (!sortBucket(bucket > 0u ? sharedBuckets[bucket - 1u] : 0u, sharedBuckets[bucket])) sharedCrowded = 1u;
  }
  uint inSlab = sharedBuckets[taken - 1u];
  barrier();
  if (sharedCrowded != 0u) sortByNetwork(inSlab);
  return Slab(inSlab, end > sharedFarthest ? 0xffffffffu : end);
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

// What a thread knows of its pixel.
struct Walk {
  PixelLight light;
  ivec2 inTile;
  ivec2 pixel;
  float farthest; // opaque depth
  bool isEmpty;   // nothing has been blended
  bool ended;     // nothing farther away is needed
  bool tooShort;  // the list was
};

// Goes through a batch of sorted records, of which `bits` cover the pixel. No record behind has a key below `next`.
void walkBatch(inout Walk walk, uvec2 bits, uint batch, uint next) {
  while (!walk.ended) {
    while ((bits.x | bits.y) != 0u && pending < kPending) {
      uint i = takeBit(bits);
      vec4 plane = sharedPlanes[i];
      float depth = depthOn(plane, walk.inTile);
      if (isHidden(plane, depth, walk.pixel, walk.farthest)) continue;
      insert(keyOf(depth), sharedRecords[batch * TILES_PIXELS + i]);
    }
    bool more = (bits.x | bits.y) != 0u;
    uint horizon = more ? sharedKeys[batch * TILES_PIXELS + firstBit(bits)] : next;
    bool blended = false;
    while (pending > 0u && pendingKeys[ringAt(0u)] < horizon) {
      blendNearest(walk.light, walk.pixel);
      blended = true;
      walk.isEmpty = false;
      if (hasEnough(walk.light)) {
        walk.ended = true;
        break;
      }
    }
    if (!more) return;
    if (!blended && pending == kPending) walk.tooShort = walk.ended = true;
  }
  if (walk.ended) return;
  walk.tooShort = walk.ended = true; // the driver has ended the loop
}

// Goes through a slab. Whether some pixel has not ended.
bool walkSlab(inout Walk walk, Slab slab) {
  uint batches = (slab.count + TILES_PIXELS - 1u) / TILES_PIXELS;
  uint batch = 0u;
  bool goesOn = true;
  for (; batch < batches && goesOn; ++batch) {
    if (thread == 0u) sharedGoesOn[batch & 1u] = 0u;
    uint number = batch * TILES_PIXELS + thread;
    loadBatch(number < slab.count, number < slab.count ? sharedRecords[number] : 0u);
    barrier();
    if (!walk.ended) sharedGoesOn[batch & 1u] = 1u;
    uvec2 bits = covering();
    uint next = batch + 1u < batches ? sharedKeys[(batch + 1u) * TILES_PIXELS] : slab.end;
    walkBatch(walk, bits, batch, next);
    barrier();
    goesOn = sharedGoesOn[batch & 1u] != 0u;
  }
  if (goesOn && batch < batches) walk.tooShort = walk.ended = true; // as above
  return goesOn;
}

void main() {
  thread = gl_LocalInvocationIndex;
  uint number = flatGroup();
  if (number >= (kSecondClass ? classes.middling.count : classes.shallow.count)) return;
  uint tile = tileList[kSecondClass ? tiles.tilesX * tiles.tilesY - 1u - number : number];
  uint count = tileRecords[tile].x;
  Walk walk;
  walk.inTile = ivec2(thread & 7u, thread >> 3);
  walk.pixel = firstPixel(tile) + walk.inTile;
  bool inside = isInside(walk.pixel);
  if (!inside) walk.pixel = ivec2(0);
  walk.light = lightBehind(walk.pixel);
  walk.farthest = farthestDepth(walk.pixel);
  walk.isEmpty = true;
  walk.ended = !inside;
  walk.tooShort = false;
  if (thread == 0u) sharedTooShort = 0u;
  uint done = 0u;
  uint from = 0u;
  bool goesOn = true;
  while (goesOn && done < count) {
    Slab slab = sortSlab(count, tileRecords[tile].y, from);
    if (slab.count == 0u) {
      walk.tooShort = true;
      break;
    }
    goesOn = walkSlab(walk, slab);
    done += slab.count;
    from = slab.end;
    barrier(); // all have left the slab
  }
  if (!walk.ended && (pending > 0u || done < count)) walk.tooShort = true; // as above
  if (walk.tooShort) sharedTooShort = 1u;
  barrier();
  if (sharedTooShort != 0u) {
    if (thread == 0u) addDeep(tile, count);
    return;
  }
  if (inside && !walk.isEmpty) blendOver(walk.pixel, walk.light);
}
