// Makes the records of triangles that are not small. One thread takes a triangle; the tiles that the triangles of a
// work group may touch are then shared by all its threads, so that a few larger ones among many smaller ones keep
// nobody waiting. With VITRAIL_RASTER_CLASS 0 it takes the medium ones; with 1 those that may touch very many tiles
// and those that need clipping, for a part of a row of tiles.
#ifndef VITRAIL_RASTER_SET_UP_LARGE_GLSL
#define VITRAIL_RASTER_SET_UP_LARGE_GLSL

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#include "triangles.glsl"

layout(local_size_x = VITRAIL_RASTER_GROUP) in;

// The triangles of the work group, in as little memory as they need: how many groups run at a time hangs on it.
shared ivec4 vitrailGroupCorners[VITRAIL_RASTER_GROUP]; // the first two
shared ivec4 vitrailGroupTiles[VITRAIL_RASTER_GROUP];   // the third; the first tile, 16 bits each; tiles in a row
shared vec4 vitrailGroupPlanes[VITRAIL_RASTER_GROUP];   // the depths at the first corner; the nearest of the corners'
shared uvec2 vitrailGroupSources[VITRAIL_RASTER_GROUP]; // name, item
shared uint vitrailGroupEnds[VITRAIL_RASTER_GROUP];     // of the candidates of each, among those of all
shared uint vitrailGroupSums[VITRAIL_RASTER_SHUFFLES ? VITRAIL_RASTER_GROUP / 32u : VITRAIL_RASTER_GROUP];
shared uint vitrailGroupPieces;

// Puts a triangle where all threads find it.
void vitrailShareTriangle(uint i, VitrailTriangle t, VitrailSource source, ivec2 low, ivec2 high) {
  vitrailGroupCorners[i] = ivec4(t.p0, t.p1);
  vitrailGroupTiles[i] = ivec4(ivec2(t.p2), low.x | low.y << 16, high.x - low.x);
  vitrailGroupPlanes[i] = vec4(source.plane.depth, source.nearest);
  vitrailGroupSources[i] = uvec2(source.name, source.item);
}

// What records of the i-th have in common, which is shared; `corner` is its first.
VitrailSource vitrailSharedSource(uint i, ivec2 corner) {
  uvec2 source = vitrailGroupSources[i];
  vec4 plane = vitrailGroupPlanes[i];
  return VitrailSource(source.x, source.y, VitrailPlane(vec2(corner), plane.xyz), plane.w);
}

// A candidate: a tile that a shared triangle may touch. The i-th of the group.
void vitrailCoverCandidate(uint i) {
  uint owner = 0u; // the first whose end is beyond i
  for (uint step = VITRAIL_RASTER_GROUP / 2u; step > 0u; step /= 2u) {
    if (vitrailGroupEnds[owner + step - 1u] <= i) owner += step;
  }
  uint number = i - (owner > 0u ? vitrailGroupEnds[owner - 1u] : 0u);
  ivec4 corners = vitrailGroupCorners[owner];
  ivec4 rest = vitrailGroupTiles[owner];
  uint width = uint(rest.w);
  uint row = width > 1u ? number / width : number;
  ivec2 tile = ivec2(rest.z & 0xffff, rest.z >> 16) + ivec2(number - row * width, row);
  ivec2 pixel = tile * VITRAIL_TILE_SIDE;
  ivec2 p0 = corners.xy;
  ivec2 p1 = corners.zw;
  ivec2 p2 = rest.xy;
  ivec2 end = ivec2(vitrailRaster.width, vitrailRaster.bottom);
  bool isCut = any(greaterThan(pixel + VITRAIL_TILE_SIDE, end));
  uvec2 window = isCut ? vitrailTileWindow(ivec2(0), end - pixel) : uvec2(0xffffffffu);
  uvec2 covered = uvec2(0u);
#ifdef VITRAIL_MULTISAMPLED
  uvec4 upper = uvec4(0u); // of the last four samples
  uvec4 lower = uvec4(0u);
  uvec4 upperBefore = uvec4(0u); // of the first four of eight
  uvec4 lowerBefore = uvec4(0u);
#define VITRAIL_TAKE_COVERED(sample_, mask_) { \
  uvec2 mask = window & mask_; \
  covered |= mask; \
  upper = uvec4(upper.yzw, mask.x); \
  lower = uvec4(lower.yzw, mask.y); \
  if (sample_ == 3u) upperBefore = upper; \
  if (sample_ == 3u) lowerBefore = lower; \
}
#else
#define VITRAIL_TAKE_COVERED(sample_, mask_) covered = window & mask_;
#endif
  if (vitrailIsLittle(p0, p1, p2)) {
    vitrailTurnCorners(p0, p1, p2);
    VitrailRows rows = vitrailLittleRows(p0, p1, p2, pixel);
    for (uint k = 0u; k < VITRAIL_RASTER_SAMPLES; ++k) {
      VITRAIL_TAKE_COVERED(k, vitrailRowCoverage(rows, vitrailSamplePlace(k), VITRAIL_TILE_SIDE))
    }
  } else {
    VitrailEdges edges = vitrailEdges(p0, p1, p2);
    for (uint k = 0u; k < VITRAIL_RASTER_SAMPLES; ++k) {
      ivec2 middle = pixel * VITRAIL_SUBPIXELS + vitrailSamplePlace(k) * (VITRAIL_SUBPIXELS / 16);
      VITRAIL_TAKE_COVERED(k, vitrailTileCoverage(edges, vitrailEdgesAt(edges, p0, p1, p2, middle)))
    }
  }
  if ((covered.x | covered.y) == 0u) return;
  uint place = vitrailMakeRecord(tile, covered, vitrailSharedSource(owner, corners.xy));
