// A triangle over the whole picture at one depth.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "opaque.h"

layout(push_constant) uniform Constants { OpaqueConstants opaque; };

void main() {
  vec2 corner = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, opaque.depth, 1.0);
}
