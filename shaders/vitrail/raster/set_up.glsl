// Sets up triangles, a thread each, and makes the records of small ones, for each tile in which one covers a pixel. A
// small one lies within 8 x 8 pixels: it gets a mask of each sample, which may be cut by the borders of tiles. Others
// are put aside: medium ones, which may touch some tiles, and large ones, which may touch very many or need clipping.
//
// How many work groups run at a time is what hides waiting, so this has little shared memory, no thread waits for
// another before the end, and the indices of the next turn's triangles are asked for before this one's are set up.
#ifndef VITRAIL_RASTER_SET_UP_GLSL
#define VITRAIL_RASTER_SET_UP_GLSL

#include "triangles.glsl"

layout(local_size_x = VITRAIL_RASTER_SET_UP) in;

layout(VITRAIL_RASTER_BOUND(17), std430) buffer VitrailTileClassBlock { VitrailRasterTileClasses vitrailTileClasses; };

// The medium triangles of the work group: name and item.
shared uvec2 vitrailGroupMedium[VITRAIL_RASTER_SET_UP * VITRAIL_RASTER_TURNS];
shared uint vitrailGroupMediums;
shared uint vitrailGroupFirstMedium;

// To higher bits, or lower ones where `bits` is negative.
uvec2 vitrailShifted(uvec2 mask, int bits) {
  if (bits >= 32) return uvec2(0u, mask.x << (bits - 32));
  if (bits >= 0) return uvec2(mask.x << bits, mask.y << bits | mask.x >> 1 >> (31 - bits));
  if (bits > -32) return uvec2(mask.x >> -bits | mask.y << 1 << (31 + bits), mask.y >> -bits);
  return uvec2(bits > -64 ? mask.y >> (-bits - 32) : 0u, 0u);
}

// Which pixels of a tile are covered of 8 x 8, of which `first` is the first: of the tile that holds this one, the one
// to the right (bit 0 of `part`), below (bit 1) or both.
uvec2 vitrailCutAtTiles(uvec2 mask, ivec2 first, uint part) {
  ivec2 in_ = first & (VITRAIL_TILE_SIDE - 1);
  uint columns = (0xffu >> in_.x) * 0x01010101u; // that are in the left tile
  mask &= (part & 1u) != 0u ? ~columns : columns;
  ivec2 tile = ivec2(part & 1u, part >> 1) * VITRAIL_TILE_SIDE;
  return vitrailShifted(mask, 8 * (in_.y - tile.y) + in_.x - tile.x); // what is in other rows falls off at either end
}

// In which of the four tiles it covers something, a bit for each part.
uint vitrailPartsOf(uvec2 mask, ivec2 first) {
  ivec2 in_ = first & (VITRAIL_TILE_SIDE - 1);
  uint left = (0xffu >> in_.x) * 0x01010101u;
  int rows = VITRAIL_TILE_SIDE - in_.y; // in the upper tile
  uvec2 upper = uvec2(rows >= 4 ? 0xffffffffu : (1u << (8 * rows)) - 1u,
                      rows >= 8 ? 0xffffffffu : (1u << (8 * max(rows - 4, 0))) - 1u);
  uvec2 above = mask & upper;
  uvec2 below = mask & ~upper;
  uint a = above.x | above.y;
  uint b = below.x | below.y;
  return ((a & left) != 0u ? 1u : 0u) | ((a & ~left) != 0u ? 2u : 0u) | ((b & left) != 0u ? 4u : 0u) |
         ((b & ~left) != 0u ? 8u : 0u);
}

// Makes the records of a small triangle.
void vitrailSetUpSmall(VitrailTriangle t, uint draw, ivec2 first, ivec2 last) {
  int area = vitrailLittleArea(t.p0, t.p1, t.p2);
  bool front;
  if (area == 0 || !vitrailSideOf(draw, area > 0, front)) return;
  ivec2 p0 = t.p0;
  ivec2 p1 = area > 0 ? t.p1 : t.p2;
  ivec2 p2 = area > 0 ? t.p2 : t.p1;
  vitrailTurnCorners(p0, p1, p2);
  VitrailRows rows = vitrailRows(p0, p1, p2, first);
  int count = last.y - first.y + 1;
  uvec2 window = uvec2(0xffffffffu);
  if (any(greaterThan(first + VITRAIL_TILE_SIDE, ivec2(vitrailRaster.width, vitrailRaster.bottom)))) {
    window = vitrailTileWindow(ivec2(0), last - first + 1);
  }
  uvec2 samples[VITRAIL_RASTER_SAMPLES_KEPT];
  uvec2 covered = uvec2(0u);
#define VITRAIL_COVER_SAMPLE(i) \
  samples[i] = uvec2(0u); \
  if (i < VITRAIL_RASTER_SAMPLES) { \
    samples[i] = window & (VITRAIL_RASTER_SAMPLES == 1u ? vitrailFewRowCoverage(rows, count) \
                                                        : vitrailRowCoverage(rows, vitrailSamplePlace(i), count)); \
    covered |= samples[i]; \
  }
  VITRAIL_EACH_SAMPLE(VITRAIL_COVER_SAMPLE)
  if ((covered.x | covered.y) == 0u) return;
  VitrailSource source = vitrailSourceOf(t, front, float(area));
  uint parts = vitrailPartsOf(covered, first);
  while (parts != 0u) {
    uint part = uint(findLSB(parts));
    parts &= parts - 1u;
    ivec2 tile = (first >> 3) + ivec2(part & 1u, part >> 1);
    uint place = vitrailMakeRecord(tile, vitrailCutAtTiles(covered, first, part), source);
#ifdef VITRAIL_MULTISAMPLED
    if (place >= vitrailRaster.recordCapacity) continue; // the frame is drawn again
    uvec2 inTile[VITRAIL_RASTER_SAMPLES_KEPT];
#define VITRAIL_CUT_SAMPLE(i) inTile[i] = vitrailCutAtTiles(samples[i], first, part);
    VITRAIL_EACH_SAMPLE(VITRAIL_CUT_SAMPLE)
    vitrailKeepSamples(place, inTile);
#endif
  }
}

