// One surface at one pixel as one layer, which is its SurfaceLight. Included by the fragment shaders of the methods
// that keep layers in images.
#ifndef VITRAIL_TOOL_LAYER_GLSL
#define VITRAIL_TOOL_LAYER_GLSL

#include "stage/surface_light.glsl"

// What images of 16-bit floats keep of a layer: there the opacity of a thin one is finer than what it lets through.
vec4 opacityOf(SurfaceLight light) { return 1.0 - light.transmittance; }

// Whether a fragment is discarded after it has been shaded: its neighbours take derivatives of what textures are
// sampled with. What samples none is discarded first, and costs no shading.
bool shadesFirst() { return (kFeatures & ((1u << SLOT_COUNT) - 1u)) != 0u; }

#endif
