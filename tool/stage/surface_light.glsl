// What a surface does to the light d behind it, the reflection and the filter of a transmissive one together: color +
// transmittance * d. The fourth component is for the picture's alpha, to which the surface adds 1 - transmittance.a.
#ifndef VITRAIL_TOOL_SURFACE_LIGHT_GLSL
#define VITRAIL_TOOL_SURFACE_LIGHT_GLSL

#include "surface.glsl"

struct SurfaceLight {
  vec3 color;         // all that comes from the surface itself, premultiplied
  vec4 transmittance; // equal in all channels unless the surface has FEATURE_ADDITIVE or FEATURE_TRANSMISSION
  vec3 body;          // the part of `color` that goes with hiding what is behind: opacity times the surface's colour
};

SurfaceLight lightOf(Surface surface) {
  vec3 color = min(surface.color, LARGEST_HALF); // an infinite one would turn into NaN
  SurfaceLight light;
  light.color = surface.alpha * color;
  light.transmittance = vec4(1.0 - surface.alpha);
  light.body = light.color;
  if (has(FEATURE_ADDITIVE)) {
    light.transmittance = vec4(1.0);
    light.body = vec3(0.0);
  }
  if (has(FEATURE_TRANSMISSION)) {
    float opacity = reflectionOf(surface).a;
    vec4 through = filterOf(surface);
    light.transmittance = (1.0 - opacity) * vec4(mix(vec3(1.0), through.rgb, through.a), 1.0);
    light.body = opacity * color;
  }
  return light;
}

// How far the fragment is from the camera's plane.
float viewDepth() { return dot(frame.eye.xyz - inPosition, frame.cameraToWorld[2].xyz); }

#endif
