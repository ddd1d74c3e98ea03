// The resolve of scenes whose objects absorb light, in place of the library's: one thread a pixel walks the sorted list
// front to back, keeps the absorption of all objects that the ray is inside of, and weakens what comes next by the way
// from the last fragment to it. docs/shading.md, "Volume", has the rules.
//
// MEDIA_SAMPLES is the number of samples a pixel has at most, 1 or 8.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#ifndef VITRAIL_OPENGL // where the host's text has the library's before this one
#define VITRAIL_SET 0
#define VITRAIL_SORTED_LISTS
#include "vitrail/list.glsl"
#endif

#include "gpu/pixel_pass_shared.h"
#include "media_shared.h"

#ifndef MEDIA_SAMPLES
#define MEDIA_SAMPLES 1
#endif

layout(local_size_x = PIXEL_GROUP_SIDE, local_size_y = PIXEL_GROUP_SIDE) in;

CONSTANT(0, uint kSamples, 1u)
CONSTANT(1, bool kTestDepth, false) // coverage has not passed the depth test
CONSTANT(2, bool kAnyNear, false)   // some object has MEDIA_NEAR

layout(BOUND(1, 0, 5), std430) readonly buffer ObjectsBlock { MediaObject objects[]; };
layout(BOUND(1, 1, 0), rgba16f) uniform image2D colorImage;
#if MEDIA_SAMPLES == 1
layout(BOUND(1, 2, 16)) uniform TEXTURE_2D depthImage;
#else
layout(BOUND(1, 2, 16)) uniform TEXTURE_2D_MS depthImage;
layout(BOUND(1, 3, 17)) uniform TEXTURE_2D_MS opaqueImage;
#endif
PUSHED ViewBlock { MediaView view; };

// What comes along the ray of one sample.
struct Light {
  vec3 color;         // that has reached the eye's side so far
  vec4 transmittance; // of what was passed; w: of the picture's alpha
  vec3 inside;        // the absorption of all objects that the ray is inside of,
  vec3 rest;          // and what rounding has left of it: enter() and leave by the same amount, and nothing stays
  float at;           // distance from the eye
};

float opaqueDepth(ivec2 pixel, int s) { return texelFetch(depthImage, pixel, s).r; }

// How much longer the ray of a pixel is than its view depth.
float stretchOf(ivec2 pixel) {
  vec2 at = vec2(pixel) + 0.5;
  return length(vec3(at.x * view.ray.x - view.ray.z, view.ray.w - at.y * view.ray.y, -1.0));
}

// The distance along the ray of what has a depth; infinite at a far plane that is.
float distanceOf(float depth, float stretch) {
  float viewDepth = view.depth.z > 0.5 ? (depth - view.depth.y) / view.depth.x : view.depth.y / (depth - view.depth.x);
  return viewDepth * stretch;
}

MediaObject objectOf(uint word) { return objects[word / MEDIA_OBJECT - 1u]; }
bool has(MediaObject object, uint what) { return (uint(object.absorption.w) & what) != 0u; }
bool enters(uint word, MediaObject object) { return ((word & MEDIA_FRONT) != 0u) != has(object, MEDIA_INWARD); }

// Adds to the absorption. What goes in comes out again to the bit, whatever else is added meanwhile (Knuth, The Art of
// Computer Programming, volume 2, 4.2.2, theorem B).
void add(inout Light light, vec3 absorption) {
  precise vec3 sum = light.inside + absorption;
  precise vec3 share = sum - light.inside;
  precise vec3 lost = (light.inside - (sum - share)) + (absorption - share);
  light.rest += lost;
  light.inside = sum;
}

// Follows the light on to a distance.
void follow(inout Light light, float to) {
  vec3 absorption = max(light.inside + light.rest, 0.0); // below 0 where surfaces that touch come in the wrong order
  float way = max(to - light.at, 0.0);
  if (absorption != vec3(0.0)) light.transmittance.rgb *= exp(-absorption * way);
  light.at = to;
}

// The samples where a layer is not behind an opaque surface.
uint samplesOf(VitrailLayer layer, VitrailList list, ivec2 pixel) {
  uint samples = layer.coverage;
  bool untested = kTestDepth || (kAnyNear && layer.word >= MEDIA_OBJECT && has(objectOf(layer.word), MEDIA_NEAR));
  if (!untested) return samples;
  for (int s = 0; s < MEDIA_SAMPLES; ++s) {
    if (s >= int(kSamples)) break;
    uint behind = vitrailDepthOrder(opaqueDepth(pixel, s), list.nodes);
    if (vitrailDepthOrder(layer.depth, list.nodes) > behind) samples &= ~(1u << s);
  }
  return samples;
}

