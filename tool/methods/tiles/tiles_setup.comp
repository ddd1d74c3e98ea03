// Sets up triangles and makes a record for each tile in which one covers a pixel. One thread takes a triangle; the
// tiles that the triangles of a work group may touch are then shared by all its threads, so that a few larger ones
// among many small ones keep nobody waiting.
//
// As it stands it takes all triangles, and puts aside those that may touch very many tiles and those that need
// clipping. With TILES_OF_LARGE it takes those, for a part of a row of tiles.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef TILES_CLIPPED
#define VITRAIL_CLIP_PLANES 8 // CLIP_PLANE_COUNT
#endif
#include "vitrail/raster/edges.glsl"
#include "vitrail/raster/clip.glsl"

#include "geometry.glsl"
#include "samples.glsl"
#include "tiles_frame.glsl"

layout(local_size_x = TILES_GROUP) in;

layout(constant_id = 0) const uint kAnyFeatures = 0u; // that some draw has

// Where there are only triangles that is known beforehand.
uint cornersOfDraw(uint draw) { return (kAnyFeatures & FEATURE_SOLID) == 0u ? 3u : cornersOf(draws[draw].features); }

// The triangles of the work group.
shared ivec4 sharedCorners[TILES_GROUP];  // the first two
shared ivec4 sharedTile[TILES_GROUP];     // the third; the first tile
shared vec4 sharedPlane[TILES_GROUP];     // its depths at the first corner; the nearest depth
shared uvec4 sharedSource[TILES_GROUP];   // primitive, instance; tiles in a row; draw
shared uint sharedEnds[TILES_GROUP];      // sums: candidates (tiles that it may touch) << 16 | records of small ones
shared uint sharedFirst;                  // place of the first record of a small triangle
#ifdef TILES_OF_LARGE
shared uint sharedPieces;
#endif

struct Triangle {
  ivec2 p0;
  ivec2 p1;
  ivec2 p2;
  vec3 depths;
  uint primitive;
  uint instance;
};

VitrailViewport viewportOf() {
  VitrailViewport viewport = vitrailViewport(vec2(tiles.width, tiles.height));
#ifdef TILES_CLIPPED
  for (int i = 0; i < VITRAIL_CLIP_PLANES; ++i) viewport.planes[i] = tiles.clipPlanes[i];
#endif
  return viewport;
}

Triangle triangleOf(VitrailViewport viewport, vec4 a, vec4 b, vec4 c, uvec2 source) {
  Triangle t;
  t.p0 = vitrailSnap(vitrailPixels(viewport, a, t.depths.x));
  t.p1 = vitrailSnap(vitrailPixels(viewport, b, t.depths.y));
  t.p2 = vitrailSnap(vitrailPixels(viewport, c, t.depths.z));
  t.primitive = source.x;
  t.instance = source.y;
  return t;
}

// One of the two triangles of a line, a pixel wide across the axis along which it is longer, or of a point, where both
// ends are the same.
Triangle halfOf(VitrailViewport viewport, vec4 a, vec4 b, uint corners, uvec2 source) {
  float depthA, depthB;
  vec2 from = vitrailPixels(viewport, a, depthA);
  vec2 to = vitrailPixels(viewport, b, depthB);
  bool isSteep = abs(to.y - from.y) > abs(to.x - from.x);
  vec2 across = isSteep ? vec2(0.5, 0.0) : vec2(0.0, 0.5);
  vec2 along = vec2(0.0);
  if (corners == 1u) {
    across = vec2(0.0, 0.5 * tiles.pointSize);
    along = vec2(0.5 * tiles.pointSize, 0.0);
  }
  bool second = (source.x & 1u) != 0u;
  Triangle t;
  t.p0 = vitrailSnap(from - along - across);
  t.p1 = vitrailSnap(to + along + (second ? across : -across));
  t.p2 = vitrailSnap((second ? from - along : to + along) + across);
  t.depths = vec3(depthA, depthB, second ? depthA : depthB);
  t.primitive = source.x;
  t.instance = source.y;
  return t;
}

