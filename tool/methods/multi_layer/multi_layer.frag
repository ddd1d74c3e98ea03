// Transparent surfaces of the method multi-layer: a pixel's layers take in one fragment at a time, in the order of
// submission.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_fragment_shader_interlock : require
#include "multi_layer.glsl"
#include "stage/surface_light.glsl"

layout(early_fragment_tests) in;
layout(pixel_interlock_ordered) in;

layout(constant_id = 1) const uint kLayers = 4u;

layout(push_constant) uniform Extent {
  uint width;
  uint height;
};

layout(set = 2, binding = 0, std430) coherent buffer LayersBlock { uint layers[]; };

uint wordIndex(uint layer, uint word) {
  return (layer * LAYER_WORDS + word) * (width * height) + uint(gl_FragCoord.y) * width + uint(gl_FragCoord.x);
}

Layer load(uint layer) {
  uint words[LAYER_WORDS];
  for (uint i = 0u; i < LAYER_WORDS; ++i) words[i] = layers[wordIndex(layer, i)];
  return unpackLayer(words);
}

void store(uint layer, Layer value) {
  uint words[LAYER_WORDS];
  packLayer(value, words);
  for (uint i = 0u; i < LAYER_WORDS; ++i) layers[wordIndex(layer, i)] = words[i];
}

// The layers stay in order; what is behind the last one is merged into it. Equal depths: the earlier one is nearer.
void insert(Layer moving) {
  for (uint layer = 0u; layer < kLayers; ++layer) {
    Layer before = load(layer);
    if (moving.depth <= before.depth) continue;
    store(layer, moving);
    moving = before;
    if (moving.depth < 0.0) return;
  }
  store(kLayers - 1u, mergedLayers(load(kLayers - 1u), moving));
}

void main() {
  SurfaceLight light = lightOf(shadeSurface());
  Layer fragment = Layer(gl_FragCoord.z, light.color, light.transmittance);
  beginInvocationInterlockARB();
  insert(fragment);
  endInvocationInterlockARB();
}
