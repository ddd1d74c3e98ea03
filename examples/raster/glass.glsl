// The glass of examples/minimal as a host of vitrail/raster.glsl: where the corners of the panes are, and what a pane
// does to light. CMakeLists.txt compiles it once for each stage.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#define VITRAIL_RASTER_FRAGMENTS 2
#define VITRAIL_COLOR_FORMAT rgba32f
#include "vitrail/raster.glsl"
#include "scene.glsl" // of examples/minimal

// In the square of a pane, -1 to 1: two triangles, without indices.
vec2 placeOf(uint vertex) {
  const uint corners[6] = uint[6](0u, 1u, 2u, 2u, 1u, 3u);
  uint corner = corners[vertex];
  return vec2(corner & 1u, corner >> 1) * 2.0 - 1.0;
}

// As scene.vert of examples/minimal, whose instance 0 is the floor.
vec3 positionOf(uint instance, vec2 place) {
  uint pane = instance - 1u;
  uint axis = pane / 3u;
  vec3 position;
  position[axis] = 0.62 * (float(pane % 3u) - 1.0);
  position[(axis + 1u) % 3u] = place.x;
  position[(axis + 2u) % 3u] = place.y;
  return position;
}

vec4 vitrailPosition(VitrailVertex vertex) { return toClip(positionOf(vertex.instance, placeOf(vertex.vertex))); }

// Only the stages that blend have what it takes.
#if VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_BLEND || VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_BLEND_DEEP
const vec3 kTints[3] = vec3[3](vec3(0.60, 0.90, 0.95), vec3(0.98, 0.86, 0.52), vec3(0.96, 0.64, 0.76));

// As glass.frag of examples/minimal: what the pane reflects, and behind that a filter.
VitrailFragments vitrailShadeTwice(VitrailSurface surface) {
  vec2 place = vec2(0.0);
  for (int i = 0; i < 3; ++i) place += surface.weights[i] * placeOf(surface.vertices[i]);
  uint axis = (surface.instance - 1u) / 3u;
  vec3 ray = normalize(positionOf(surface.instance, place) - SCENE_EYE);
  vec3 normal = vec3(0.0);
  normal[axis] = -sign(ray[axis]);
  float facing = -dot(ray, normal);
  float reflectance = 0.04 + 0.96 * pow(1.0 - facing, 5.0); // Schlick's approximation
  float rim = step(0.965, max(abs(place.x), abs(place.y)));  // the ground edge of the pane
  reflectance = mix(reflectance, 0.55, rim);
  VitrailFragments fragments;
  fragments.count = 2u;
  fragments.colors[0] = vec4(reflectance * skyColor(reflect(ray, normal)), reflectance);
  fragments.blends[0] = VITRAIL_PREMULTIPLIED;
  fragments.colors[1] = vec4(kTints[axis], 1.0);
  fragments.blends[1] = VITRAIL_MULTIPLY;
  return fragments;
}
#endif
