// Sets up triangles and makes a record for each tile in which one covers a pixel. One thread takes a triangle; the
// tiles that the triangles of a work group may touch are then shared by all its threads, so that a few larger ones
// among many small ones keep nobody waiting.
//
// As it stands it takes all triangles, and puts aside those that may touch very many tiles and those that need
// clipping. With VITRAIL_RASTER_OF_LARGE it takes those, for a part of a row of tiles.
#ifndef VITRAIL_RASTER_SET_UP_GLSL
#define VITRAIL_RASTER_SET_UP_GLSL

#include "clip.glsl"
#include "edges.glsl"
#include "samples.glsl"
#include "surface.glsl"

layout(local_size_x = VITRAIL_RASTER_GROUP) in;

// The triangles of the work group.
shared ivec4 vitrailGroupCorners[VITRAIL_RASTER_GROUP]; // the first two
shared ivec4 vitrailGroupTiles[VITRAIL_RASTER_GROUP];   // the third; the first tile
shared vec4 vitrailGroupPlanes[VITRAIL_RASTER_GROUP];   // its depths at the first corner; the nearest depth
shared uvec4 vitrailGroupSources[VITRAIL_RASTER_GROUP]; // primitive, item; tiles in a row; draw
shared uint vitrailGroupEnds[VITRAIL_RASTER_GROUP];     // of the candidates of each, among those of all
shared uint vitrailGroupSmalls;                         // records of small triangles
shared uint vitrailGroupShares;                         // 1: some triangle has candidates
shared uint vitrailGroupFirst;                          // place of the first record of a small triangle
#ifdef VITRAIL_RASTER_OF_LARGE
shared uint vitrailGroupPieces;
#endif

struct VitrailTriangle {
  ivec2 p0;
  ivec2 p1;
  ivec2 p2;
  vec3 depths;
  uint primitive;
  uint item;
};

VitrailViewport vitrailViewportOf() {
  VitrailViewport viewport = vitrailViewport(vec2(vitrailRaster.width, vitrailRaster.height));
#if VITRAIL_CLIP_PLANES > 0
  for (int i = 0; i < VITRAIL_CLIP_PLANES; ++i) viewport.planes[i] = vitrailRaster.clipPlanes[i];
#endif
  return viewport;
}

VitrailTriangle vitrailTriangleOf(VitrailViewport viewport, vec4 a, vec4 b, vec4 c, uvec2 source) {
  VitrailTriangle t;
  t.p0 = vitrailSnap(vitrailPixels(viewport, a, t.depths.x));
  t.p1 = vitrailSnap(vitrailPixels(viewport, b, t.depths.y));
  t.p2 = vitrailSnap(vitrailPixels(viewport, c, t.depths.z));
  t.primitive = source.x;
  t.item = source.y;
  return t;
}

// One of the two triangles of a line, a pixel wide across the axis along which it is longer, or of a point, where both
// ends are the same.
VitrailTriangle vitrailHalfOf(VitrailViewport viewport, vec4 a, vec4 b, uint corners, uvec2 source) {
  float depthA, depthB;
  vec2 from = vitrailPixels(viewport, a, depthA);
  vec2 to = vitrailPixels(viewport, b, depthB);
  bool isSteep = abs(to.y - from.y) > abs(to.x - from.x);
  vec2 across = isSteep ? vec2(0.5, 0.0) : vec2(0.0, 0.5);
  vec2 along = vec2(0.0);
  if (corners == 1u) {
    across = vec2(0.0, 0.5 * vitrailRaster.pointSize);
    along = vec2(0.5 * vitrailRaster.pointSize, 0.0);
  }
  bool second = (source.x & 1u) != 0u;
  VitrailTriangle t;
  t.p0 = vitrailSnap(from - along - across);
  t.p1 = vitrailSnap(to + along + (second ? across : -across));
  t.p2 = vitrailSnap((second ? from - along : to + along) + across);
  t.depths = vec3(depthA, depthB, second ? depthA : depthB);
  t.primitive = source.x;
  t.item = source.y;
  return t;
}