void vitrailPutAsideLarge(uvec2 source) {
  uint place = atomicAdd(vitrailRasterControl.large, 1u);
  if (place == 0u) {
    vitrailTileClasses.large = VitrailRasterDispatch(vitrailRaster.largeGroups, vitrailRaster.tilesY, 1u, 0u);
  }
  if (place < vitrailRaster.largeCapacity) vitrailLarge[place] = source;
}

// Whether the triangle of the thread is a medium one.
bool vitrailSetUp(uint draw, uint corners, uvec2 source, uvec3 indices) {
  VitrailTriangle t;
  bool isWhole;
  if (!vitrailTriangleAt(draw, corners, source, indices, t, isWhole)) return false;
  if (!isWhole) {
    vitrailPutAsideLarge(source);
    return false;
  }
  ivec2 first, last, low, high;
  vitrailBoundsOf(t, first, last);
  uint count = vitrailCandidates(first, last, ivec2(0), ivec2(0x7fffffff), low, high);
  if (count > VITRAIL_RASTER_LARGE) {
    vitrailPutAsideLarge(source);
    return false;
  }
  if (count == 0u) return false;
  if (all(lessThan(last - first, ivec2(VITRAIL_TILE_SIDE))) && vitrailIsLittle(t.p0, t.p1, t.p2)) {
    vitrailSetUpSmall(t, draw, first, last);
    return false;
  }
  return true;
}

// Room in the list of all groups' medium triangles, for those of this one.
void vitrailTakeMediums(uint mediums) {
  uint first = atomicAdd(vitrailRasterControl.medium, mediums);
  atomicMax(vitrailTileClasses.medium.x, min(vitrailMediumGroups(first + mediums), VITRAIL_RASTER_ROW)); // which go on
  vitrailGroupFirstMedium = first;
}

void main() {
  uint group = vitrailFlatGroup();
  if (group >= vitrailRasterStart.groups.count) return; // the last row is longer
  uint thread = gl_LocalInvocationIndex;
  if (thread == 0u) vitrailGroupMediums = 0u;
  barrier();
  uint draw = vitrailDrawOfGroup[group];
  uint corners = vitrailCornersOf(vitrailFlagsOf(draw));
  uvec4 size = vitrailDrawPlaces[draw].size;
  uint firstOfDraw = vitrailDrawPlaces[draw].lookup.x;
  uint count = size.x * size.y;
  uint first = (group - size.z) * (VITRAIL_RASTER_SET_UP * VITRAIL_RASTER_TURNS);
  uvec2 nextSource = uvec2(0u);
  uvec3 nextIndices = uvec3(0u);
#define VITRAIL_LOAD_NEXT(number_) \
  if ((number_) < count) { \
    uint number = number_; \
    uint instance = number < size.x ? 0u : number / size.x; \
    nextSource = uvec2(vitrailNameOf(firstOfDraw, number - instance * size.x), size.w + instance); \
    nextIndices = vitrailIndicesAt(draw, corners, nextSource.x); \
  }
  VITRAIL_LOAD_NEXT(first + thread)
  for (uint i = 0u; i < VITRAIL_RASTER_TURNS && first < count; ++i) {
    uvec2 source = nextSource;
    uvec3 indices = nextIndices;
    bool isThere = first + thread < count;
    first += VITRAIL_RASTER_SET_UP;
    if (i + 1u < VITRAIL_RASTER_TURNS) { // they are there when this turn ends
      VITRAIL_LOAD_NEXT(first + thread)
    }
    if (isThere && vitrailSetUp(draw, corners, source, indices)) {
      vitrailGroupMedium[atomicAdd(vitrailGroupMediums, 1u)] = source;
    }
  }
  barrier();
  uint mediums = vitrailGroupMediums;
  if (mediums == 0u) return;
  if (thread == 0u) vitrailTakeMediums(mediums);
  barrier();
  for (uint i = thread; i < mediums; i += VITRAIL_RASTER_SET_UP) {
    uint place = vitrailGroupFirstMedium + i;
    if (place < vitrailMediumCapacity()) vitrailMedium[place] = vitrailGroupMedium[i]; // else drawn again
  }
}

#endif
