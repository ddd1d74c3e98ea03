// The fragment resolve. Lists of up to 16 fragments are sorted here, longer ones lie sorted (sort_long.comp). One of
//   (nothing)              one sample: blended over what is there
//   VITRAIL_PER_SAMPLE     one invocation a sample: likewise
//   VITRAIL_MULTISAMPLED   one invocation a pixel: written, from the multisampled opaque colour
// and for the first two VITRAIL_DUAL_SOURCE: with a transmittance for each channel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "missing.glsl"
#include "list/walk.glsl"
#include "sink/samples.glsl"
#include "sink/blend.glsl"
#include "list/capped.glsl"
#include "list/long.glsl"
#include "list/sums.glsl"

// Else the counters would be written for what the stencil mark rejects.
layout(early_fragment_tests) in;

#ifdef VITRAIL_DUAL_SOURCE
layout(location = 0, index = 0) out vec4 outColor;
layout(location = 0, index = 1) out vec4 outTransmittance;
#else
layout(location = 0) out vec4 outColor;
#endif

VitrailSink resolveList(uint head) {
  if (kCapped) return vitrailCapped(head, nodesInUse());
  VitrailWalk walk = VitrailWalk(head, 0u, nodesInUse());
  VitrailSink r = vitrailShort(walk);
  if (r.complete) return r;
  r = vitrailSortedList(head, nodesInUse());
  if (!r.complete) atomicAdd(vitrailControl.cutPixels, 1u);
  return r;
}

// Whether one number is the transmittance of all channels.
bool isGrey(VitrailPair pair) { return pair.transmittance.rgb == vec3(pair.transmittance.a); }

void writeResult(VitrailSink r) {
#if defined(VITRAIL_MULTISAMPLED)
  precise vec4 sum = vec4(0.0);
#define VITRAIL_ADD_SAMPLE(s) if (s < kSamples) sum += over(r.pairs[s], texelFetch(opaqueImage, shownPixel, s));
  VITRAIL_EACH_SAMPLE(VITRAIL_ADD_SAMPLE)
  outColor = sum / float(kSamples);
#else
  VitrailPair pair = r.pairs[0];
  outColor = vec4(pair.color, 1.0 - pair.transmittance.a);
#ifdef VITRAIL_DUAL_SOURCE
  outTransmittance = pair.transmittance;
#else
  if (isGrey(pair)) return;
  outColor.a = 1.0 - dot(pair.transmittance.rgb, vec3(1.0 / 3.0));
  atomicAdd(vitrailControl.approximatePixels, 1u);
#endif
#endif
}

void main() {
  uvec2 pixel = uvec2(gl_FragCoord.xy);
  uvec2 local = pixel - uvec2(vitrailParameters.x, vitrailParameters.y);
  uint pixelIndex = pixelIndexOf(local);
  uint head = vitrailHeads[pixelIndex];
  VitrailSink r = vitrailBegin();
#ifdef VITRAIL_MULTISAMPLED
  shownPixel = ivec2(pixel);
#else
  if (head == VITRAIL_END && !overflowed()) discard;
#endif
  if (overflowed()) {
    // Mesa's CPU driver lets discarded invocations run on, and they read zeros: a list of those does not end.
    if (vitrailParameters.keepSums == 0u) {
      discard;
    } else {
      r = vitrailSummed(head, nodesInUse(), readMissing(pixelIndex));
    }
  } else if (head != VITRAIL_END) {
    r = resolveList(head);
  }
  writeResult(r);
}
