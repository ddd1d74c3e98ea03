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

// The triangles of the work group.
shared ivec4 sharedCorners[TILES_GROUP];  // the first two
shared ivec4 sharedTile[TILES_GROUP];     // the third; the first tile
shared vec4 sharedPlane[TILES_GROUP];     // its depths at the first corner; the nearest depth
shared uvec4 sharedSource[TILES_GROUP];   // primitive, instance; tiles in a row
shared uint sharedEnds[TILES_GROUP];      // of each triangle's candidates: tiles that it may touch
shared uint sharedFirst;                  // place of the first candidate
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

// The corners of a triangle, line or point in clip space.
VitrailPolygon polygonOf(uint draw, uint corners, uvec2 source) {
  InstancePlace place = placeOf(source.y);
  uint first = firstIndexOf(draw, corners, source.x);
  VitrailPolygon polygon;
  for (uint i = 0u; i < corners; ++i) {
    vec4 clip = clipOf(worldOf(place, positionOf(draw, indices[first + i])));
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

// Tiles from `low` up to and without `high` that a triangle may touch, within the given ones.
uint candidates(Triangle t, ivec2 least, ivec2 most, out ivec2 low, out ivec2 high) {
  const int middle = kSamples == 1u ? VITRAIL_SUBPIXELS / 2 : 0; // samples are anywhere
  const int behind = kSamples == 1u ? VITRAIL_SUBPIXELS / 2 - 1 : 0;
  ivec2 first = (min(t.p0, min(t.p1, t.p2)) + behind) >> 8;
  ivec2 last = (max(t.p0, max(t.p1, t.p2)) - middle) >> 8;
  first = max(first, ivec2(0, int(tiles.top)));
  last = min(last, ivec2(tiles.width, tiles.bottom) - 1);
  low = max(first >> 3, least);
  high = min((last >> 3) + 1, most);
  if (any(greaterThan(first, last)) || any(greaterThanEqual(low, high))) return 0u;
  return uint(high.x - low.x) * uint(high.y - low.y);
}

// Puts a triangle where all threads find it. False: it covers nothing.
bool share(uint thread, Triangle t, ivec2 low, ivec2 high) {
  float area = vitrailArea(t.p0, t.p1, t.p2);
  if (area == 0.0) return false;
  VitrailPlane plane = vitrailPlane(t.p0, t.p1, t.p2, t.depths, area);
  float nearest = max(t.depths.x, max(t.depths.y, t.depths.z));
  uint draw = drawOfInstance[2u * t.instance];
  bool mirrored = draws[draw].mirrored != 0u;
  bool front = (area < 0.0) != mirrored; // counter-clockwise in the picture
  if (cornersOf(draws[draw].features) < 3u) front = true;
  sharedCorners[thread] = area > 0.0 ? ivec4(t.p0, t.p1) : ivec4(t.p0, t.p2);
  sharedTile[thread] = ivec4(area > 0.0 ? t.p2 : t.p1, low);
  sharedPlane[thread] = vec4(plane.depth, nearest);
  sharedSource[thread] = uvec4(t.primitive | (front ? 0x80000000u : 0u), t.instance, high.x - low.x, 0u);
  return true;
}

// Makes the record of a candidate, in which triangle `thread` may touch the tile of that number.
void cover(uint thread, uint number, uint place) {
  ivec4 corners = sharedCorners[thread];
  ivec4 rest = sharedTile[thread];
  uvec4 source = sharedSource[thread];
  ivec2 tile = rest.zw + ivec2(number % source.z, number / source.z);
  ivec2 pixel = tile * VITRAIL_TILE_SIDE;
  ivec2 middle = pixel * VITRAIL_SUBPIXELS + VITRAIL_SUBPIXELS / 2;
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
  uint at = NO_TILE;
  if ((covered.x | covered.y) != 0u) {
    at = uint(tile.y - int(tiles.top) / VITRAIL_TILE_SIDE) * tiles.tilesX + uint(tile.x);
    vec4 shared_ = sharedPlane[thread];
    VitrailPlane plane = VitrailPlane(vec2(corners.xy), shared_.xyz);
    vec3 depth = vitrailPlaneAt(plane, middle);
    float steps = float(VITRAIL_TILE_SIDE - 1);
    // At the middle of a pixel of which another part is covered a plane may be nearer than any corner.
    float nearest = depth.x + (max(depth.y, 0.0) + max(depth.z, 0.0)) * steps;
    if (kSamples == 1u) nearest = min(shared_.w, nearest);
    records[2u * place] = uvec4(covered, source.xy);
    records[2u * place + 1u] = floatBitsToUint(vec4(depth, nearest));
    places[3u * place + 1u] = atomicAdd(tileRecords[at].x, 1u);
    places[3u * place + 2u] = keyOf(nearest);
  }
  places[3u * place] = at;
}

// All threads together: the candidates of the triangles that were shared, of which this thread's has `mine`.
void coverAll(uint mine) {
  uint thread = gl_LocalInvocationIndex;
  sharedEnds[thread] = mine;
  barrier();
  for (uint step = 1u; step < TILES_GROUP; step *= 2u) { // sums of what is before (Hillis and Steele, 1986)
    uint before = thread >= step ? sharedEnds[thread - step] : 0u;
    barrier();
    sharedEnds[thread] += before;
    barrier();
  }
  uint all = sharedEnds[TILES_GROUP - 1u];
  if (all == 0u) return;
  if (thread == 0u) {
    TAKE_PLACES(control.records, control.recordsHigh, all, sharedFirst)
  }
  barrier();
  for (uint i = thread; i < all; i += TILES_GROUP) {
    uint owner = 0u; // the first whose end is beyond i
    for (uint step = TILES_GROUP / 2u; step > 0u; step /= 2u) {
      if (sharedEnds[owner + step - 1u] <= i) owner += step;
    }
    uint first = owner > 0u ? sharedEnds[owner - 1u] : 0u;
    cover(owner, i - first, sharedFirst + i);
  }
}

#ifndef TILES_OF_LARGE

// The draw whose triangles a work group sets up.
uint drawOfGroup(uint group) {
  uint low = 0u;
  uint high = tiles.draws;
  while (high - low > 1u) {
    uint middle = (low + high) / 2u;
    if (draws[middle].firstGroup <= group) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return low;
}

void putAside(uvec2 source) {
  uint place = atomicAdd(control.large, 1u);
  if (place < tiles.largeCapacity) large[place] = source;
}

// How many tiles the thread's triangle may touch, which is shared then.
uint setUp(uint draw, uvec2 source) {
  uint corners = cornersOf(draws[draw].features);
  VitrailPolygon p = polygonOf(draw, corners, source);
  if (corners == 3u && vitrailIsOutside(p.corners[0], p.corners[1], p.corners[2])) return 0u;
  VitrailViewport viewport = viewportOf();
  if (needsClipping(viewport, p)) {
    putAside(source);
    return 0u;
  }
  Triangle t;
  if (corners == 3u) {
    t = triangleOf(viewport, p.corners[0], p.corners[1], p.corners[2], source);
  } else {
    t = halfOf(viewport, p.corners[0], p.corners[corners - 1u], corners, source);
  }
  ivec2 low, high;
  uint count = candidates(t, ivec2(0), ivec2(0x7fffffff), low, high);
  if (count > TILES_LARGE) {
    putAside(source);
    return 0u;
  }
  return count > 0u && share(gl_LocalInvocationIndex, t, low, high) ? count : 0u;
}

void main() {
  uint group = flatGroup();
  uint draw = drawOfGroup(group);
  uint number = (group - draws[draw].firstGroup) * TILES_GROUP + gl_LocalInvocationIndex;
  uint triangles = draws[draw].triangles;
  uint count = 0u;
  if (number < triangles * draws[draw].instances) {
    count = setUp(draw, uvec2(number % triangles, draws[draw].firstInstance + number / triangles));
  }
  coverAll(count);
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
    uint corners = cornersOf(draws[draw].features);
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
        ivec2 low, high;
        tilesOfMine = candidates(t, least, most, low, high);
        if (tilesOfMine > 0u && !share(thread, t, low, high)) tilesOfMine = 0u;
      }
      coverAll(tilesOfMine);
      barrier(); // before the next piece takes the place of this one
    }
  }
}

#endif
