// Which pixels a triangle covers, by the rules of graphics hardware: what src/raster/rules.h says in C++, in 32-bit
// integers and floats that hold whole numbers, a tile of 8 x 8 pixels at a time. Pure functions: no resources.
//
// Corners are in 1/256 pixel, y down, at most 2^23 from the picture's corner (the guard band). An edge function is
// exact where it is small; where it is not, its sign is.
#ifndef VITRAIL_RASTER_EDGES_GLSL
#define VITRAIL_RASTER_EDGES_GLSL

const int VITRAIL_SUBPIXELS = 256;
const int VITRAIL_TILE_SIDE = 8;

// Three edge functions, not negative inside. Edge i lies across from corner i.
struct VitrailEdges {
  ivec3 right; // what a pixel to the right adds
  ivec3 down;
  ivec3 bias;  // -1 where the edge is not the triangle's own: neither top nor left
};

// The bits above the lowest 8 of the 64-bit sum of two products and a bias, and within what 32-bit sums of a few steps
// can take.
int vitrailSumOfProducts(ivec2 a, ivec2 b, int bias) {
  int high0, high1;
  int low0, low1;
  imulExtended(a.x, b.x, high0, low0);
  imulExtended(a.y, b.y, high1, low1);
  uint carry;
  uint low = uaddCarry(uint(low0), uint(low1), carry);
  int high = high0 + high1 + int(carry);
  low = uaddCarry(low, uint(bias), carry);
  high += int(carry) + bias; // its sign, extended
  int upper = high >> 8;
  int lower = int(uint(high) << 24 | low >> 8);
  const int most = 1 << 29;
  if (upper != lower >> 31) return upper < 0 ? -most : most;
  return clamp(lower, -most, most);
}

// Of corners that run clockwise in the picture (y is down): whose area is positive.
VitrailEdges vitrailEdges(ivec2 p0, ivec2 p1, ivec2 p2) {
  VitrailEdges e;
  e.right = ivec3(p1.y - p2.y, p2.y - p0.y, p0.y - p1.y);
  e.down = ivec3(p2.x - p1.x, p0.x - p2.x, p1.x - p0.x);
  for (int i = 0; i < 3; ++i) e.bias[i] = e.right[i] > 0 || (e.right[i] == 0 && e.down[i] > 0) ? 0 : -1;
  return e;
}

// Twice the area in square subpixels, rounded to a float: positive where the corners run clockwise in the picture, 0
// only where there is none.
float vitrailArea(ivec2 p0, ivec2 p1, ivec2 p2) {
  ivec2 a = p1 - p0;
  ivec2 b = p2 - p0;
  int high0, high1;
  int low0, low1;
  imulExtended(a.x, b.y, high0, low0);
  imulExtended(a.y, b.x, high1, low1);
  uint borrow;
  uint low = usubBorrow(uint(low0), uint(low1), borrow);
  int high = high0 - high1 - int(borrow);
  if (high == int(low) >> 31) return float(int(low));
  return float(high) * 4294967296.0 + float(low);
}

// The edge functions at a place, in units of 256 squared subpixels: not negative inside.
ivec3 vitrailEdgesAt(VitrailEdges e, ivec2 p0, ivec2 p1, ivec2 p2, ivec2 place) {
  return ivec3(vitrailSumOfProducts(ivec2(e.right.x, e.down.x), place - p1, e.bias.x),
               vitrailSumOfProducts(ivec2(e.right.y, e.down.y), place - p2, e.bias.y),
               vitrailSumOfProducts(ivec2(e.right.z, e.down.z), place - p0, e.bias.z));
}

// The same of triangles whose corners are less than VITRAIL_MOST_LITTLE apart, and at places among them or a tile away:
// products fit into 32 bits.
const int VITRAIL_MOST_LITTLE = 8192;

bool vitrailIsLittle(ivec2 p0, ivec2 p1, ivec2 p2) {
  ivec2 extent = max(p0, max(p1, p2)) - min(p0, min(p1, p2));
  return max(extent.x, extent.y) < VITRAIL_MOST_LITTLE;
}

// Where they are even nearer to each other, floats hold edge functions exactly, also a pixel away: two products of such
// distances are together a whole number below 2^24.
const float VITRAIL_MOST_SMALL = 2560.0;

float vitrailSmallArea(vec2 p0, vec2 p1, vec2 p2) {
  vec2 a = p1 - p0;
  vec2 b = p2 - p0;
  return a.x * b.y - a.y * b.x;
}

// In square subpixels.
ivec3 vitrailLittleEdgesAt(VitrailEdges e, ivec2 p0, ivec2 p1, ivec2 p2, ivec2 place) {
  ivec3 x = ivec3(place.x - p1.x, place.x - p2.x, place.x - p0.x);
  ivec3 y = ivec3(place.y - p1.y, place.y - p2.y, place.y - p0.y);
  return e.right * x + e.down * y + e.bias;
}

