// Corners of clip space: which need clipping, where the others lie, and what is left of a triangle that is clipped.
// What src/raster/clip.h says in C++, step by step, so that both get the same bits. Pure functions: no resources.
// Before the include a shader defines VITRAIL_CLIP_PLANES, how many planes of its own cut triangles, or leaves it out.
#ifndef VITRAIL_RASTER_CLIP_GLSL
#define VITRAIL_RASTER_CLIP_GLSL

#ifndef VITRAIL_CLIP_PLANES
#define VITRAIL_CLIP_PLANES 0
#endif

const float VITRAIL_LEAST_W = 1.1754944e-38;
const float VITRAIL_MOST_W = 1.2676506e30;
const float VITRAIL_GUARD_BAND = 32766.0; // pixels; one less than coordinates have room for, for what rounding adds
const int VITRAIL_MOST_CORNERS = 9 + VITRAIL_CLIP_PLANES;

struct VitrailViewport {
  vec2 size; // in pixels
  vec2 band; // of x / w and y / w, within the guard band
#if VITRAIL_CLIP_PLANES > 0
  vec4 planes[VITRAIL_CLIP_PLANES]; // of clip space: points with dot(plane, point) >= 0 are kept
#endif
};

VitrailViewport vitrailViewport(vec2 size) {
  VitrailViewport viewport;
  viewport.size = size;
  viewport.band = 2.0 * VITRAIL_GUARD_BAND / size;
  return viewport;
}

// How far inside a plane: near, far, the four of the guard band, and the host's.
float vitrailClipDistance(VitrailViewport viewport, vec4 p, int plane) {
  if (plane == 0) return p.z;
  if (plane == 1) return p.w - p.z;
  if (plane == 2) return viewport.band.x * p.w - p.x;
  if (plane == 3) return viewport.band.x * p.w + p.x;
  if (plane == 4) return viewport.band.y * p.w - p.y;
  if (plane == 5) return viewport.band.y * p.w + p.y;
#if VITRAIL_CLIP_PLANES > 0
  return dot(viewport.planes[plane - 6], p);
#else
  return 0.0;
#endif
}

bool vitrailNeedsClipping(VitrailViewport viewport, vec4 p) {
  bool inside = p.w >= VITRAIL_LEAST_W && p.w <= VITRAIL_MOST_W && p.z >= 0.0 && p.w - p.z >= 0.0 &&
                abs(p.x) <= viewport.band.x * p.w && abs(p.y) <= viewport.band.y * p.w;
#if VITRAIL_CLIP_PLANES > 0
  for (int i = 0; i < VITRAIL_CLIP_PLANES; ++i) inside = inside && dot(viewport.planes[i], p) >= 0.0;
#endif
  return !inside;
}

// Whether all of a triangle lies outside one of the planes of the view: it covers nothing.
bool vitrailIsOutside(vec4 a, vec4 b, vec4 c) {
  vec3 x = vec3(a.x, b.x, c.x);
  vec3 y = vec3(a.y, b.y, c.y);
  vec3 z = vec3(a.z, b.z, c.z);
  vec3 w = vec3(a.w, b.w, c.w);
  return all(lessThan(z, vec3(0.0))) || all(greaterThan(z, w)) || all(greaterThan(x, w)) || all(lessThan(x, -w)) ||
         all(greaterThan(y, w)) || all(lessThan(y, -w));
}

// A corner's place in pixels, and its depth. Divide, scale, move, each rounded for itself.
vec2 vitrailPixels(VitrailViewport viewport, vec4 p, out float depth) {
  precise float inverse = 1.0 / p.w;
  vec2 middle = viewport.size * 0.5;
  precise vec2 unit = p.xy * inverse;
  precise vec2 scaled = unit * middle;
  precise vec2 pixels = scaled + middle;
  precise float z = p.z * inverse;
  depth = z;
  return pixels;
}

// Pixels to subpixels, which are whole numbers: to the nearest, ties to even.
vec2 vitrailSnap(vec2 pixels) {
  const float most = 2.0 * 32767.0;
  return roundEven(clamp(pixels, vec2(-most), vec2(most)) * 256.0);
}

// The same of what needs no clipping: it is within these bounds.
vec2 vitrailSnapInside(vec2 pixels) { return roundEven(pixels * 256.0); }

// The corner between one that is inside a plane and one that is outside, always from the inside: both triangles at an
// edge get the same one.
vec4 vitrailBetween(vec4 inside, float distanceIn, vec4 outside, float distanceOut) {
  precise float t = distanceIn / (distanceIn - distanceOut);
  precise vec4 way = outside - inside;
  precise vec4 part = t * way;
  precise vec4 made = inside + part;
  return made;
}

struct VitrailPolygon {
  vec4 corners[VITRAIL_MOST_CORNERS];
  int count;
};

// What is left of a triangle, or of a line as a polygon of two corners; nothing where that cannot be divided by its w.
VitrailPolygon vitrailClip(VitrailViewport viewport, VitrailPolygon polygon) {
  for (int plane = 0; plane < 6 + VITRAIL_CLIP_PLANES; ++plane) {
    VitrailPolygon left;
    left.count = 0;
    for (int i = 0; i < polygon.count; ++i) {
      vec4 from = polygon.corners[i];
      vec4 to = polygon.corners[i + 1 < polygon.count ? i + 1 : 0];
      float p = vitrailClipDistance(viewport, from, plane);
      float q = vitrailClipDistance(viewport, to, plane);
      bool fromInside = p >= 0.0; // not for a NaN
      bool toInside = q >= 0.0;
      if (fromInside && left.count < VITRAIL_MOST_CORNERS) left.corners[left.count++] = from;
      if (fromInside != toInside && left.count < VITRAIL_MOST_CORNERS) {
        left.corners[left.count++] = fromInside ? vitrailBetween(from, p, to, q) : vitrailBetween(to, q, from, p);
      }
    }
    polygon = left;
  }
  for (int i = 0; i < polygon.count; ++i) {
    vec4 p = polygon.corners[i];
    bool hasPlace = p.w >= VITRAIL_LEAST_W && p.w <= VITRAIL_MOST_W && !any(isnan(p)) && !any(isinf(p));
    if (!hasPlace) polygon.count = 0;
  }
  return polygon;
}

#endif
