// Tinted glass: a filter for what is behind it, and what it reflects itself. Both carry the number of their pane.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/collect.glsl"
#include "scene.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 place;
layout(location = 2) flat in int axis;
layout(location = 3) flat in int pane;

const vec3 kTints[3] = vec3[3](vec3(0.60, 0.90, 0.95), vec3(0.98, 0.86, 0.52), vec3(0.96, 0.64, 0.76));

void main() {
  vec3 ray = normalize(position - SCENE_EYE);
  vec3 normal = vec3(0.0);
  normal[axis] = -sign(ray[axis]);
  float facing = -dot(ray, normal);
  float reflectance = 0.04 + 0.96 * pow(1.0 - facing, 5.0); // Schlick's approximation
  float rim = step(0.965, max(abs(place.x), abs(place.y)));  // the ground edge of the pane
  reflectance = mix(reflectance, 0.55, rim);
  vitrailCollectWord(vec4(kTints[axis], 1.0), VITRAIL_MULTIPLY, uint(pane));
  vec3 sky = skyColor(reflect(ray, normal));
  vitrailCollectWord(vec4(reflectance * sky, reflectance), VITRAIL_PREMULTIPLIED, uint(pane));
}
