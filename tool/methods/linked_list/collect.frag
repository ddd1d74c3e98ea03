// Transparent surfaces: each fragment goes on its pixel's list.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifndef VITRAIL_OPENGL // where the host's text has the library's before this one
#define VITRAIL_SET 2
#ifndef VITRAIL_BUFFER_REFERENCE // only a CPU driver is not given it (gpu/features.cpp)
#define VITRAIL_CPU_DRIVER
#endif
#include "vitrail/collect.glsl"
#endif

#ifdef COLLECT_INSTANCE // fragments say of which instance they are, opaque ones too
#include "render/pick_shared.h"
layout(location = 15) flat in uint inObject;
CONSTANT(2, bool kOpaque, false)
#endif
#ifdef COLLECT_MEDIA // the resolve follows light through objects
#define SURFACE_TRUE_PATH
#include "media_shared.h"
layout(location = 15) flat in uint inObject;
#endif
#include "stage/surface.glsl"

// Whether depths follow from gl_FragCoord.w: with a perspective camera.
CONSTANT(1, bool kDepthFromW, false)

void collect(vec4 color, uint blend, uint word) {
  float depth = kDepthFromW ? fma(gl_FragCoord.w, frame.depth.y, frame.depth.x) : gl_FragCoord.z;
  vitrailCollect(color, blend, depth, word);
}
#ifdef COLLECT_INSTANCE
void collect(vec4 color, uint blend) { collect(color, blend, inObject | (kOpaque ? PICK_OPAQUE : 0u)); }
#else
void collect(vec4 color, uint blend) { collect(color, blend, 0u); }
#endif

#ifdef COLLECT_MEDIA
// A surface that encloses a volume: both fragments say of which object they are. The filter is stored whatever it does:
// the tint's share is in its colour, so that its alpha is 1.
void collectSolid(Surface surface) {
  uint object = MEDIA_OBJECT * (inObject + 1u);
  vec4 through = filterOf(surface);
  collect(reflectionOf(surface), VITRAIL_PREMULTIPLIED, object);
  collect(vec4(mix(vec3(1.0), through.rgb, through.a), 1.0), VITRAIL_MULTIPLY,
          object | MEDIA_SURFACE | (gl_FrontFacing ? MEDIA_FRONT : 0u));
}
#endif

void main() {
  Surface surface = shadeSurface();
#ifdef COLLECT_INSTANCE
  if (kOpaque) {
    collect(vec4(surface.color, 1.0), VITRAIL_OVER);
    return;
  }
#endif
#ifdef COLLECT_MEDIA
  if (isSolid()) {
    collectSolid(surface);
    return;
  }
#endif
  if (has(FEATURE_TRANSMISSION)) {
    collect(reflectionOf(surface), VITRAIL_PREMULTIPLIED);
    collect(filterOf(surface), VITRAIL_MULTIPLY);
  } else {
    collect(vec4(surface.color, surface.alpha), has(FEATURE_ADDITIVE) ? VITRAIL_ADDITIVE : VITRAIL_OVER);
  }
}