// A vertex of an instance in clip space.
vec4 clipAt(uint draw, uint instance, uint vertex) {
  if (kCorners) return cornerPlaces[cornerOf(draw, instance, vertex)];
  return clipOf(worldOf(placeOf(instance), positionOf(draw, vertex)));
}

// The corners of a triangle, line or point in clip space.
VitrailPolygon polygonOf(uint draw, uint corners, uvec2 source) {
  uint first = firstIndexOf(draw, corners, source.x);
  VitrailPolygon polygon;
  for (uint i = 0u; i < corners; ++i) {
    vec4 clip = clipAt(draw, source.y, indices[first + i]);
    if (corners == 2u) clip.xy += clip.w * frame.depth.zw; // as surface.vert
    polygon.corners[i] = clip;
  }
  polygon.count = int(corners);
  return polygon;
}

bool needsClipping(VitrailViewport viewport, VitrailPolygon polygon) {
  bool needs = false;
  for (int i = 0; i < polygon.count; ++i) needs = needs || vitrailNeedsClipping(viewport, polygon.corners[i]);
  return needs;
}

// The pixels from `first` to `last` of which a triangle may cover something, within the band.
void boundsOf(Triangle t, out ivec2 first, out ivec2 last) {
  const int middle = kSamples == 1u ? VITRAIL_SUBPIXELS / 2 : 0; // samples are anywhere
  const int behind = kSamples == 1u ? VITRAIL_SUBPIXELS / 2 - 1 : 0;
  first = (min(t.p0, min(t.p1, t.p2)) + behind) >> 8;
  last = (max(t.p0, max(t.p1, t.p2)) - middle) >> 8;
  first = max(first, ivec2(0, int(tiles.top)));
  last = min(last, ivec2(tiles.width, tiles.bottom) - 1);
}

// How many tiles it may touch, from `low` up to and without `high`, within the given ones.
uint candidates(ivec2 first, ivec2 last, ivec2 least, ivec2 most, out ivec2 low, out ivec2 high) {
  low = max(first >> 3, least);
  high = min((last >> 3) + 1, most);
  if (any(greaterThan(first, last)) || any(greaterThanEqual(low, high))) return 0u;
  return uint(high.x - low.x) * uint(high.y - low.y);
}

// What a triangle's records have in common.
struct Source {
  uint primitive; // and in the highest bit whether its front shows
  uint instance;
  uint draw;
  VitrailPlane plane;
  float nearest; // of its corners
};

// False: it covers nothing. Otherwise its corners run clockwise in the picture.
bool orient(inout Triangle t, uint draw, out Source source) {
  float area = vitrailArea(t.p0, t.p1, t.p2);
  if (area == 0.0) return false;
  bool mirrored = draws[draw].mirrored != 0u;
  bool front = (area < 0.0) != mirrored; // counter-clockwise in the picture
  if (cornersOfDraw(draw) < 3u) front = true;
  source.primitive = t.primitive | (front ? 0x80000000u : 0u);
  source.instance = t.instance;
  source.draw = draw;
  source.plane = vitrailPlane(t.p0, t.p1, t.p2, t.depths, area);
  source.nearest = max(t.depths.x, max(t.depths.y, t.depths.z));
  if (area < 0.0) {
    ivec2 other = t.p1;
    t.p1 = t.p2;
    t.p2 = other;
  }
  return true;
}

// Puts a triangle where all threads find it.
void share(uint thread, Triangle t, Source source, ivec2 low, ivec2 high) {
  sharedCorners[thread] = ivec4(t.p0, t.p1);
  sharedTile[thread] = ivec4(t.p2, low);
  sharedPlane[thread] = vec4(source.plane.depth, source.nearest);
  sharedSource[thread] = uvec4(source.primitive, source.instance, high.x - low.x, source.draw);
}

