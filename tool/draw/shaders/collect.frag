// Transparent surfaces: each fragment goes on its pixel's list.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 2
#include "vitrail/collect.glsl"

#include "surface.glsl"

void main() { vitrailCollect(shadeSurface()); }
