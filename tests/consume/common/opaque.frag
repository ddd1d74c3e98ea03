// The opaque rectangle.
#version 460

layout(push_constant) uniform Quad {
  vec4 edges;
  vec4 color;
  vec2 depths;
};

layout(location = 0) out vec4 outColor;

void main() { outColor = vec4(color.rgb, 1.0); }
