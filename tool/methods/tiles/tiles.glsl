// The tool as a host of vitrail/raster.glsl: where the vertices of a scene's draws are, and how their surfaces look.
#version 460
#pragma shader_stage(compute)
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require

#define VITRAIL_SET 3
#define VITRAIL_RASTER_FRAGMENTS 2
#include "vitrail/raster.glsl"

#include "geometry.glsl"

vec4 vitrailPosition(VitrailVertex vertex) {
  InstancePlace place = placeOf(vertex.instance);
#if VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_POSITIONS
  if ((draws[vertex.draw].features & (FEATURE_UNLIT | FEATURE_FLAT)) == 0u) {
    normalsInWorld[vertex.place] = vec4(turnedNormal(turnOf(place), normalOf(vertex.draw, vertex.vertex)), 0.0);
  }
#endif
  vec4 clip = clipOf(worldOf(place, positionOf(vertex.draw, vertex.vertex)));
  if ((draws[vertex.draw].features & FEATURE_SOLID) == FEATURE_LINES)
    clip.xy += clip.w * frame.depth.zw; // surface.vert
  return clip;
}

#if VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_BLEND || VITRAIL_RASTER_STAGE == VITRAIL_RASTER_STAGE_BLEND_DEEP
#include "fragment.glsl"

// One step, or what is reflected and the filter for what is behind; none where a mask cuts the surface away.
VitrailFragments vitrailShadeTwice(VitrailSurface at) {
  Surface surface = shadeFragment(at);
  VitrailFragments f;
  f.count = surfaceCut ? 0u : 1u;
  f.colors[0] = vec4(surface.color, surface.alpha);
  f.blends[0] = has(FEATURE_ADDITIVE) ? VITRAIL_ADDITIVE : VITRAIL_OVER;
  f.colors[1] = vec4(0.0);
  f.blends[1] = VITRAIL_MULTIPLY;
  if (has(FEATURE_TRANSMISSION)) {
    f.colors[0] = reflectionOf(surface);
    f.blends[0] = VITRAIL_PREMULTIPLIED;
    f.colors[1] = filterOf(surface);
    f.count *= 2u;
  }
  return f;
}
#endif
