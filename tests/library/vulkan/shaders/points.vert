// Puts one point, a fragment of the caller's choosing, on one pixel.
#version 460

layout(location = 0) in vec3 position; // clip space
layout(location = 1) in vec4 color;    // linear
layout(location = 2) in uint blend;
layout(location = 3) in uint word;
layout(location = 0) flat out vec4 outColor;
layout(location = 1) flat out uint outBlend;
layout(location = 2) flat out uint outWord;

void main() {
  gl_Position = vec4(position, 1.0);
  gl_PointSize = 1.0;
  outColor = color;
  outBlend = blend;
  outWord = word;
}
