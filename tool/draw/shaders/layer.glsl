// One surface at one pixel as one layer: what it does to the light d behind it is color + through * d. A transmissive
// surface's reflection and filter are both in it. Included by the fragment shaders of the methods that keep layers.
#ifndef VITRAIL_TOOL_LAYER_GLSL
#define VITRAIL_TOOL_LAYER_GLSL

#include "surface.glsl"

struct Layer {
  vec3 color;   // linear, premultiplied
  vec4 through; // a: for the picture's alpha, whose part of color is 1 - through.a
};

// What images of 16-bit floats keep of a layer: there the opacity of a thin one is finer than what it lets through.
vec4 opacityOf(Layer layer) { return 1.0 - layer.through; }

const float LARGEST_HALF = 65504.0;

Layer layerOf(Surface surface) {
  if (!has(FEATURE_TRANSMISSION)) {
    // An infinite colour would turn into NaN where it is covered.
    vec3 color = min(surface.alpha * surface.color, LARGEST_HALF);
    return Layer(color, vec4(has(FEATURE_ADDITIVE) ? 1.0 : 1.0 - surface.alpha));
  }
  vec4 reflection = reflectionOf(surface);
  vec4 through = filterOf(surface);
  float passes = 1.0 - reflection.a; // a filter leaves the picture's alpha
  return Layer(min(reflection.rgb, LARGEST_HALF), vec4(passes * mix(vec3(1.0), through.rgb, through.a), passes));
}

// Whether a fragment is discarded after it has been shaded: its neighbours take derivatives of what textures are
// sampled with. What samples none is discarded first, and costs no shading.
bool shadesFirst() { return (kFeatures & ((1u << SLOT_COUNT) - 1u)) != 0u; }

#endif