#ifdef VITRAIL_MULTISAMPLED
  if (place < vitrailRaster.recordCapacity) vitrailKeepSamples(place, upperBefore, upper, lowerBefore, lower);
#endif
}

// All threads together: the sum of what the threads before this one have, and the sum of all.
uint vitrailSumBefore(uint mine, out uint all) {
  uint thread = gl_LocalInvocationIndex;
  uint before = 0u;
  all = mine;
  if (VITRAIL_RASTER_SHUFFLES) { // as batch.glsl
    for (uint step = 1u; step < 32u; step *= 2u) {
      uint other = subgroupShuffleXor(all, step);
      if ((thread & step) != 0u) before += other;
      all += other;
    }
    if ((thread & 31u) == 0u) vitrailGroupSums[thread >> 5] = all;
    barrier();
    all = 0u;
    for (uint i = 0u; i < VITRAIL_RASTER_GROUP / 32u; ++i) {
      uint sum = vitrailGroupSums[i];
      if (i < thread >> 5) before += sum;
      all += sum;
    }
    return before;
  }
  vitrailGroupSums[thread] = mine;
  barrier();
  for (uint step = 1u; step < VITRAIL_RASTER_GROUP; step *= 2u) { // Hillis and Steele, 1986
    uint other = thread >= step ? vitrailGroupSums[thread - step] : 0u;
    barrier();
    vitrailGroupSums[thread] += other;
    barrier();
  }
  all = vitrailGroupSums[VITRAIL_RASTER_GROUP - 1u];
  return vitrailGroupSums[thread] - mine;
}

// All threads together: how many candidates the shared triangles have, of which this thread's has `mine`.
uint vitrailCountCandidates(uint mine) {
  uint all;
  uint before = vitrailSumBefore(mine, all);
  vitrailGroupEnds[gl_LocalInvocationIndex] = before + mine;
  return all; // a barrier comes before they are looked at
}

// All threads together: makes the records of the shared triangles, of which this thread's has `mine` candidates.
void vitrailCoverAll(uint mine) {
  uint count = vitrailCountCandidates(mine);
  if (count == 0u) return;
  barrier();
  for (uint i = gl_LocalInvocationIndex; i < count; i += VITRAIL_RASTER_GROUP) vitrailCoverCandidate(i);
}

// There may be more work groups than there are shares, or fewer.
void vitrailSetUpMedium() {
  uint count = min(vitrailRasterControl.medium, vitrailMediumCapacity());
  uint groups = vitrailMediumGroups(count);
  uint share_ = groups > 0u ? (count + groups - 1u) / groups : 0u; // at most VITRAIL_RASTER_GROUP
  for (uint group = gl_WorkGroupID.x; group < groups; group += gl_NumWorkGroups.x) {
    uint end = min((group + 1u) * share_, count);
    uint i = group * share_ + gl_LocalInvocationIndex;
    uint candidates_ = 0u;
    if (i < end) {
      uvec2 source = vitrailMedium[i];
      uint draw = vitrailItems[source.y].z;
      uint corners = vitrailCornersOf(vitrailFlagsOf(draw));
      VitrailTriangle t;
      bool isWhole; // it is
      VitrailSource of_;
      if (vitrailTriangleAt(draw, corners, source, vitrailIndicesAt(draw, corners, source.x), t, isWhole)) {
        ivec2 low, high;
        vitrailBoundsOf(t, low, high);
        candidates_ = vitrailCandidates(low, high, ivec2(0), ivec2(0x7fffffff), low, high);
        if (!vitrailOrientTriangle(t, draw, of_)) candidates_ = 0u;
        if (candidates_ > 0u) vitrailShareTriangle(gl_LocalInvocationIndex, t, of_, low, high);
      }
    }
    vitrailCoverAll(candidates_);
    barrier(); // before the next ones take the place of these
  }
}