// The corners of a triangle, line or point in clip space.
VitrailPolygon vitrailPolygonOf(uint draw, uint corners, uvec2 source) {
  uint first = vitrailFirstIndex(draw, corners, source.x);
  VitrailPolygon polygon;
  for (uint i = 0u; i < corners; ++i) {
    polygon.corners[i] = vitrailClipPosition(draw, source.y, vitrailIndex(draw, first + i));
  }
  polygon.count = int(corners);
  return polygon;
}

bool vitrailPolygonNeedsClipping(VitrailViewport viewport, VitrailPolygon polygon) {
  bool needs = false;
  for (int i = 0; i < polygon.count; ++i) needs = needs || vitrailNeedsClipping(viewport, polygon.corners[i]);
  return needs;
}

// The pixels from `first` to `last` of which a triangle may vitrailCoverTile something, within the band.
void vitrailBoundsOf(VitrailTriangle t, out ivec2 first, out ivec2 last) {
  const int middle = VITRAIL_RASTER_SAMPLES == 1u ? VITRAIL_SUBPIXELS / 2 : 0; // samples are anywhere
  const int behind = VITRAIL_RASTER_SAMPLES == 1u ? VITRAIL_SUBPIXELS / 2 - 1 : 0;
  first = (min(t.p0, min(t.p1, t.p2)) + behind) >> 8;
  last = (max(t.p0, max(t.p1, t.p2)) - middle) >> 8;
  first = max(first, ivec2(0, int(vitrailRaster.top)));
  last = min(last, ivec2(vitrailRaster.width, vitrailRaster.bottom) - 1);
}

// How many tiles it may touch, from `low` up to and without `high`, within the given ones.
uint vitrailCandidates(ivec2 first, ivec2 last, ivec2 least, ivec2 most, out ivec2 low, out ivec2 high) {
  low = max(first >> 3, least);
  high = min((last >> 3) + 1, most);
  if (any(greaterThan(first, last)) || any(greaterThanEqual(low, high))) return 0u;
  return uint(high.x - low.x) * uint(high.y - low.y);
}

// What a triangle's records have in common.
struct VitrailSource {
  uint primitive; // and in the highest bit whether its front shows
  uint item;
  uint draw;
  VitrailPlane plane;
  float nearest; // of its corners
};

// Which side shows of one whose corners run clockwise in the picture, or not. False: that is culled.
bool vitrailSideOf(uint draw, bool isClockwise, out bool front) {
  uint flags = vitrailFlagsOf(draw);
  front = isClockwise == ((flags & VITRAIL_RASTER_FRONT_CLOCKWISE) != 0u);
  if (vitrailCornersOf(flags) < 3u) {
    front = true;
    return true;
  }
  return (flags & (front ? VITRAIL_RASTER_CULL_FRONT : VITRAIL_RASTER_CULL_BACK)) == 0u;
}

VitrailSource vitrailSourceOf(VitrailTriangle t, uint draw, bool front, float area) {
  VitrailSource source;
  source.primitive = t.primitive | (front ? 0x80000000u : 0u);
  source.item = t.item;
  source.draw = draw;
  source.plane = vitrailPlane(t.p0, t.p1, t.p2, t.depths, area);
  source.nearest = max(t.depths.x, max(t.depths.y, t.depths.z));
  return source;
}

// False: it covers nothing, or is culled. Otherwise its corners run clockwise in the picture.
bool vitrailOrientTriangle(inout VitrailTriangle t, uint draw, out VitrailSource source) {
  float area = vitrailArea(t.p0, t.p1, t.p2);
  bool front;
  if (area == 0.0 || !vitrailSideOf(draw, area > 0.0, front)) return false;
  source = vitrailSourceOf(t, draw, front, area);
  if (area < 0.0) {
    ivec2 other = t.p1;
    t.p1 = t.p2;
    t.p2 = other;
  }
  return true;
}

// Puts a triangle where all threads find it.
void vitrailShareTriangle(uint thread, VitrailTriangle t, VitrailSource source, ivec2 low, ivec2 high) {
  vitrailGroupCorners[thread] = ivec4(t.p0, t.p1);
  vitrailGroupTiles[thread] = ivec4(t.p2, low);
  vitrailGroupPlanes[thread] = vec4(source.plane.depth, source.nearest);
  vitrailGroupSources[thread] = uvec4(source.primitive, source.item, high.x - low.x, source.draw);
}

