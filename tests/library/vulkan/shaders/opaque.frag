// One colour.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "opaque.h"

layout(push_constant) uniform Constants { OpaqueConstants opaque; };
layout(location = 0) out vec4 outColor;

void main() { outColor = opaque.color; }