// Makes the record of a triangle in a tile: of the pixels that it covers there, or none.
void makeRecord(uint place, ivec2 tile, uvec2 covered, Source source) {
  if (place >= tiles.recordCapacity) return;
  uint at = NO_TILE;
  if ((covered.x | covered.y) != 0u) {
    at = uint(tile.y - int(tiles.top) / VITRAIL_TILE_SIDE) * tiles.tilesX + uint(tile.x);
    ivec2 middle = tile * (VITRAIL_TILE_SIDE * VITRAIL_SUBPIXELS) + VITRAIL_SUBPIXELS / 2;
    vec3 depth = vitrailPlaneAt(source.plane, middle);
    float steps = float(VITRAIL_TILE_SIDE - 1);
    // At the middle of a pixel of which another part is covered a plane may be nearer than any corner.
    float nearest = depth.x + (max(depth.y, 0.0) + max(depth.z, 0.0)) * steps;
    if (kSamples == 1u) nearest = min(source.nearest, nearest);
    records[2u * place] = uvec4(covered, source.primitive, source.instance);
    records[2u * place + 1u] = floatBitsToUint(vec4(depth, nearest));
    places[3u * place + 1u] = atomicAdd(tileRecords[at].x, 1u);
    places[3u * place + 2u] = source.draw;
  }
  places[3u * place] = at;
}

// The same of a candidate, in which triangle `thread` may touch the tile of that number.
void cover(uint thread, uint number, uint place) {
  ivec4 corners = sharedCorners[thread];
  ivec4 rest = sharedTile[thread];
  uvec4 source = sharedSource[thread];
  vec4 plane = sharedPlane[thread];
  ivec2 tile = rest.zw + ivec2(number % source.z, number / source.z);
  ivec2 pixel = tile * VITRAIL_TILE_SIDE;
  if (place >= tiles.recordCapacity) return;
  VitrailEdges edges = vitrailEdges(corners.xy, corners.zw, rest.xy);
  ivec2 end = ivec2(tiles.width, tiles.bottom);
  bool isCut = any(greaterThan(pixel + VITRAIL_TILE_SIDE, end));
  uvec2 window = isCut ? vitrailTileWindow(ivec2(0), end - pixel) : uvec2(0xffffffffu);
  uvec2 covered = uvec2(0u);
  for (uint i = 0u; i < kSamples; ++i) {
    ivec2 at = pixel * VITRAIL_SUBPIXELS + samplePlace(i) * (VITRAIL_SUBPIXELS / 16);
    uvec2 samples = window & vitrailTileCoverage(edges, vitrailEdgesAt(edges, corners.xy, corners.zw, rest.xy, at));
    if (kSamples > 1u) sampleMasks[place * kSamples + i] = samples;
    covered |= samples;
  }
  makeRecord(place, tile, covered,
             Source(source.x, source.y, source.w, VitrailPlane(vec2(corners.xy), plane.xyz), plane.w));
}

// A triangle that fits into 8 x 8 pixels, and so into four tiles.
struct Small {
  uvec2 covered[4]; // of those: left and right, upper and lower
  ivec2 tile;       // the first
  Source source;
  uint count;       // of tiles in which it covers something; 0: there is none
};

uvec2 shiftedUp(uvec2 mask, uint bits) { // to the left, by less than 64
  if (bits == 0u) return mask;
  if (bits >= 32u) return uvec2(0u, mask.x << (bits - 32u));
  return uvec2(mask.x << bits, mask.y << bits | mask.x >> (32u - bits));
}
uvec2 shiftedDown(uvec2 mask, uint bits) {
  if (bits == 0u) return mask;
  if (bits >= 32u) return uvec2(mask.y >> (bits - 32u), 0u);
  return uvec2(mask.x >> bits | mask.y << (32u - bits), mask.y >> bits);
}

// Cuts the pixels that are covered of 8 x 8, of which `first` is the first, at the borders of tiles.
void cutSmall(inout Small small, uvec2 mask, ivec2 first) {
  uvec2 in_ = uvec2(first & (VITRAIL_TILE_SIDE - 1));
  uint columns = (0xffu >> in_.x) * 0x01010101u; // that are in the left tile
  uvec2 left = (mask & columns) << in_.x;
  uvec2 right = in_.x > 0u ? (mask & ~columns) >> (8u - in_.x) : uvec2(0u);
  small.tile = first >> 3;
  small.covered[0] = shiftedUp(left, 8u * in_.y);
  small.covered[1] = shiftedUp(right, 8u * in_.y);
  small.covered[2] = in_.y > 0u ? shiftedDown(left, 64u - 8u * in_.y) : uvec2(0u);
  small.covered[3] = in_.y > 0u ? shiftedDown(right, 64u - 8u * in_.y) : uvec2(0u);
  for (int i = 0; i < 4; ++i) small.count += (small.covered[i].x | small.covered[i].y) != 0u ? 1u : 0u;
}