uint vitrailTileNumber(ivec2 tile) {
  return uint(tile.y - int(vitrailRaster.top) / VITRAIL_TILE_SIDE) * vitrailRaster.tilesX + uint(tile.x);
}

// Makes the record of a triangle in a tile: of the pixels that it covers there, or none. It is the tile's `number`-th.
void vitrailMakeRecord(uint place, ivec2 tile, uint number, uvec2 covered, VitrailSource source) {
  uint at = VITRAIL_NO_TILE;
  if ((covered.x | covered.y) != 0u) {
    at = vitrailTileNumber(tile);
    ivec2 middle = tile * (VITRAIL_TILE_SIDE * VITRAIL_SUBPIXELS) + VITRAIL_SUBPIXELS / 2;
    vec3 depth = vitrailPlaneAt(source.plane, middle);
    float steps = float(VITRAIL_TILE_SIDE - 1);
    // At the middle of a pixel of which another part is covered a plane may be nearer than any corner.
    float nearest = depth.x + (max(depth.y, 0.0) + max(depth.z, 0.0)) * steps;
    if (VITRAIL_RASTER_SAMPLES == 1u) nearest = min(source.nearest, nearest);
    vitrailRecords[2u * place] = uvec4(covered, source.primitive, source.item);
    vitrailRecords[2u * place + 1u] = floatBitsToUint(vec4(depth, nearest));
    vitrailRecordPlaces[3u * place + 1u] = number;
    vitrailRecordPlaces[3u * place + 2u] = source.draw;
  }
  vitrailRecordPlaces[3u * place] = at;
}

// A candidate: a tile that a shared triangle may touch.
struct VitrailCandidate {
  ivec2 tile;
  uint place; // of its record
  VitrailSource source;
  VitrailEdges edges;
  ivec2 p0;
  ivec2 p1;
  ivec2 p2;
  bool isLittle;
  ivec3 corner; // of a little one, the edges at the tile's corner
  uvec2 window; // the tile's pixels that lie in the band
};

// The i-th of the group.
VitrailCandidate vitrailCandidateOf(uint i, uint firstPlace) {
  uint owner = 0u; // the first whose end is beyond i
  for (uint step = VITRAIL_RASTER_GROUP / 2u; step > 0u; step /= 2u) {
    if (vitrailGroupEnds[owner + step - 1u] <= i) owner += step;
  }
  uint number = i - (owner > 0u ? vitrailGroupEnds[owner - 1u] : 0u);
  ivec4 corners = vitrailGroupCorners[owner];
  ivec4 rest = vitrailGroupTiles[owner];
  uvec4 source = vitrailGroupSources[owner];
  vec4 plane = vitrailGroupPlanes[owner];
  VitrailCandidate c;
  c.tile = rest.zw + ivec2(number % source.z, number / source.z);
  c.place = firstPlace + i;
  c.source = VitrailSource(source.x, source.y, source.w, VitrailPlane(vec2(corners.xy), plane.xyz), plane.w);
  c.p0 = corners.xy;
  c.p1 = corners.zw;
  c.p2 = rest.xy;
  c.edges = vitrailEdges(c.p0, c.p1, c.p2);
  c.isLittle = vitrailIsLittle(c.p0, c.p1, c.p2);
  ivec2 pixel = c.tile * VITRAIL_TILE_SIDE;
  c.corner = vitrailLittleEdgesAt(c.edges, c.p0, c.p1, c.p2, pixel * VITRAIL_SUBPIXELS);
  ivec2 end = ivec2(vitrailRaster.width, vitrailRaster.bottom);
  bool isCut = any(greaterThan(pixel + VITRAIL_TILE_SIDE, end));
  c.window = isCut ? vitrailTileWindow(ivec2(0), end - pixel) : uvec2(0xffffffffu);
  return c;
}

// The pixels of which it covers that sample.
uvec2 vitrailCoverCandidate(VitrailCandidate c, uint sample_) {
  ivec2 way = vitrailSamplePlace(sample_) * (VITRAIL_SUBPIXELS / 16);
  ivec3 at = (c.corner + c.edges.right * way.x + c.edges.down * way.y) >> 8; // from sample to sample a step
  if (!c.isLittle) {
    ivec2 place = c.tile * (VITRAIL_TILE_SIDE * VITRAIL_SUBPIXELS) + way;
    at = vitrailEdgesAt(c.edges, c.p0, c.p1, c.p2, place);
  }
  return c.window & vitrailTileCoverage(c.edges, at);
}

