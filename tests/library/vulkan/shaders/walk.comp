// Writes the fragments of every pixel in order, up to MOST_LAYERS of them: what a host does with vitrail/list.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/list.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const uint MOST_LAYERS = 256u; // kMostLayers of walk_test.cpp

layout(push_constant) uniform Push {
  uint width;
  uint height;
};

struct Walked {
  uint count;
  uint cut;
  uint unused[2];
  VitrailLayer layers[MOST_LAYERS];
};

layout(set = 1, binding = 0, std430) buffer WalkedBlock { Walked walked[]; };

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (pixel.x >= width || pixel.y >= height) return;
  uint place = pixel.y * width + pixel.x;
  VitrailList list = vitrailOpenList(ivec2(pixel));
  VitrailLayer layer;
  uint count = 0u;
  while (vitrailNextLayer(list, layer)) {
    if (count < MOST_LAYERS) walked[place].layers[count] = layer;
    ++count;
  }
  walked[place].count = count;
  walked[place].cut = vitrailListWasCut(list) ? 1u : 0u;
}
