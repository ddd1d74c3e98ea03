// The smallest host shader there is.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/collect.glsl"

layout(location = 0) flat in vec4 color;
layout(location = 1) flat in uint blend;
layout(location = 2) flat in uint word;

void main() { vitrailCollectWord(color, blend, word); }
