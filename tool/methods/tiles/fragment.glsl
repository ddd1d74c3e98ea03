// Shades a surface at a pixel: what the vertex shader and interpolation hand to surface.glsl, from the vertices of its
// triangle.
#ifndef VITRAIL_TOOL_TILES_FRAGMENT_GLSL
#define VITRAIL_TOOL_TILES_FRAGMENT_GLSL

#include "geometry.glsl"

#define SURFACE_OF_DRAWS
#include "stage/surface.glsl"

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
void setTexCoords(VitrailSurface at) {
  mat3x4 uv;
  for (uint i = 0u; i < 3u; ++i) uv[i] = texCoordsOf(at.draw, at.vertices[i]);
  surfaceTexCoords = uv * at.weights;
  vec3 right, down;
  vitrailDerivatives(at, right, down);
  surfaceTexCoordsRight = uv * right;
  surfaceTexCoordsDown = uv * down;
}

void setDirections(VitrailSurface at, InstancePlace place) {
  InstanceTurn turn = turnOf(place);
  if (!has(FEATURE_FLAT)) {
    vec3 normal = vec3(0.0);
    if (VITRAIL_RASTER_POSITIONS) {
      for (uint i = 0u; i < 3u; ++i) normal += at.weights[i] * normalsInWorld[at.places[i]].xyz;
      inNormal = normal;
    } else {
      for (uint i = 0u; i < 3u; ++i) normal += at.weights[i] * normalOf(at.draw, at.vertices[i]);
      inNormal = turnedNormal(turn, normal);
    }
  }
  if (hasTexture(SLOT_NORMAL) || has(FEATURE_RARE)) {
    vec4 tangent = vec4(0.0);
    for (uint i = 0u; i < 3u; ++i) tangent += at.weights[i] * tangentOf(at.draw, at.vertices[i]);
    inTangent = vec4(tangent.xyz * turn.rows, tangent.w * turn.mirrored);
  } else {
    inTangent.w = turn.mirrored;
  }
  if (has(FEATURE_VOLUME)) {
    inTangent.w = abs(inTangent.w) * turn.size * pow(abs(turn.volume), 1.0 / 3.0) * sign(inTangent.w);
  }
}

// Where a surface is only matters to lights that are near, and to planes; else only from where it is seen.
const bool kNeedsPlaces = (kAnyFeatures & (FEATURE_LIGHTS | FEATURE_FLAT)) != 0u;

// From a surface at the pixel to the eye, of any length.
vec3 pixelToEye(ivec2 pixel) {
  vec2 at = vec2(pixel) + 0.5;
  vec3 ray = vec3(at.x * frame.ray.x - frame.ray.z, frame.ray.w - at.y * frame.ray.y, -1.0);
  return -(mat3(frame.cameraToWorld) * ray);
}

Surface shadeFragment(VitrailSurface at) {
  surfaceFeatures = draws[at.draw].features;
  surfaceMaterial = draws[at.draw].materialNumber;
  surfaceDraw = at.draw;
  surfaceFront = at.front;
  surfaceCut = false;
  InstancePlace place = placeOf(at.instance);
  vec3 world[3];
  if (kNeedsPlaces) {
    for (uint i = 0u; i < 3u; ++i) {
      vec4 local = vec4(positionOf(at.draw, at.vertices[i]), 1.0);
      world[i] = vec3(dot(place.row0, local), dot(place.row1, local), dot(place.row2, local));
    }
  }
  // Not by way of a place where only the way counts: the eye may be so far away that it would be rounded off.
  if (kNeedsPlaces) inPosition = mat3(world[0], world[1], world[2]) * at.weights;
  surfaceToEye = kNeedsPlaces ? frame.eye.xyz - inPosition : pixelToEye(at.pixel);
  if (has(FEATURE_FLAT)) surfacePlane = normalOfPlane(world[1] - world[0], world[2] - world[0]);
  if (has(FEATURE_VERTEX_COLOR)) {
    inColor = vec4(0.0);
    for (uint i = 0u; i < 3u; ++i) inColor += at.weights[i] * colorOf(at.draw, at.vertices[i]);
  }
  if (has(SURFACE_TEXTURES)) setTexCoords(at);
  if (!has(FEATURE_UNLIT)) setDirections(at, place);
  return shadeSurface();
}

#endif
