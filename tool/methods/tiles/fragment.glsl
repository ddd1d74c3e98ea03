// Shades a record's surface at a pixel: what the vertex shader and interpolation hand to surface.glsl, from the
// vertices of its triangle.
#ifndef VITRAIL_TOOL_TILES_FRAGMENT_GLSL
#define VITRAIL_TOOL_TILES_FRAGMENT_GLSL

#include "geometry.glsl"

#define SURFACE_OF_DRAWS
#include "stage/surface.glsl"

// Weights of a triangle's corners at a place, with perspective, from the corners' x, y and w in clip space after the
// place has been moved to the origin (Olano and Greer, "Triangle scan conversion using 2D homogeneous coordinates",
// 1997): right also where a corner lies behind the eye.
vec3 weightsOf(vec2 a, vec2 b, vec2 c) {
  vec3 e = vec3(b.x * c.y - b.y * c.x, c.x * a.y - c.y * a.x, a.x * b.y - a.y * b.x);
  float sum = e.x + e.y + e.z;
  return sum != 0.0 ? e / sum : vec3(1.0 / 3.0);
}

// Of a line, at the place nearest to another along the axis along which it is longer.
vec2 weightsOf(vec3 a, vec3 b, vec2 ndc, vec2 size) {
  vec2 way = abs((b.xy * a.z - a.xy * b.z) * size);
  vec2 from = a.xy - ndc * a.z;
  vec2 to = b.xy - ndc * b.z;
  vec2 ends = way.y > way.x ? vec2(from.y, to.y) : vec2(from.x, to.x);
  float t = ends.x != ends.y ? clamp(ends.x / (ends.x - ends.y), 0.0, 1.0) : 0.0;
  return vec2(1.0 - t, t);
}

struct Corners {
  uint count; // 2 of a line, 1 of a point, whose others are the first
  uvec3 vertices;
  uint first;   // of cornerPlaces
  vec3 clip[3]; // x, y, w
};

vec3 weightsAt(Corners c, vec2 ndc, vec2 size) {
  if (c.count == 1u) return vec3(1.0, 0.0, 0.0);
  if (c.count == 2u) return vec3(weightsOf(c.clip[0], c.clip[1], ndc, size), 0.0);
  return weightsOf(c.clip[0].xy - ndc * c.clip[0].z, c.clip[1].xy - ndc * c.clip[1].z,
                   c.clip[2].xy - ndc * c.clip[2].z);
}

vec4 tangentOf(uint draw, uint vertex) {
  uint packed = tangents[word(draw, 2u, vertex)];
  ivec2 t = ivec2(int(packed << 16) >> 16, int(packed) >> 16);
  return vec4(fromOctahedral(vec2(float(t.x) / 32767.0, float(t.y >> 1) / 16383.0)), (t.y & 1) != 0 ? -1.0 : 1.0);
}

vec4 colorOf(uint draw, uint vertex) {
  uint at = word(draw, 5u, vertex);
  return vec4(unpackHalf2x16(colors[at]), unpackHalf2x16(colors[at + 1u]));
}

vec4 texCoordsOf(uint draw, uint vertex) {
  uint at0 = word(draw, 3u, vertex);
  uint at1 = word(draw, 4u, vertex);
  return vec4(texCoords0[at0], texCoords0[at0 + 1u], texCoords1[at1], texCoords1[at1 + 1u]);
}

// What of the vertices is interpolated for textures: both texture coordinates, here and a pixel to the right and down.
void setTexCoords(uint draw, Corners corners, vec3 weights, ivec2 pixel, vec2 size) {
  mat3x4 uv;
  for (uint i = 0u; i < 3u; ++i) uv[i] = texCoordsOf(draw, corners.vertices[i]);
  surfaceTexCoords = uv * weights;
  // As the four pixels of a square tell each other: from the even one to the odd one.
  bvec2 odd = equal(pixel & 1, ivec2(1));
  vec2 step = mix(vec2(1.0), vec2(-1.0), odd);
  vec2 middle = vec2(pixel) + 0.5;
  vec4 right = uv * weightsAt(corners, vec2(middle.x + step.x, middle.y) * 2.0 / size - 1.0, size);
  vec4 down = uv * weightsAt(corners, vec2(middle.x, middle.y + step.y) * 2.0 / size - 1.0, size);
  surfaceTexCoordsRight = (right - surfaceTexCoords) * step.x;
  surfaceTexCoordsDown = (down - surfaceTexCoords) * step.y;
}