// The pixels of a tile that are covered, rows top to bottom, 8 bits each; `first` are the edges at the middle of its
// first pixel.
uvec2 vitrailTileCoverage(VitrailEdges e, ivec3 first) {
  const int steps = VITRAIL_TILE_SIDE - 1;
  ivec3 most = first + (max(e.right, ivec3(0)) + max(e.down, ivec3(0))) * steps;
  if ((most.x | most.y | most.z) < 0) return uvec2(0u);
  ivec3 least = first + (min(e.right, ivec3(0)) + min(e.down, ivec3(0))) * steps;
  if ((least.x | least.y | least.z) >= 0) return uvec2(0xffffffffu);
  uvec2 covered = uvec2(0u);
  ivec3 row = first + e.right * steps;
  for (int y = 0; y < VITRAIL_TILE_SIDE; ++y) {
    ivec3 at = row;
    uint outside = 0u;
    for (int x = 0; x < VITRAIL_TILE_SIDE; ++x) {
      outside = outside << 1 | uint(at.x | at.y | at.z) >> 31;
      at -= e.right;
    }
    uint bits = outside ^ 0xffu;
    if (y < 4) {
      covered.x |= bits << (8 * y);
    } else {
      covered.y |= bits << (8 * y - 32);
    }
    row += e.down;
  }
  return covered;
}

// The same of a little triangle, by where its edges cross the rows. An edge at a row's first pixel is a whole number n
// of 16 square subpixels, and changes by another whole number d from pixel to pixel. So the first pixel that it has
// inside, or the number of those that it has, is a quotient of n + 1/2 and d, rounded up: which is half of 1 / d away
// from any whole number, at least 2^-18, and floats get these right to 2^-20 where it is among the row's eight.
struct VitrailRows {
  vec3 corner; // the edges at the upper left corner of the first pixel; all in units of 16 square subpixels
  vec3 right;  // what 1/16 pixel to the right adds
  vec3 down;
  vec4 scale; // edges to eighths of a row: of x, which begins what is inside, and of y, which ends it; of z for both
  vec4 bias;
};

// The triangle's corners in such an order that the first edge begins what is inside of a row, and the second ends it,
// or is level: the last corner is the uppermost.
#define VITRAIL_TURN_CORNERS(corner_) \
void vitrailTurnCorners(inout corner_ p0, inout corner_ p1, inout corner_ p2) { \
  corner_ a = p0; \
  corner_ b = p1; \
  if (p2.y <= p0.y && p2.y < p1.y) return; \
  if (p0.y <= p1.y && p0.y < p2.y) { \
    p0 = b; \
    p1 = p2; \
    p2 = a; \
  } else { \
    p0 = p2; \
    p1 = a; \
    p2 = b; \
  } \
}
VITRAIL_TURN_CORNERS(ivec2)
VITRAIL_TURN_CORNERS(vec2)
#undef VITRAIL_TURN_CORNERS

// Of a triangle whose corners are in that order.
VitrailRows vitrailRows(vec3 corner, vec3 right, vec3 down) {
  VitrailRows rows;
  rows.corner = corner;
  rows.right = right;
  rows.down = down;
  const float most = 65536.0; // of a level edge: all of a row is inside or nothing
  vec3 way = -1.0 / (128.0 * right);
  if (right.y == 0.0) way.y = most;
  if (right.z == 0.0) way.z = most;
  bool begins = right.z > 0.0;
  vec3 half_ = 0.5 * way + 0.125;
  rows.scale = vec4(way.xy, begins ? vec2(way.z, 0.0) : vec2(0.0, way.z));
  rows.bias = vec4(half_.xy, begins ? vec2(half_.z, 1.0) : vec2(0.0, half_.z));
  return rows;
}

// Of a little one; `pixel` is the first, whose corner is among the triangle's or a tile away.
VitrailRows vitrailLittleRows(ivec2 p0, ivec2 p1, ivec2 p2, ivec2 pixel) {
  VitrailEdges e = vitrailEdges(p0, p1, p2);
  vec3 corner = vec3(vitrailLittleEdgesAt(e, p0, p1, p2, pixel * VITRAIL_SUBPIXELS) >> 4);
  return vitrailRows(corner, vec3(e.right), vec3(e.down));
}

// Of one whose corners are less than VITRAIL_MOST_SMALL apart; `place` is the corner of the first pixel, which is among
// the triangle's or a pixel away. The same edges, in floats: converting whole numbers takes longer than they do.
VitrailRows vitrailSmallRows(vec2 p0, vec2 p1, vec2 p2, vec2 place) {
  vec3 right = vec3(p1.y - p2.y, p2.y - p0.y, p0.y - p1.y);
  vec3 down = vec3(p2.x - p1.x, p0.x - p2.x, p1.x - p0.x);
  vec3 x = vec3(place.x - p1.x, place.x - p2.x, place.x - p0.x);
  vec3 y = vec3(place.y - p1.y, place.y - p2.y, place.y - p0.y);
  vec3 edges = right * x + down * y;
  for (int i = 0; i < 3; ++i) {
    if (!(right[i] > 0.0 || (right[i] == 0.0 && down[i] > 0.0))) edges[i] -= 1.0; // bias
  }
  return vitrailRows(floor(edges * 0.0625), right, down);
}