// All threads together: this thread's small triangle, and the candidates of the triangles that were shared, of which
// this thread's has `mine`.
void coverAll(Small small, uint mine) {
  uint thread = gl_LocalInvocationIndex;
  uint both = mine << 16 | small.count; // at most TILES_LARGE, or TILES_LARGE_BLOCK, of each of TILES_GROUP
  sharedEnds[thread] = both;
  barrier();
  for (uint step = 1u; step < TILES_GROUP; step *= 2u) { // sums of what is before (Hillis and Steele, 1986)
    uint before = thread >= step ? sharedEnds[thread - step] : 0u;
    barrier();
    sharedEnds[thread] += before;
    barrier();
  }
  uint all = sharedEnds[TILES_GROUP - 1u];
  if (all == 0u) return;
  uint smalls = all & 0xffffu;
  uint candidates_ = all >> 16;
  if (thread == 0u) {
    TAKE_PLACES(control.records, control.recordsHigh, smalls + candidates_, sharedFirst)
  }
  barrier();
  if (small.count > 0u) {
    uint place = sharedFirst + (sharedEnds[thread] & 0xffffu) - small.count;
    for (int i = 0; i < 4; ++i) {
      if ((small.covered[i].x | small.covered[i].y) == 0u) continue;
      makeRecord(place, small.tile + ivec2(i & 1, i >> 1), small.covered[i], small.source);
      ++place;
    }
  }
  for (uint i = thread; i < candidates_; i += TILES_GROUP) {
    uint owner = 0u; // the first whose end is beyond i
    for (uint step = TILES_GROUP / 2u; step > 0u; step /= 2u) {
      if (sharedEnds[owner + step - 1u] >> 16 <= i) owner += step;
    }
    uint first = owner > 0u ? sharedEnds[owner - 1u] >> 16 : 0u;
    cover(owner, i - first, sharedFirst + smalls + i);
  }
}

Small noSmall() {
  Small small;
  small.count = 0u;
  return small;
}

#ifndef TILES_OF_LARGE

void putAside(uvec2 source) {
  uint place = atomicAdd(control.large, 1u);
  if (place < tiles.largeCapacity) large[place] = source;
}

// How many tiles the thread's triangle may touch, which is shared then, unless it is small.
uint setUp(uint draw, uvec2 number, inout Small small) {
  uint corners = cornersOfDraw(draw);
  VitrailViewport viewport = viewportOf();
  bool isWhole;
  Triangle t;
  if (corners == 3u) { // without arrays, which are slow
    uint first = firstIndexOf(draw, corners, number.x);
    vec4 a = clipAt(draw, number.y, indices[first]);
    vec4 b = clipAt(draw, number.y, indices[first + 1u]);
    vec4 c = clipAt(draw, number.y, indices[first + 2u]);
    if (vitrailIsOutside(a, b, c)) return 0u;
    isWhole = !vitrailNeedsClipping(viewport, a) && !vitrailNeedsClipping(viewport, b) &&
              !vitrailNeedsClipping(viewport, c);
    t = triangleOf(viewport, a, b, c, number);
  } else {
    VitrailPolygon p = polygonOf(draw, corners, number);
    isWhole = !needsClipping(viewport, p);
    t = halfOf(viewport, p.corners[0], p.corners[corners - 1u], corners, number);
  }
  if (!isWhole) {
    putAside(number);
    return 0u;
  }
  ivec2 first, last, low, high;
  boundsOf(t, first, last);
  uint count = candidates(first, last, ivec2(0), ivec2(0x7fffffff), low, high);
  if (count > TILES_LARGE) {
    putAside(number);
    return 0u;
  }
  Source source;
  if (count == 0u || !orient(t, draw, source)) return 0u;
  if (kSamples == 1u && all(lessThan(last - first, ivec2(VITRAIL_TILE_SIDE)))) {
    VitrailEdges edges = vitrailEdges(t.p0, t.p1, t.p2);
    ivec2 middle = first * VITRAIL_SUBPIXELS + VITRAIL_SUBPIXELS / 2;
    uvec2 mask = vitrailTileCoverage(edges, vitrailEdgesAt(edges, t.p0, t.p1, t.p2, middle));
    small.source = source;
    bool isCut = any(greaterThan(first + VITRAIL_TILE_SIDE, ivec2(tiles.width, tiles.bottom)));
    if (isCut) mask &= vitrailTileWindow(ivec2(0), last - first + 1);
    cutSmall(small, mask, first);
    return 0u;
  }
  share(gl_LocalInvocationIndex, t, source, low, high);
  return count;
}