void setDirections(uint draw, InstancePlace place, Corners corners, vec3 weights) {
  InstanceTurn turn = turnOf(place);
  if (!has(FEATURE_FLAT)) {
    vec3 normal = vec3(0.0);
    if (kCorners) {
      for (uint i = 0u; i < 3u; ++i) normal += weights[i] * cornerNormals[corners.first + corners.vertices[i]].xyz;
      inNormal = normal;
    } else {
      for (uint i = 0u; i < 3u; ++i) normal += weights[i] * normalOf(draw, corners.vertices[i]);
      inNormal = turnedNormal(turn, normal);
    }
  }
  if (hasTexture(SLOT_NORMAL) || has(FEATURE_RARE)) {
    vec4 tangent = vec4(0.0);
    for (uint i = 0u; i < 3u; ++i) tangent += weights[i] * tangentOf(draw, corners.vertices[i]);
    inTangent = vec4(tangent.xyz * turn.rows, tangent.w * turn.mirrored);
  } else {
    inTangent.w = turn.mirrored;
  }
  if (has(FEATURE_VOLUME)) {
    inTangent.w = abs(inTangent.w) * turn.size * pow(abs(turn.volume), 1.0 / 3.0) * sign(inTangent.w);
  }
}

// Where a surface is only matters to lights that are near, and to planes; else only from where it is seen.
const bool kNeedsPlaces = (kAnyFeatures & (FEATURE_LIGHTS | FEATURE_FLAT)) != 0u || !kCorners;

// From a surface at the pixel to the eye.
vec3 wayToEye(ivec2 pixel) {
  vec2 at = vec2(pixel) + 0.5;
  vec3 ray = vec3(at.x * frame.ray.x - frame.ray.z, frame.ray.w - at.y * frame.ray.y, -1.0);
  return -(mat3(frame.cameraToWorld) * ray);
}

// `source`: the primitive, with the side in its highest bit, and the instance, of that draw. `size`: of the picture.
Surface shadeFragment(uvec2 source, uint draw, ivec2 pixel, vec2 size) {
  surfaceFeatures = draws[draw].features;
  surfaceMaterial = draws[draw].materialNumber;
  surfaceDraw = draw;
  surfaceFront = (source.x & 0x80000000u) != 0u;
  surfaceCut = false;
  InstancePlace place = placeOf(source.y);
  Corners corners;
  vec3 world[3];
  corners.count = (kAnyFeatures & FEATURE_SOLID) == 0u ? 3u : cornersOf(surfaceFeatures);
  uint first = firstIndexOf(draw, corners.count, source.x & 0x7fffffffu);
  corners.first = kCorners ? cornerOf(draw, source.y, 0u) : 0u;
  for (uint i = 0u; i < 3u; ++i) {
    corners.vertices[i] = indices[first + (i < corners.count ? i : 0u)];
    if (kNeedsPlaces) {
      vec4 local = vec4(positionOf(draw, corners.vertices[i]), 1.0);
      world[i] = vec3(dot(place.row0, local), dot(place.row1, local), dot(place.row2, local));
    }
    corners.clip[i] = kCorners ? cornerPlaces[corners.first + corners.vertices[i]].xyw
                               : (frame.viewProjection * vec4(world[i], 1.0)).xyw;
  }
  vec3 weights = weightsAt(corners, (vec2(pixel) + 0.5) * 2.0 / size - 1.0, size);
  inPosition = kNeedsPlaces ? mat3(world[0], world[1], world[2]) * weights : frame.eye.xyz - wayToEye(pixel);
  if (has(FEATURE_FLAT)) surfacePlane = cross(world[1] - world[0], world[2] - world[0]);
  if (has(FEATURE_VERTEX_COLOR)) {
    inColor = vec4(0.0);
    for (uint i = 0u; i < 3u; ++i) inColor += weights[i] * colorOf(draw, corners.vertices[i]);
  }
  if (has(SURFACE_TEXTURES)) setTexCoords(draw, corners, weights, pixel, size);
  if (!has(FEATURE_UNLIT)) setDirections(draw, place, corners, weights);
  return shadeSurface();
}

#endif
