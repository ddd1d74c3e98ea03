// A chequered floor that is darker below the cube and fades into the distance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"

layout(location = 0) in vec3 position;
layout(location = 0) out vec4 outColor;

void main() {
  vec2 square = floor(position.xz * 2.0);
  vec3 color = mod(square.x + square.y, 2.0) < 0.5 ? vec3(0.74, 0.72, 0.68) : vec3(0.28, 0.29, 0.32);
  float away = length(max(abs(position.xz) - 0.8, 0.0));
  color *= mix(0.55, 1.0, smoothstep(0.0, 1.2, away));
  color = mix(color, SCENE_HORIZON, smoothstep(3.0, 16.0, distance(position, SCENE_EYE) - 4.0));
  outColor = vec4(color, 1.0);
}
