// The ball and the floor.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec4 outColor;

void main() {
  vec3 color = position.y > -0.99 ? vec3(0.75, 0.42, 0.18) : vec3(0.62);
  color *= SCENE_AMBIENT + 0.65 * max(dot(normalize(normal), SCENE_LIGHT), 0.0);
  outColor = vec4(mix(color, SCENE_HORIZON, smoothstep(3.0, 20.0, distance(position, SCENE_EYE))), 1.0);
}
