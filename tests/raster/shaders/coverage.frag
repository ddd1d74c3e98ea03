// Adds each triangle that touches a pixel to the pixel's sum, as PixelSum::add() in coverage.h does.
#version 460

layout(location = 0) flat in uint triangle;
layout(binding = 0, std430) buffer Sums { uint sums[]; }; // count and hash of each pixel
layout(push_constant) uniform Constants { uint width; };

void main() {
  uint covered = uint(gl_SampleMaskIn[0]);
  uint h = triangle * 0x9e3779b1u + covered * 0x85ebca6bu;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  uint pixel = uint(gl_FragCoord.y) * width + uint(gl_FragCoord.x);
  atomicAdd(sums[2 * pixel], 1);
  atomicAdd(sums[2 * pixel + 1], h ^ h >> 13);
}
