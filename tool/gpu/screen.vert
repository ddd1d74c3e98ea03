// One triangle over the whole viewport, at the far plane: for shaders that run once a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/glsl.h"

void main() {
  vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
