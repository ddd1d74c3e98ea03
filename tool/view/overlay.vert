// What Dear ImGui draws: triangles in pixels.
#version 460

layout(push_constant) uniform Constants {
  vec2 scale;
  vec2 offset;
} constants;

layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texCoord;
layout(location = 2) in vec4 color;

layout(location = 0) out vec2 outTexCoord;
layout(location = 1) out vec4 outColor;

void main() {
  outTexCoord = texCoord;
  outColor = color;
  gl_Position = vec4(position * constants.scale + constants.offset, 0.0, 1.0);
}