// How often the ray of a sample begins inside of the next object after the one whose word is `last`.
int timesInside(ivec2 pixel, int s, uint last, out uint found) {
  found = 0xffffffffu;
  int balance = 0;
  VitrailList list = vitrailOpenList(pixel);
  VitrailLayer layer;
  while (vitrailNextLayer(list, layer)) {
    uint object = layer.word & ~(MEDIA_OBJECT - 1u);
    bool counts = (layer.word & MEDIA_SURFACE) != 0u && (layer.coverage & (1u << s)) != 0u;
    if (!counts || object <= last || object > found) continue;
    MediaObject medium = objectOf(object);
    if (!has(medium, MEDIA_NEAR)) continue;
    if (object < found) balance = 0;
    found = object;
    balance += enters(layer.word, medium) ? -1 : 1;
  }
  return balance;
}

// Light at the near plane, in what encloses it there.
Light begin(ivec2 pixel, int s, float stretch) {
  Light light = Light(vec3(0.0), vec4(1.0), vec3(0.0), vec3(0.0), distanceOf(1.0, stretch));
  uint last = kAnyNear ? 0u : 0xffffffffu;
  while (last != 0xffffffffu) {
    uint object;
    int times = timesInside(pixel, s, last, object);
    for (; times > 0; --times) add(light, objectOf(object).absorption.rgb);
    last = object;
  }
  return light;
}

void put(inout Light light, VitrailLayer layer, float at) {
  follow(light, at);
  VitrailPair pair = vitrailPairOf(layer);
  light.color += light.transmittance.rgb * pair.color;
  light.transmittance *= pair.transmittance;
  if ((layer.word & MEDIA_SURFACE) == 0u) return;
  MediaObject object = objectOf(layer.word);
  add(light, enters(layer.word, object) ? object.absorption.rgb : -object.absorption.rgb);
}

// The light of a sample, once it has come to the opaque surface or, where there is none, to the far plane.
vec4 finish(Light light, vec4 behind, float depth, float stretch) {
  float end = distanceOf(depth, stretch);
  if (!isinf(end)) follow(light, end);
  return vec4(light.color + light.transmittance.rgb * behind.rgb, 1.0 - light.transmittance.a * (1.0 - behind.a));
}

void resolve(ivec2 pixel) {
  float stretch = stretchOf(pixel);
  VitrailList list = vitrailOpenList(pixel);
#if MEDIA_SAMPLES == 1
  if (list.head == VITRAIL_END) return;
#endif
  Light lights[MEDIA_SAMPLES];
  for (int s = 0; s < MEDIA_SAMPLES; ++s) {
    if (s < int(kSamples)) lights[s] = begin(pixel, s, stretch);
  }
  VitrailLayer layer;
  while (vitrailNextLayer(list, layer)) {
    float at = distanceOf(layer.depth, stretch);
    uint samples = samplesOf(layer, list, pixel);
    for (int s = 0; s < MEDIA_SAMPLES; ++s) {
      if (s < int(kSamples) && (samples & (1u << s)) != 0u) put(lights[s], layer, at);
    }
  }
  if (vitrailListWasCut(list)) atomicAdd(vitrailControl.cutPixels, 1u);
#if MEDIA_SAMPLES == 1
  imageStore(colorImage, pixel, finish(lights[0], imageLoad(colorImage, pixel), opaqueDepth(pixel, 0), stretch));
#else
  vec4 sum = vec4(0.0);
  for (int s = 0; s < MEDIA_SAMPLES; ++s) {
    if (s < int(kSamples)) sum += finish(lights[s], texelFetch(opaqueImage, pixel, s), opaqueDepth(pixel, s), stretch);
  }
  imageStore(colorImage, pixel, sum / float(kSamples));
#endif
}

void main() {
  if (vitrailListsLackFragments()) return; // the picture is drawn again
  uvec2 local = gl_GlobalInvocationID.xy;
  if (local.x >= vitrailParameters.width || local.y >= vitrailParameters.height) return;
  resolve(ivec2(local + uvec2(vitrailParameters.x, vitrailParameters.y)));
}
