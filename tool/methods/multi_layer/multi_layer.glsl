// A layer of the method multi-layer: where it begins, and what it does to the light behind it. Included by the shader
// of the surfaces and the composite.
#ifndef VITRAIL_TOOL_MULTI_LAYER_GLSL
#define VITRAIL_TOOL_MULTI_LAYER_GLSL

#include "stage/surface_shared.h"

struct Layer {
  float depth; // nearest is 1; negative: the layer is empty
  vec3 color;
  vec4 transmittance;
};

const uint LAYER_WORDS = 5u; // in memory; the depth's is 0 where the layer is empty

void packLayer(Layer layer, out uint words[LAYER_WORDS]) {
  vec3 color = min(layer.color, LARGEST_HALF);
  words[0] = layer.depth < 0.0 ? 0u : floatBitsToUint(layer.depth) + 1u;
  words[1] = packHalf2x16(color.rg);
  words[2] = packHalf2x16(vec2(color.b, layer.transmittance.r));
  words[3] = packHalf2x16(layer.transmittance.gb);
  words[4] = packHalf2x16(vec2(layer.transmittance.a, 0.0));
}

Layer unpackLayer(uint words[LAYER_WORDS]) {
  vec2 middle = unpackHalf2x16(words[2]);
  Layer layer;
  layer.depth = words[0] == 0u ? -1.0 : uintBitsToFloat(words[0] - 1u);
  layer.color = vec3(unpackHalf2x16(words[1]), middle.x);
  layer.transmittance = vec4(middle.y, unpackHalf2x16(words[3]), unpackHalf2x16(words[4]).x);
  return layer;
}

// `behind` under `layer`, at its depth.
Layer mergedLayers(Layer layer, Layer behind) {
  return Layer(layer.depth, layer.color + layer.transmittance.rgb * behind.color,
               layer.transmittance * behind.transmittance);
}

#endif