// All candidates of the group, a thread each.
void vitrailCoverCandidates(uint count, uint firstPlace) {
  for (uint i = gl_LocalInvocationIndex; i < count; i += VITRAIL_RASTER_GROUP) {
    VitrailCandidate c = vitrailCandidateOf(i, firstPlace);
    if (c.place >= vitrailRaster.recordCapacity) continue;
#ifdef VITRAIL_MULTISAMPLED
    uvec2 covered = uvec2(0u);
    uvec2 samples[VITRAIL_RASTER_MOST_SAMPLES];
#define VITRAIL_COVER_SAMPLE(i) \
  if (i < VITRAIL_RASTER_SAMPLES) { \
    samples[i] = vitrailCoverCandidate(c, i); \
    covered |= samples[i]; \
  }
    VITRAIL_EACH_SAMPLE(VITRAIL_COVER_SAMPLE)
    if ((covered.x | covered.y) != 0u) vitrailKeepSamples(c.place, samples);
#else
    uvec2 covered = vitrailCoverCandidate(c, 0u);
#endif
    uint number = 0u;
    if ((covered.x | covered.y) != 0u) number = atomicAdd(vitrailTileRecords[vitrailTileNumber(c.tile)].x, 1u);
    vitrailMakeRecord(c.place, c.tile, number, covered, c.source);
  }
}

// A triangle that fits into 8 x 8 pixels, and so into four tiles.
struct VitrailSmall {
  uvec2 covered; // of these pixels
#ifdef VITRAIL_MULTISAMPLED
  uvec2 samples[VITRAIL_RASTER_MOST_SAMPLES]; // the same of each
#endif
  ivec2 first;   // pixel
  VitrailSource source;
  uint count;    // of tiles in which it covers something; 0: there is none
};

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

uint vitrailTilesOfSmall(uvec2 mask, ivec2 first) {
  uint count = 0u;
  for (uint i = 0u; i < 4u; ++i) {
    uvec2 covered = vitrailCutAtTiles(mask, first, i);
    count += (covered.x | covered.y) != 0u ? 1u : 0u;
  }
  return count;
}

// All threads together: this thread's small triangle, and the candidates of the triangles that were shared, of which
// this thread's has `mine`.
void vitrailCoverAll(VitrailSmall small, uint mine) {
  uint thread = gl_LocalInvocationIndex;
  if (thread == 0u) vitrailGroupSmalls = vitrailGroupShares = 0u;
  barrier();
  uint place = small.count > 0u ? atomicAdd(vitrailGroupSmalls, small.count) : 0u;
  if (mine > 0u) vitrailGroupShares = 1u;
  barrier();
  uint smalls = vitrailGroupSmalls;
  uint candidates_ = 0u;
  if (vitrailGroupShares != 0u) { // sums of what is before (Hillis and Steele, 1986)
    vitrailGroupEnds[thread] = mine;
    barrier();
    for (uint step = 1u; step < VITRAIL_RASTER_GROUP; step *= 2u) {
      uint before = thread >= step ? vitrailGroupEnds[thread - step] : 0u;
      barrier();
      vitrailGroupEnds[thread] += before;
      barrier();
    }
    candidates_ = vitrailGroupEnds[VITRAIL_RASTER_GROUP - 1u];
  }
  if (smalls + candidates_ == 0u) return;
  if (thread == 0u) {
    VITRAIL_TAKE_PLACES(vitrailRasterControl.records, vitrailRasterControl.recordsHigh, smalls + candidates_,
                        vitrailGroupFirst)
  }
  barrier();
  if (small.count > 0u) {
    place += vitrailGroupFirst;
    // Else the frame is drawn again. A sum of places may come round.
    bool fits = place < vitrailRaster.recordCapacity && place + small.count <= vitrailRaster.recordCapacity;
    uvec2 covered[4];
    uint numbers[4]; // asked for together: nobody waits for one after the other
    for (uint i = 0u; i < 4u; ++i) {
      covered[i] = vitrailCutAtTiles(small.covered, small.first, i);
      uint at = vitrailTileNumber((small.first >> 3) + ivec2(i & 1u, i >> 1));
      if ((covered[i].x | covered[i].y) != 0u && fits) numbers[i] = atomicAdd(vitrailTileRecords[at].x, 1u);
    }
    for (uint i = 0u; i < 4u; ++i) {
      if ((covered[i].x | covered[i].y) == 0u || !fits) continue;
      vitrailMakeRecord(place, (small.first >> 3) + ivec2(i & 1u, i >> 1), numbers[i], covered[i], small.source);
#ifdef VITRAIL_MULTISAMPLED
      uvec2 samples[VITRAIL_RASTER_MOST_SAMPLES];
#define VITRAIL_CUT_SAMPLE(k) \
  if (k < VITRAIL_RASTER_SAMPLES) samples[k] = vitrailCutAtTiles(small.samples[k], small.first, i);
      VITRAIL_EACH_SAMPLE(VITRAIL_CUT_SAMPLE)
      vitrailKeepSamples(place, samples);
#endif
      ++place;
    }
  }
  vitrailCoverCandidates(candidates_, vitrailGroupFirst + smalls);
}

