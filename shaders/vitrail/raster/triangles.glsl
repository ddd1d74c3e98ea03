// Triangles of the picture, from their corners on: where they are, which tiles they may touch, what their records have
// in common.
#ifndef VITRAIL_RASTER_TRIANGLES_GLSL
#define VITRAIL_RASTER_TRIANGLES_GLSL

#include "clip.glsl"
#include "edges.glsl"
#include "pages.glsl"
#include "samples.glsl"
#include "surface.glsl"

struct VitrailTriangle {
  vec2 p0; // in subpixels: whole numbers
  vec2 p1;
  vec2 p2;
  vec3 depths;
  uint name; // of the primitive
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
  t.name = source.x;
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
  t.name = source.x;
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

// The pixels from `first` to `last` of which a triangle may cover something, within the band.
void vitrailBoundsOf(VitrailTriangle t, out ivec2 first, out ivec2 last) {
  const float subpixel = 1.0 / float(VITRAIL_SUBPIXELS); // times that, as a quotient may be rounded
  const float middle = VITRAIL_RASTER_SAMPLES == 1u ? float(VITRAIL_SUBPIXELS / 2) : 0.0; // samples are anywhere
  const float behind = VITRAIL_RASTER_SAMPLES == 1u ? float(VITRAIL_SUBPIXELS / 2 - 1) : 0.0;
  first = ivec2(floor((min(t.p0, min(t.p1, t.p2)) + behind) * subpixel));
  last = ivec2(floor((max(t.p0, max(t.p1, t.p2)) - middle) * subpixel));
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
  uint name; // of the primitive, and in the highest bit whether its front shows
  uint item;
  VitrailPlane plane;
  float nearest; // of its corners, 1 at most
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

VitrailSource vitrailSourceOf(VitrailTriangle t, bool front, float area) {
  VitrailSource source;
  source.name = t.name | (front ? 0x80000000u : 0u);
  source.item = t.item;
  source.plane = vitrailPlane(t.p0, t.p1, t.p2, t.depths, area);
  source.nearest = min(max(t.depths.x, max(t.depths.y, t.depths.z)), 1.0);
  return source;
}

// How far out of the picture a corner is, in subpixels.
float vitrailWayToPicture(vec2 p) {
  vec2 size = vec2(vitrailRaster.width, vitrailRaster.height) * float(VITRAIL_SUBPIXELS);
  vec2 way = max(max(-p, p - size), vec2(0.0));
  return max(way.x, way.y);
}

// Turns the corners so that the first is the one that is nearest to the picture. The plane of depths begins there: what
// its slopes are rounded by counts as often as there are pixels from there on, and a clipped triangle's corners may be
// 32,766 pixels away.
void vitrailBeginInPicture(inout VitrailTriangle t) {
  float way0 = vitrailWayToPicture(t.p0);
  if (way0 == 0.0) return; // most
  float way1 = vitrailWayToPicture(t.p1);
  float way2 = vitrailWayToPicture(t.p2);
  vec2 p0 = t.p0;
  if (way1 < way0 && way1 <= way2) {
    t.p0 = t.p1;
    t.p1 = t.p2;
    t.p2 = p0;
    t.depths = t.depths.yzx;
  } else if (way2 < way0) {
    t.p0 = t.p2;
    t.p2 = t.p1;
    t.p1 = p0;
    t.depths = t.depths.zxy;
  }
}

// False: it covers nothing, or is culled. Otherwise its corners run clockwise in the picture.
bool vitrailOrientTriangle(inout VitrailTriangle t, uint draw, out VitrailSource source) {
  vitrailBeginInPicture(t);
  float area = vitrailArea(ivec2(t.p0), ivec2(t.p1), ivec2(t.p2));
  bool front;
  if (area == 0.0 || !vitrailSideOf(draw, area > 0.0, front)) return false;
  source = vitrailSourceOf(t, front, area);
  if (area < 0.0) {
    vec2 other = t.p1;
    t.p1 = t.p2;
    t.p2 = other;
  }
  return true;
}

// The indices of a triangle, line or point.
uvec3 vitrailIndicesAt(uint draw, uint corners, uint name) {
  uint first = vitrailFirstIndex(draw, corners, name);
  return uvec3(vitrailIndex(draw, first), vitrailIndex(draw, first + (corners > 1u ? 1u : 0u)),
               vitrailIndex(draw, first + (corners > 2u ? 2u : 0u)));
}

// The triangle of a source, half of a line or point: something else where it is not whole. False: it covers nothing, or
// has no such vertices.
bool vitrailTriangleAt(uint draw, uint corners, uvec2 source, uvec3 indices, out VitrailTriangle t, out bool isWhole) {
  VitrailViewport viewport = vitrailViewportOf();
  if (corners == 3u) { // without arrays, which are slow
    if (!vitrailHasVertex(draw, max(indices.x, max(indices.y, indices.z)))) return false;
    vec4 a = vitrailClipPosition(draw, source.y, indices.x);
    vec4 b = vitrailClipPosition(draw, source.y, indices.y);
    vec4 c = vitrailClipPosition(draw, source.y, indices.z);
    isWhole = !vitrailNeedsClipping(viewport, a) && !vitrailNeedsClipping(viewport, b) &&
              !vitrailNeedsClipping(viewport, c);
    t.p0 = vitrailSnapInside(vitrailPixels(viewport, a, t.depths.x));
    t.p1 = vitrailSnapInside(vitrailPixels(viewport, b, t.depths.y));
    t.p2 = vitrailSnapInside(vitrailPixels(viewport, c, t.depths.z));
    t.name = source.x;
    t.item = source.y;
    return isWhole || !vitrailIsOutside(a, b, c);
  }
  if (!vitrailHasVertex(draw, max(indices.x, indices.y))) return false;
  VitrailPolygon p = vitrailPolygonOf(draw, corners, source);
  isWhole = !vitrailPolygonNeedsClipping(viewport, p);
  t = vitrailHalfOf(viewport, p.corners[0], p.corners[corners - 1u], corners, source);
  return true;
}

uint vitrailTileNumber(ivec2 tile) {
  return uint(tile.y - int(vitrailRaster.top) / VITRAIL_TILE_SIDE) * vitrailRaster.tilesX + uint(tile.x);
}

// How many work groups so many medium triangles are for: few for each where there are few, so that all of them wait for
// fewer tiles.
uint vitrailMediumGroups(uint count) {
  uint groups = min((count + VITRAIL_RASTER_FEW_MEDIUM - 1u) / VITRAIL_RASTER_FEW_MEDIUM, VITRAIL_RASTER_MEDIUM);
  return max(groups, (count + VITRAIL_RASTER_GROUP - 1u) / VITRAIL_RASTER_GROUP);
}

// Makes the record of a triangle in a tile, of the pixels that it covers there: its place, or one that there is no room
// for.
uint vitrailMakeRecord(ivec2 tile, uvec2 covered, VitrailSource source) {
  uint at = vitrailTileNumber(tile);
  uint place = vitrailTakePlace(at);
  if (place >= vitrailRaster.recordCapacity) return place; // the frame is drawn again
  ivec2 middle = tile * (VITRAIL_TILE_SIDE * VITRAIL_SUBPIXELS) + VITRAIL_SUBPIXELS / 2;
  vec3 depth = vitrailPlaneAt(source.plane, middle);
  // Some, of any tile and triangle, and the same ones in any frame and order: a tile's class hangs on them.
  uint some = (covered.x ^ covered.y * 0x85ebca6bu ^ floatBitsToUint(depth.x) ^ at * 0xc2b2ae35u) * 0x9e3779b9u;
  if (some < 0xffffffffu / VITRAIL_RASTER_SHARE) {
    atomicAdd(vitrailTiles[at * VITRAIL_RASTER_TILE_WORDS + 1u], uint(bitCount(covered.x) + bitCount(covered.y)));
  }
  float steps = float(VITRAIL_TILE_SIDE - 1);
  // At the middle of a pixel of which another part is covered a plane may be nearer than any corner.
  float nearest = depth.x + (max(depth.y, 0.0) + max(depth.z, 0.0)) * steps;
  nearest = min(nearest, VITRAIL_RASTER_SAMPLES == 1u ? source.nearest : 1.0);
  vitrailRecords[place] = uvec4(covered, source.name, source.item);
  vitrailRecords[vitrailRaster.recordCapacity + place] = floatBitsToUint(vec4(depth, nearest));
  return place;
}

#endif
