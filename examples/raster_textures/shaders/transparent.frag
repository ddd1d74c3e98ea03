// The transparent surfaces as a fragment shader, for --lists: what a renderer has, with the last line for Vitrail.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 1
#include "vitrail/collect.glsl"
#include "scene.glsl"
#include "material.glsl"

layout(push_constant) uniform DrawBlock { uint material; };

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texCoord;

void main() {
  Point point = Point(position, normal, texCoord, dFdxFine(texCoord), dFdyFine(texCoord), gl_FrontFacing);
  vitrailCollect(materialColor(material, point));
}
