// Instance 0 is a wide floor; the nine after it are square panes, three across each axis, each cutting through six
// others.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"

layout(location = 0) out vec3 position;
layout(location = 1) out vec2 place; // in the square, -1 to 1
layout(location = 2) flat out int axis;
layout(location = 3) flat out int pane; // 0 to 8; -1 is the floor

void main() {
  pane = gl_InstanceIndex - 1;
  axis = pane < 0 ? 1 : pane / 3;
  place = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0;
  position[axis] = pane < 0 ? -1.0 : 0.62 * float(pane % 3 - 1);
  position[(axis + 1) % 3] = place.x * (pane < 0 ? 60.0 : 1.0);
  position[(axis + 2) % 3] = place.y * (pane < 0 ? 60.0 : 1.0);
  gl_Position = toClip(position);
}
