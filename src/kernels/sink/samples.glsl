// The opaque scene behind the lists, sample by sample, and which samples a fragment adds to. VITRAIL_MULTISAMPLED is
// defined where one invocation handles all samples of a pixel, VITRAIL_PER_SAMPLE where it handles one of them, and
// then VITRAIL_TEST_DEPTH where their depth may have to be tested.
#ifndef VITRAIL_SAMPLES_GLSL
#define VITRAIL_SAMPLES_GLSL

#ifndef VITRAIL_OPENGL
#extension GL_EXT_samplerless_texture_functions : require
#endif

#include "target.glsl"

#if defined(VITRAIL_MULTISAMPLED) || defined(VITRAIL_TEST_DEPTH)
layout(VITRAIL_BOUND(1, VITRAIL_VIEW_BINDING_DEPTH)) uniform VITRAIL_TEXTURE_MS depthImage;

// Whether a fragment lies behind the opaque scene at a sample, both rounded alike.
bool isHidden(uvec4 key, ivec2 pixel, int number) {
  float behind = texelFetch(depthImage, pixel, number).r;
  return vitrailKeyDepth(key, vitrailNodes()) > vitrailDepthOrder(behind, vitrailNodes());
}
#endif

#ifdef VITRAIL_MULTISAMPLED
#define VITRAIL_ACCUMULATORS 8
layout(VITRAIL_BOUND(1, VITRAIL_VIEW_BINDING_OPAQUE)) uniform VITRAIL_TEXTURE_MS opaqueImage;

ivec2 shownPixel = ivec2(0); // the pixel that this invocation resolves

uint vitrailVisible(uvec4 key) {
  uint coverage = vitrailKeyCoverage(key, vitrailNodes());
  if (!kTestDepth) return coverage;
  for (int s = 0; s < 8; ++s) {
    if (s < int(kSamples) && isHidden(key, shownPixel, s)) coverage &= ~(1u << s);
  }
  return coverage;
}

#else
#define VITRAIL_ACCUMULATORS 1
#ifdef VITRAIL_NO_IMAGE_LOADS // for APIs that do not read the image that is written: what is behind, in a copy
layout(VITRAIL_BOUND(1, VITRAIL_VIEW_BINDING_OPAQUE)) uniform texture2D opaqueImage;
#endif
#ifdef VITRAIL_PER_SAMPLE
uint vitrailVisible(uvec4 key) {
  bool covered = (vitrailKeyCoverage(key, vitrailNodes()) & (1u << gl_SampleID)) != 0u;
#ifdef VITRAIL_TEST_DEPTH
  covered = covered && !isHidden(key, ivec2(gl_FragCoord.xy), gl_SampleID);
#endif
  return covered ? 1u : 0u;
}
#else
uint vitrailVisible(uvec4 key) { return 1u; }
#endif
#endif

// What is seen of the opaque colour d, premultiplied, through a list: C + T * d. `precise`, as the sums over samples
// are: compilers know several orders, which round differently.
vec4 over(VitrailPair pair, vec4 d) {
  precise vec3 color = pair.color + pair.transmittance.rgb * d.rgb;
  // d.a + (1 - d.a) * (1 - T), without the rounding that would move an opaque 1
  precise float alpha = 1.0 - pair.transmittance.a * (1.0 - d.a);
  return vec4(color, alpha);
}

#endif