VitrailSmall vitrailNoSmall() {
  VitrailSmall small;
  small.count = 0u;
  return small;
}

#ifndef VITRAIL_RASTER_OF_LARGE

void vitrailPutAside(uvec2 source) {
  uint place = atomicAdd(vitrailRasterControl.large, 1u);
  if (place < vitrailRaster.largeCapacity) vitrailLarge[place] = source;
}

// How many tiles the thread's triangle may touch, which is shared then, unless it is small.
uint vitrailSetUp(uint draw, uvec2 number, inout VitrailSmall small) {
  uint corners = vitrailCornersOf(vitrailFlagsOf(draw));
  VitrailViewport viewport = vitrailViewportOf();
  bool isWhole;
  VitrailTriangle t;
  if (corners == 3u) { // without arrays, which are slow
    uint first = vitrailFirstIndex(draw, corners, number.x);
    uvec3 indices = uvec3(vitrailIndex(draw, first), vitrailIndex(draw, first + 1u), vitrailIndex(draw, first + 2u));
    if (!vitrailHasVertex(draw, max(indices.x, max(indices.y, indices.z)))) return 0u;
    vec4 a = vitrailClipPosition(draw, number.y, indices.x);
    vec4 b = vitrailClipPosition(draw, number.y, indices.y);
    vec4 c = vitrailClipPosition(draw, number.y, indices.z);
    isWhole = !vitrailNeedsClipping(viewport, a) && !vitrailNeedsClipping(viewport, b) &&
              !vitrailNeedsClipping(viewport, c);
    if (!isWhole && vitrailIsOutside(a, b, c)) return 0u;
    t = vitrailTriangleOf(viewport, a, b, c, number);
  } else {
    uint first = vitrailFirstIndex(draw, corners, number.x);
    if (!vitrailHasVertex(draw, max(vitrailIndex(draw, first), vitrailIndex(draw, first + corners - 1u)))) return 0u;
    VitrailPolygon p = vitrailPolygonOf(draw, corners, number);
    isWhole = !vitrailPolygonNeedsClipping(viewport, p);
    t = vitrailHalfOf(viewport, p.corners[0], p.corners[corners - 1u], corners, number);
  }
  if (!isWhole) {
    vitrailPutAside(number);
    return 0u;
  }
  ivec2 first, last, low, high;
  vitrailBoundsOf(t, first, last);
  uint count = vitrailCandidates(first, last, ivec2(0), ivec2(0x7fffffff), low, high);
  if (count > VITRAIL_RASTER_LARGE) {
    vitrailPutAside(number);
    return 0u;
  }
  if (count == 0u) return 0u;
  bool isSmall = all(lessThan(last - first, ivec2(VITRAIL_TILE_SIDE))) && vitrailIsLittle(t.p0, t.p1, t.p2);
  if (isSmall) {
    int area = vitrailLittleArea(t.p0, t.p1, t.p2);
    bool front;
    if (area == 0 || !vitrailSideOf(draw, area > 0, front)) return 0u;
    ivec2 p1 = area > 0 ? t.p1 : t.p2;
    ivec2 p2 = area > 0 ? t.p2 : t.p1;
    VitrailEdges edges = vitrailEdges(t.p0, p1, p2);
    bool isCut = any(greaterThan(first + VITRAIL_TILE_SIDE, ivec2(vitrailRaster.width, vitrailRaster.bottom)));
    uvec2 window = isCut ? vitrailTileWindow(ivec2(0), last - first + 1) : uvec2(0xffffffffu);
    ivec3 corner = vitrailLittleEdgesAt(edges, t.p0, p1, p2, first * VITRAIL_SUBPIXELS);
    small.covered = uvec2(0u);
#ifdef VITRAIL_MULTISAMPLED
#define VITRAIL_KEEP_SMALL(i, mask) small.samples[i] = mask;
#else
#define VITRAIL_KEEP_SMALL(i, mask)
#endif
#define VITRAIL_COVER_SMALL(i) \
  if (i < VITRAIL_RASTER_SAMPLES) { \
    ivec2 place = vitrailSamplePlace(i) * (VITRAIL_SUBPIXELS / 16); \
    ivec3 at = corner + edges.right * place.x + edges.down * place.y; \
    uvec2 mask = window & vitrailLittleCoverage(edges, at, last - first + 1); \
    VITRAIL_KEEP_SMALL(i, mask) \
    small.covered |= mask; \
  }
    VITRAIL_EACH_SAMPLE(VITRAIL_COVER_SMALL)
    if ((small.covered.x | small.covered.y) == 0u) return 0u;
    small.first = first;
    small.count = vitrailTilesOfSmall(small.covered, first);
    small.source = vitrailSourceOf(t, draw, front, float(area));
    return 0u;
  }
  VitrailSource source;
  if (!vitrailOrientTriangle(t, draw, source)) return 0u;
  vitrailShareTriangle(gl_LocalInvocationIndex, t, source, low, high);
  return count;
}

