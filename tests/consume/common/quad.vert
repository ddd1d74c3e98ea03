// One rectangle of the scene, as a strip of four corners.
#version 460

layout(push_constant) uniform Quad {
  vec4 edges;  // left, top, right, bottom in clip space
  vec4 color;  // linear, straight alpha
  vec2 depths; // at the left and the right edge
};

void main() {
  bool right = (gl_VertexIndex & 1) != 0;
  bool bottom = (gl_VertexIndex & 2) != 0;
  gl_Position = vec4(right ? edges.z : edges.x, bottom ? edges.w : edges.y, right ? depths.y : depths.x, 1.0);
}