void main() {
  uint group = flatGroup();
  if (group >= drawOfGroup.length()) return; // the last row is longer
  uint draw = drawOfGroup[group];
  uint number = (group - draws[draw].firstGroup) * TILES_GROUP + gl_LocalInvocationIndex;
  uint triangles = draws[draw].triangles;
  uint count = 0u;
  Small small = noSmall();
  if (number < triangles * draws[draw].instances) {
    uint instance = number < triangles ? 0u : number / triangles;
    count = setUp(draw, uvec2(number - instance * triangles, draws[draw].firstInstance + instance), small);
  }
  coverAll(small, count);
}

#else

// The tiles of this work group.
void blockOf(out ivec2 low, out ivec2 high) {
  int first = int((gl_WorkGroupID.x % tiles.largeBlocks) * TILES_LARGE_BLOCK);
  int row = int(gl_WorkGroupID.y) + int(tiles.top) / VITRAIL_TILE_SIDE;
  low = ivec2(first, row);
  high = ivec2(min(first + int(TILES_LARGE_BLOCK), int(tiles.tilesX)), row + 1);
}

// What is left of a triangle or line; of a point all or nothing.
VitrailPolygon clippedOf(VitrailViewport viewport, uint draw, uint corners, uvec2 source) {
  VitrailPolygon whole = polygonOf(draw, corners, source);
  if (!needsClipping(viewport, whole)) return whole;
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
  VitrailViewport viewport = viewportOf();
  ivec2 least, most;
  blockOf(least, most);
  uint count = min(control.large, tiles.largeCapacity);
  uint shares = gl_NumWorkGroups.x / tiles.largeBlocks; // of them, each by a work group of a block
  uint share_ = gl_WorkGroupID.x / tiles.largeBlocks;
  for (uint first = share_ * TILES_GROUP; first < count; first += shares * TILES_GROUP) {
    bool mine = first + thread < count;
    uvec2 source = mine ? large[first + thread] : uvec2(0u);
    VitrailPolygon polygon;
    polygon.count = 0;
    uint draw = drawOfInstance[2u * source.y];
    uint corners = cornersOfDraw(draw);
    if (mine) polygon = clippedOf(viewport, draw, corners, source);
    int fan = corners == 3u ? polygon.count - 2 : min(polygon.count, 1);
    barrier(); // all have left the last turn
    if (thread == 0u) sharedPieces = 0u;
    barrier();
    if (fan > 0) atomicMax(sharedPieces, uint(fan));
    barrier();
    uint pieces = sharedPieces;
    for (uint piece = 0u; piece < pieces; ++piece) {
      uint tilesOfMine = 0u;
      if (int(piece) < fan) {
        Triangle t;
        if (corners == 3u) {
          t = triangleOf(viewport, polygon.corners[0], polygon.corners[piece + 1u], polygon.corners[piece + 2u],
                         source);
        } else {
          t = halfOf(viewport, polygon.corners[0], polygon.corners[corners - 1u], corners, source);
        }
        ivec2 inFirst, inLast, low, high;
        boundsOf(t, inFirst, inLast);
        tilesOfMine = candidates(inFirst, inLast, least, most, low, high);
        Source of_;
        if (tilesOfMine > 0u && !orient(t, draw, of_)) tilesOfMine = 0u;
        if (tilesOfMine > 0u) share(thread, t, of_, low, high);
      }
      coverAll(noSmall(), tilesOfMine);
      barrier(); // before the next piece takes the place of this one
    }
  }
}

#endif