void main() {
  uint group = vitrailFlatGroup();
  if (group >= vitrailRasterStart.groups.count) return; // the last row is longer
  uint draw = vitrailDrawOfGroup[group];
  uvec4 size = vitrailDrawPlaces[draw].size;
  uint number = (group - size.z) * VITRAIL_RASTER_GROUP + gl_LocalInvocationIndex;
  uint triangles = size.x;
  uint count = 0u;
  VitrailSmall small = vitrailNoSmall();
  if (number < triangles * size.y) {
    uint instance = number < triangles ? 0u : number / triangles;
    count = vitrailSetUp(draw, uvec2(number - instance * triangles, size.w + instance), small);
  }
  vitrailCoverAll(small, count);
}

#else

// The tiles of this work group.
void vitrailBlockOf(out ivec2 low, out ivec2 high) {
  int first = int((gl_WorkGroupID.x % vitrailRaster.largeBlocks) * VITRAIL_RASTER_LARGE_BLOCK);
  int row = int(gl_WorkGroupID.y) + int(vitrailRaster.top) / VITRAIL_TILE_SIDE;
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
void main() {
  uint thread = gl_LocalInvocationIndex;
  VitrailViewport viewport = vitrailViewportOf();
  ivec2 least, most;
  vitrailBlockOf(least, most);
  uint count = min(vitrailRasterControl.large, vitrailRaster.largeCapacity);
  uint shares = gl_NumWorkGroups.x / vitrailRaster.largeBlocks; // of them, each by a work group of a block
  uint share_ = gl_WorkGroupID.x / vitrailRaster.largeBlocks;
  for (uint first = share_ * VITRAIL_RASTER_GROUP; first < count; first += shares * VITRAIL_RASTER_GROUP) {
    bool mine = first + thread < count;
    uvec2 source = mine ? vitrailLarge[first + thread] : uvec2(0u);
    VitrailPolygon polygon;
    polygon.count = 0;
    uint draw = mine ? vitrailDrawOfItem[source.y] : 0u;
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
      vitrailCoverAll(vitrailNoSmall(), tilesOfMine);
      barrier(); // before the next piece takes the place of this one
    }
  }
}

#endif

#endif
