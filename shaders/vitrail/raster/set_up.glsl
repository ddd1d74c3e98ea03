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

// The four tiles in which 8 x 8 pixels may lie: the one that holds the first pixel, the one to the right (bit 0 of a
// part's number), below (bit 1) and both.
struct VitrailParts {
  ivec2 first;  // pixel, in its tile
  uint columns; // of a tile's pixels those in the left tiles, in four rows
  uvec2 rows;   // those in the lower tiles
};

VitrailParts vitrailPartsAt(ivec2 first) {
  VitrailParts parts;
  parts.first = first & (VITRAIL_TILE_SIDE - 1);
  parts.columns = (0xffu << parts.first.x & 0xffu) * 0x01010101u;
  uint bits = 8u * uint(parts.first.y);
  parts.rows = uvec2(bits >= 32u ? 0xffffffffu : (1u << bits) - 1u, bits > 32u ? (1u << (bits - 32u)) - 1u : 0u);
  return parts;
}

// Which pixels of tiles are covered of 8 x 8, of all four tiles together. No two have one place in their tiles, which
// are reached by going round in rows and columns.
uvec2 vitrailInTiles(VitrailParts parts, uvec2 mask) {
  if (parts.first.y >= 4) mask = mask.yx;
  uint bits = 8u * (uint(parts.first.y) & 3u);
  mask = mask << bits | mask.yx >> 1 >> (31u - bits);
  uint columns = uint(parts.first.x);
  return (mask << columns & parts.columns) | (mask >> (8u - columns) & ~parts.columns);
}

uvec2 vitrailOfPart(VitrailParts parts, uvec2 inTiles, uint part) {
  uvec2 rows = (part & 2u) != 0u ? parts.rows : ~parts.rows;
  return inTiles & rows & ((part & 1u) != 0u ? ~parts.columns : parts.columns);
}

// In which of the four something is covered, a bit for each.
uint vitrailPartsWith(VitrailParts parts, uvec2 inTiles) {
  uvec2 left = inTiles & parts.columns;
  uvec2 right = inTiles & ~parts.columns;
  uvec4 any_ = uvec4((left.x & ~parts.rows.x) | (left.y & ~parts.rows.y),
                     (right.x & ~parts.rows.x) | (right.y & ~parts.rows.y),
                     (left.x & parts.rows.x) | (left.y & parts.rows.y),
                     (right.x & parts.rows.x) | (right.y & parts.rows.y));
  return (any_.x != 0u ? 1u : 0u) | (any_.y != 0u ? 2u : 0u) | (any_.z != 0u ? 4u : 0u) | (any_.w != 0u ? 8u : 0u);
}

// Makes the records of a small triangle.
void vitrailSetUpSmall(VitrailTriangle t, uint draw, ivec2 first, ivec2 last) {
  float area = vitrailSmallArea(t.p0, t.p1, t.p2);
  bool front;
  if (area == 0.0 || !vitrailSideOf(draw, area > 0.0, front)) return;
  vec2 p0 = t.p0;
  vec2 p1 = area > 0.0 ? t.p1 : t.p2;
  vec2 p2 = area > 0.0 ? t.p2 : t.p1;
  vitrailTurnCorners(p0, p1, p2);
  VitrailRows rows = vitrailSmallRows(p0, p1, p2, vec2(first) * float(VITRAIL_SUBPIXELS));
  int count = last.y - first.y + 1;
  uvec2 window = uvec2(0xffffffffu);
  if (any(greaterThan(first + VITRAIL_TILE_SIDE, ivec2(vitrailRaster.width, vitrailRaster.bottom)))) {
    window = vitrailTileWindow(ivec2(0), last - first + 1);
  }
  VitrailParts parts = vitrailPartsAt(first);
  uvec2 samples[VITRAIL_RASTER_SAMPLES_KEPT];
  uvec2 covered = uvec2(0u);
#define VITRAIL_COVER_SAMPLE(i) \
  samples[i] = uvec2(0u); \
  if (i < VITRAIL_RASTER_SAMPLES) { \
    samples[i] = window & (VITRAIL_RASTER_SAMPLES == 1u ? vitrailFewRowCoverage(rows, count) \
                                                        : vitrailRowCoverage(rows, vitrailSamplePlace(i), count)); \
    samples[i] = vitrailInTiles(parts, samples[i]); \
    covered |= samples[i]; \
  }
  VITRAIL_EACH_SAMPLE(VITRAIL_COVER_SAMPLE)
  if ((covered.x | covered.y) == 0u) return;
  VitrailSource source = vitrailSourceOf(t, front, area);
  uint left = vitrailPartsWith(parts, covered);
  while (left != 0u) {
    uint part = uint(findLSB(left));
    left &= left - 1u;
    ivec2 tile = (first >> 3) + ivec2(part & 1u, part >> 1);
    uint place = vitrailMakeRecord(tile, vitrailOfPart(parts, covered, part), source);
#ifdef VITRAIL_MULTISAMPLED
    if (place >= vitrailRaster.recordCapacity) continue; // the frame is drawn again
    uvec2 inTile[VITRAIL_RASTER_SAMPLES_KEPT];
#define VITRAIL_CUT_SAMPLE(i) inTile[i] = vitrailOfPart(parts, samples[i], part);
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
  if (any(greaterThan(first, last))) return false;
  vec2 extent = max(t.p0, max(t.p1, t.p2)) - min(t.p0, min(t.p1, t.p2));
  if (all(lessThan(last - first, ivec2(VITRAIL_TILE_SIDE))) && max(extent.x, extent.y) < VITRAIL_MOST_SMALL) {
    vitrailSetUpSmall(t, draw, first, last);
    return false;
  }
  uint count = vitrailCandidates(first, last, ivec2(0), ivec2(0x7fffffff), low, high);
  if (count > VITRAIL_RASTER_LARGE) {
    vitrailPutAsideLarge(source);
    return false;
  }
  return count > 0u;
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
  // One division for all turns: whole numbers are divided in many steps.
  uint firstInstance = first < size.x ? 0u : first / size.x;
  uint firstInInstance = first - firstInstance * size.x;
  uvec2 nextSource = uvec2(0u);
  uvec3 nextIndices = uvec3(0u);
#define VITRAIL_LOAD_NEXT(offset_) \
  if (first + (offset_) < count) { \
    uint number = firstInInstance + (offset_); \
    uint instance = firstInstance; \
    if (number >= size.x) { /* of large meshes in few groups */ \
      uint more = number / size.x; \
      instance += more; \
      number -= more * size.x; \
    } \
    nextSource = uvec2(vitrailNameOf(firstOfDraw, number), size.w + instance); \
    nextIndices = vitrailIndicesAt(draw, corners, nextSource.x); \
  }
  VITRAIL_LOAD_NEXT(thread)
  for (uint i = 0u; i < VITRAIL_RASTER_TURNS && first + i * VITRAIL_RASTER_SET_UP < count; ++i) {
    uvec2 source = nextSource;
    uvec3 indices = nextIndices;
    uint offset = i * VITRAIL_RASTER_SET_UP + thread;
    bool isThere = first + offset < count;
    if (i + 1u < VITRAIL_RASTER_TURNS) { // they are there when this turn ends
      VITRAIL_LOAD_NEXT(offset + VITRAIL_RASTER_SET_UP)
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
