// Which pixels a triangle covers, by the rules of graphics hardware: what src/raster/rules.h says in C++, in 32-bit
// integers, a tile of 8 x 8 pixels at a time. Pure functions: no resources.
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

int vitrailLittleArea(ivec2 p0, ivec2 p1, ivec2 p2) {
  ivec2 a = p1 - p0;
  ivec2 b = p2 - p0;
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

// The same of a little triangle that covers nothing beyond `size` pixels from the first one on: only these are looked
// at, and at most three to their right.
uvec2 vitrailLittleCoverage(VitrailEdges e, ivec3 first, ivec2 size) {
  bool isWide = size.x > 4;
  ivec3 right = e.right * VITRAIL_SUBPIXELS;
  ivec3 down = e.down * VITRAIL_SUBPIXELS;
  ivec3 row = first + right * (isWide ? 7 : 3);
  uvec2 covered = uvec2(0u);
  for (int y = 0; y < size.y; ++y) {
    ivec3 at = row;
    uint outside = 0u;
    if (isWide) {
      for (int x = 0; x < 4; ++x) {
        outside = outside << 1 | uint(at.x | at.y | at.z) >> 31;
        at -= right;
      }
    }
    for (int x = 0; x < 4; ++x) {
      outside = outside << 1 | uint(at.x | at.y | at.z) >> 31;
      at -= right;
    }
    uint bits = (outside ^ 0xffu) & (isWide ? 0xffu : 0xfu);
    if (y < 4) {
      covered.x |= bits << (8 * y);
    } else {
      covered.y |= bits << (8 * y - 32);
    }
    row += down;
  }
  return covered;
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
VitrailPlane vitrailPlane(ivec2 p0, ivec2 p1, ivec2 p2, vec3 depths, float area) {
  vec2 a = vec2(p1 - p0);
  vec2 b = vec2(p2 - p0);
  vec2 rise = depths.yz - depths.x;
  VitrailPlane plane;
  plane.place = vec2(p0);
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
