// The fragment resolve into one sample of a frame without a fragment: the average of the opaque samples, to the bit as
// resolve.frag has it for a pixel without a list. Drawn indirectly, without vertices where the frame has fragments.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_MULTISAMPLED
#include "sink/samples.glsl"

layout(location = 0) out vec4 outColor;

void main() {
  vec4 sum = vec4(0.0);
  for (int s = 0; s < int(kSamples); ++s) {
    vec4 opaque = texelFetch(opaqueImage, ivec2(gl_FragCoord.xy), s);
    precise float alpha = 1.0 - (1.0 - opaque.a);
    sum += vec4(opaque.rgb, alpha);
  }
  outColor = sum / float(kSamples);
}
