// Hands a triangle's corners on as they are, with its number.
#version 460

layout(location = 0) in vec4 position; // clip space
layout(location = 0) flat out uint triangle;

void main() {
  gl_Position = position;
  triangle = gl_VertexIndex / 3;
}
