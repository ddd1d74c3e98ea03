// After the fragments have been collected: how much the passes behind have to do. One invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "arguments.glsl"

layout(local_size_x = 1) in;

void main() { writeArguments(); }
