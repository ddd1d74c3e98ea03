// The translucent rectangles: what a host's fragment shader becomes.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/collect.glsl"

layout(push_constant) uniform Quad {
  vec4 edges;
  vec4 color;
  vec2 depths;
};

void main() { vitrailCollect(color); }