// In a row of tiles.
uint vitrailLargeBlocks() {
  return (vitrailRaster.tilesX + VITRAIL_RASTER_LARGE_BLOCK - 1u) / VITRAIL_RASTER_LARGE_BLOCK;
}

// The tiles of this work group in a row of the band.
void vitrailBlockOf(uint rowOfBand, out ivec2 low, out ivec2 high) {
  int first = int((gl_WorkGroupID.x % vitrailLargeBlocks()) * VITRAIL_RASTER_LARGE_BLOCK);
  int row = int(rowOfBand) + int(vitrailRaster.top) / VITRAIL_TILE_SIDE;
  low = ivec2(first, row);
  high = ivec2(min(first + int(VITRAIL_RASTER_LARGE_BLOCK), int(vitrailRaster.tilesX)), row + 1);
}

// What is left of a triangle or line; of a point all or nothing.
VitrailPolygon vitrailClippedOf(VitrailViewport viewport, uint draw, uint corners, uvec2 source) {
  VitrailPolygon whole = vitrailPolygonOf(draw, corners, source);
  if (!vitrailPolygonNeedsClipping(viewport, whole)) return whole;
  if (corners == 1u) {
    whole.count = 0;
    return whole;
  }
  VitrailPolygon left = vitrailClip(viewport, whole);
  if (corners == 3u || left.count < 2) return left;
  // The ends of what is left of a line, which may have been added twice.
  vec4 way = whole.corners[1] - whole.corners[0];
  VitrailPolygon ends = left;
  for (int i = 0; i < left.count; ++i) {
    vec4 p = left.corners[i];
    if (dot(p - ends.corners[0], way) < 0.0) ends.corners[0] = p;
    if (dot(p - ends.corners[1], way) > 0.0) ends.corners[1] = p;
  }
  ends.count = 2;
  return ends;
}

// A polygon is a fan of triangles, most often one.
void vitrailSetUpLarge(uint row) {
  uint thread = gl_LocalInvocationIndex;
  VitrailViewport viewport = vitrailViewportOf();
  ivec2 least, most;
  vitrailBlockOf(row, least, most);
  uint count = min(vitrailRasterControl.large, vitrailRaster.largeCapacity);
  uint shares = gl_NumWorkGroups.x / vitrailLargeBlocks(); // of them, each by a work group of a block
  uint share_ = gl_WorkGroupID.x / vitrailLargeBlocks();
  for (uint first = share_ * VITRAIL_RASTER_GROUP; first < count; first += shares * VITRAIL_RASTER_GROUP) {
    bool mine = first + thread < count;
    uvec2 source = mine ? vitrailLarge[first + thread] : uvec2(0u);
    VitrailPolygon polygon;
    polygon.count = 0;
    uint draw = mine ? vitrailItems[source.y].z : 0u;
    uint corners = vitrailCornersOf(vitrailFlagsOf(draw));
    if (mine) polygon = vitrailClippedOf(viewport, draw, corners, source);
    int fan = corners == 3u ? polygon.count - 2 : min(polygon.count, 1);
    barrier(); // all have left the last turn
    if (thread == 0u) vitrailGroupPieces = 0u;
    barrier();
    if (fan > 0) atomicMax(vitrailGroupPieces, uint(fan));
    barrier();
    uint pieces = vitrailGroupPieces;
    for (uint piece = 0u; piece < pieces; ++piece) {
      uint tilesOfMine = 0u;
      if (int(piece) < fan) {
        VitrailTriangle t;
        if (corners == 3u) {
          t = vitrailTriangleOf(viewport, polygon.corners[0], polygon.corners[piece + 1u], polygon.corners[piece + 2u],
                         source);
        } else {
          t = vitrailHalfOf(viewport, polygon.corners[0], polygon.corners[corners - 1u], corners, source);
        }
        ivec2 inFirst, inLast, low, high;
        vitrailBoundsOf(t, inFirst, inLast);
        tilesOfMine = vitrailCandidates(inFirst, inLast, least, most, low, high);
        VitrailSource of_;
        if (tilesOfMine > 0u && !vitrailOrientTriangle(t, draw, of_)) tilesOfMine = 0u;
        if (tilesOfMine > 0u) vitrailShareTriangle(thread, t, of_, low, high);
      }
      vitrailCoverAll(tilesOfMine);
      barrier(); // before the next piece takes the place of this one
    }
  }
}

void main() {
  if (VITRAIL_RASTER_CLASS == 0u) {
    vitrailSetUpMedium();
  } else {
    if (vitrailRasterControl.large == 0u) return;
    for (uint row = gl_WorkGroupID.y; row < vitrailRaster.tilesY; row += gl_NumWorkGroups.y) vitrailSetUpLarge(row);
  }
}

#endif