// Of eighths from 0 to 8 the whole ones. The sum has 20 bits behind the point, whichever way it is rounded, and is made
// at once; converting it takes eight times as long.
uint vitrailWholeOf(float eighths) { return (floatBitsToUint(fma(eighths, 8.0, 8.0)) >> 20) - 1040u; }

#define VITRAIL_COVER_ROWS(count_) \
  uint covered = 0u; \
  for (int y = 0; y < count_; ++y) { \
    vec4 ends = clamp(fma(at.xyzz, rows.scale, rows.bias), 0.0, 1.0); \
    uint first = vitrailWholeOf(max(ends.x, ends.z)); \
    uint count = vitrailWholeOf(min(ends.y, ends.w)); \
    covered += (0xffu << first & ((1u << count) - 1u)) << (8 * y); \
    at += rows.down * 16.0; \
  } \
  return covered;
uint vitrailTwoRows(VitrailRows rows, vec3 at) { VITRAIL_COVER_ROWS(2) }
uint vitrailFourRows(VitrailRows rows, vec3 at) { VITRAIL_COVER_ROWS(4) }

// `place` is where in its pixel the sample is, in 1/16 pixel; rows from `count` on cover nothing.
uvec2 vitrailRowCoverage(VitrailRows rows, ivec2 place, int count) {
  vec3 at = rows.corner + rows.right * float(place.x) + rows.down * float(place.y);
  return uvec2(vitrailFourRows(rows, at), count > 4 ? vitrailFourRows(rows, at + rows.down * 64.0) : 0u);
}

// The same of the middles of pixels, of small triangles: many have two rows or one.
uvec2 vitrailFewRowCoverage(VitrailRows rows, int count) {
  vec3 at = rows.corner + (rows.right + rows.down) * 8.0;
  uint upper = vitrailTwoRows(rows, at);
  if (count > 2) upper |= vitrailTwoRows(rows, at + rows.down * 32.0) << 16;
  return uvec2(upper, count > 4 ? vitrailFourRows(rows, at + rows.down * 64.0) : 0u);
}

// The pixels of a tile from `low` up to and without `high`, both relative to its first.
uvec2 vitrailTileWindow(ivec2 low, ivec2 high) {
  low = clamp(low, ivec2(0), ivec2(VITRAIL_TILE_SIDE));
  high = clamp(high, ivec2(0), ivec2(VITRAIL_TILE_SIDE));
  uint columns = (0xffu >> (8 - high.x)) & (0xffu << low.x);
  uvec2 window = uvec2(0u);
  for (int y = 0; y < VITRAIL_TILE_SIDE; ++y) {
    if (y < low.y || y >= high.y) continue;
    if (y < 4) {
      window.x |= (columns & 0xffu) << (8 * y);
    } else {
      window.y |= (columns & 0xffu) << (8 * y - 32);
    }
  }
  return window;
}

// The depths of a triangle as a plane over the picture: at a place, and what a pixel to the right and down adds.
struct VitrailPlane {
  vec2 place; // in subpixels
  vec3 depth; // at the place; right; down
};

// `area` is vitrailArea(), not 0. A triangle so thin that its plane would be nothing but rounding is as deep as its
// corners in the mean.
VitrailPlane vitrailPlane(vec2 p0, vec2 p1, vec2 p2, vec3 depths, float area) {
  vec2 a = p1 - p0;
  vec2 b = p2 - p0;
  vec2 rise = depths.yz - depths.x;
  VitrailPlane plane;
  plane.place = p0;
  float longest = max(max(abs(a.x) + abs(a.y), abs(b.x) + abs(b.y)), abs(a.x - b.x) + abs(a.y - b.y));
  if (4.0 * abs(area) < longest) {
    plane.depth = vec3((depths.x + depths.y + depths.z) / 3.0, 0.0, 0.0);
    return plane;
  }
  float inverse = float(VITRAIL_SUBPIXELS) / area;
  plane.depth = vec3(depths.x, (rise.x * b.y - rise.y * a.y) * inverse, (rise.y * a.x - rise.x * b.x) * inverse);
  return plane;
}

// The same at another place, in subpixels.
vec3 vitrailPlaneAt(VitrailPlane plane, ivec2 place) {
  vec2 way = (vec2(place) - plane.place) / float(VITRAIL_SUBPIXELS);
  return vec3(fma(plane.depth.y, way.x, fma(plane.depth.z, way.y, plane.depth.x)), plane.depth.yz);
}

#endif
