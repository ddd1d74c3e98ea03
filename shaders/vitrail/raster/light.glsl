// Fragments of a pixel, nearest first, blended as they come: what of the light behind is left, and what has been added
// to it.
#ifndef VITRAIL_RASTER_LIGHT_GLSL
#define VITRAIL_RASTER_LIGHT_GLSL

// The nodes of linked-list that pictures are held to; of them the order at one depth.
#define VITRAIL_ONLY_FORMAT 2
#include "../node.glsl"

#include "surface.glsl"
#include "opaque.glsl"
#include "order.glsl"

#ifndef VITRAIL_COLOR_FORMAT
#define VITRAIL_COLOR_FORMAT rgba16f
#endif

#ifdef VITRAIL_MULTISAMPLED
layout(VITRAIL_RASTER_BOUND(9), VITRAIL_COLOR_FORMAT) uniform writeonly image2D vitrailColorImage;
layout(VITRAIL_RASTER_BOUND(18)) uniform texture2DMS vitrailOpaqueImage;

vec4 vitrailColorBehind(ivec2 pixel, uint sample_) { return texelFetch(vitrailOpaqueImage, pixel, int(sample_)); }
#else
layout(VITRAIL_RASTER_BOUND(9), VITRAIL_COLOR_FORMAT) uniform image2D vitrailColorImage;

vec4 vitrailColorBehind(ivec2 pixel, uint sample_) { return imageLoad(vitrailColorImage, pixel); }
#endif

// What fragments have added to a pixel so far, and what of the light behind still comes through at each sample. The
// picture is the mean of the samples, and a surface is shaded once for all that it covers, so what it adds to the mean
// is its colour times what comes through where it shows: the colours of single samples are never needed.
struct VitrailPixelLight {
  vec3 color;
#ifdef VITRAIL_MULTISAMPLED
  vec4 through[VITRAIL_RASTER_MOST_SAMPLES];
  float nearest; // opaque depth
#else
  vec4 through[1];
#endif
  float most; // the most light that anything behind the fragments may send
};

const VitrailLayout VITRAIL_TIE_NODES = VitrailLayout(VITRAIL_FORMAT_HDR, 1u, true);

// As nodes hold them: not negative, no infinite colours, NaN is 0.
vec4 vitrailStoredColor(vec4 color) {
  return vec4(min(max(color.rgb, 0.0), 65504.0), min(max(color.a, 0.0), 1.0));
}

const bool VITRAIL_ONE_BLEND = (VITRAIL_RASTER_BLENDS & (VITRAIL_RASTER_BLENDS - 1u)) == 0u; // mode for all

// What the host's shading says, with the blend mode of the draw where it leaves that to it.
VitrailFragments vitrailFragmentsOf(VitrailSurface surface) {
#if VITRAIL_RASTER_FRAGMENTS == 1
  VitrailFragments f;
  f.colors[0] = vitrailStoredColor(vitrailShade(surface));
  f.blends[0] = VITRAIL_ONE_BLEND ? uint(findLSB(VITRAIL_RASTER_BLENDS)) : vitrailBlendOf(surface.draw);
  bool shows = f.colors[0].a > 0.0;
  if (f.blends[0] == VITRAIL_PREMULTIPLIED) shows = shows || any(greaterThan(f.colors[0].rgb, vec3(0.0)));
  f.count = shows ? 1u : 0u;
#else
  VitrailFragments f = vitrailShadeTwice(surface);
  f.colors[0] = vitrailStoredColor(f.colors[0]);
  f.colors[1] = vitrailStoredColor(f.colors[1]);
#endif
  return f;
}

VitrailPixelLight vitrailLightBehind(ivec2 pixel) {
  VitrailPixelLight light;
  light.color = vec3(0.0);
  light.most = vitrailRaster.lightMost;
#ifdef VITRAIL_MULTISAMPLED
  light.nearest = vitrailOpaqueDepth(pixel, 0u);
  for (uint i = 1u; i < VITRAIL_RASTER_SAMPLES; ++i) light.nearest = max(light.nearest, vitrailOpaqueDepth(pixel, i));
#endif
  // What comes through to a background that is not opaque is missing in the picture's alpha, too, which is linear: as
  // much light counts 0.43958 times as much at least (vitrailHasEnough()).
#define VITRAIL_SET_SAMPLE(i) \
  light.through[i] = vec4(1.0); \
  if (i < VITRAIL_RASTER_SAMPLES && light.most >= 0.0) { \
    vec4 behind = vitrailColorBehind(pixel, i); \
    light.most = max(light.most, max(max(behind.r, behind.g), max(behind.b, (1.0 - behind.a) / 0.43958))); \
  }
  VITRAIL_EACH_SAMPLE(VITRAIL_SET_SAMPLE)
  return light;
}

// The samples at which a record's fragment shows, a bit each. `thread`: the pixel in its tile.
uint vitrailVisibleSamples(VitrailPixelLight light, uint record, ivec2 pixel, uint thread) {
#ifdef VITRAIL_MULTISAMPLED
  uint visible = vitrailCoveredSamples(record, thread);
  vec4 plane = uintBitsToFloat(vitrailRecords[vitrailRaster.recordCapacity + record]);
  float depth = fma(plane.y, float(thread & 7u), fma(plane.z, float(thread >> 3), plane.x));
  depth += vitrailDepthSlack(plane, pixel);
  if (depth - 0.5 * (abs(plane.y) + abs(plane.z)) >= light.nearest) return visible; // at no sample is it behind another
  for (uint i = 0u; i < VITRAIL_RASTER_SAMPLES; ++i) {
    float there = depth + dot(plane.yz, vec2(vitrailSamplePlace(i) - 8)) / 16.0;
    if (there < vitrailOpaqueDepth(pixel, i)) visible &= ~(1u << i);
  }
  return visible;
#else
  return 1u;
#endif
}

// What of the light behind comes through. Where all surfaces let the same of all colours through, one number is kept.
const bool VITRAIL_THROUGH_VARIES = (VITRAIL_RASTER_BLENDS & (1u << VITRAIL_ADDITIVE | 1u << VITRAIL_MULTIPLY)) != 0u;
#define VITRAIL_THROUGH(light, i) (VITRAIL_THROUGH_VARIES ? (light).through[i] : (light).through[i].aaaa)
#define VITRAIL_SHARE (1.0 / float(VITRAIL_RASTER_SAMPLES)) // of a sample in its pixel

void vitrailPutFragment(inout VitrailPixelLight light, vec4 color, uint blend, uint visible) {
  VitrailPair pair = vitrailPairOf(color, blend);
  vec3 through = vec3(0.0);
#define VITRAIL_PUT_SAMPLE(i) \
  if ((visible & (1u << i)) != 0u) { \
    through += VITRAIL_THROUGH(light, i).rgb; \
    light.through[i] *= pair.transmittance; \
    if (VITRAIL_THROUGH_VARIES) light.through[i] = min(light.through[i], 1e37); /* as lists: never infinite */ \
  }
  VITRAIL_EACH_SAMPLE(VITRAIL_PUT_SAMPLE)
  light.color += VITRAIL_SHARE * through * pair.color;
}

// Whether what is farther away than some fragments may be left out: whether that changes the picture by less than
// VITRAIL_RASTER_STOP of 1/255. What is left out is light of at most `most` together, or hides so much of what is
// behind. On the sRGB curve it counts most in the dark. Surfaces that add light without hiding as much have no such
// bound, nor has light that nobody knows (`most` is negative).
bool vitrailHasEnough(VitrailPixelLight light) {
  vec4 all = vec4(0.0);
#define VITRAIL_ADD_THROUGH(i) \
  if (i < VITRAIL_RASTER_SAMPLES) all += VITRAIL_THROUGH(light, i);
  VITRAIL_EACH_SAMPLE(VITRAIL_ADD_THROUGH)
  float through = VITRAIL_SHARE * max(max(all.r, all.g), max(all.b, all.a));
  if (VITRAIL_RASTER_BLENDS != 1u << VITRAIL_OVER || light.most < 0.0) return through <= 0.0;
  float darkest = min(light.color.r, min(light.color.g, light.color.b));
  if (darkest <= 1.0 && through * light.most * (0.43958 * 255.0) >= VITRAIL_RASTER_STOP) return false; // it is as steep
  float steepness = darkest > 0.0031308 ? 0.43958 * pow(min(darkest, 1.0), -0.58333) : 12.92;
  return through * light.most * steepness * 255.0 < VITRAIL_RASTER_STOP;
}

// The order at one depth: by what fragments are, as in fragment lists: how they are blended, their colours, and the
// samples that they cover. With these, in the lowest bits, the fragment's number.
uvec3 vitrailTieKey(vec4 color, uint blend, uint visible, uint number) {
  uvec4 node;
  vitrailPack(color, blend, 0.0, 1u, VITRAIL_TIE_NODES, node);
  return uvec3(blend << 16 | visible << 8 | number, node.xy);
}

bool vitrailLessKey(uvec3 a, uvec3 b) {
  if (a.x >> 16 != b.x >> 16) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z != b.z ? a.z < b.z : a.x < b.x;
}

// The i-th surface of those that have one depth, which the including shader has at hand: its record, and it, to be
// shaded. `alone`: it is the only one.
uint vitrailAlikeRecord(uint i);
VitrailSurface vitrailAlikeSurface(uint i, ivec2 pixel, bool alone);

// Blends them: one, or up to VITRAIL_RASTER_TIES in the order of what they are. Then each turn through all finds the
// next fragment, of which a surface has two at most, and shades it again: what would be kept of it takes registers, and
// few surfaces have the depth of others. What shades them stands here once, as it is what takes long.
void vitrailBlendAlike(inout VitrailPixelLight light, ivec2 pixel, uint thread, uint alike) {
  const uvec3 none = uvec3(0xffffffffu);
  uvec3 last = uvec3(0u);
  uvec3 next = none;
  bool isFound = alike == 1u;
  uint i = 0u;
  for (uint step = 0u; step < (2u * VITRAIL_RASTER_TIES + 1u) * (VITRAIL_RASTER_TIES + 1u); ++step) {
    uint visible = 1u;
    if (VITRAIL_RASTER_SAMPLES > 1u) visible = vitrailVisibleSamples(light, vitrailAlikeRecord(i), pixel, thread);
    if (visible != 0u) {
      VitrailFragments f = vitrailFragmentsOf(vitrailAlikeSurface(i, pixel, alike == 1u));
      // No loop: arrays stay in registers where their indices are constants.
#define VITRAIL_TAKE_FRAGMENT(k) \
  if (f.count > k) { \
    uint number = 2u * i + k + 1u; \
    if (isFound) { \
      if (alike == 1u) { \
        vitrailPutFragment(light, f.colors[k], f.blends[k], visible); \
      } else if ((next.x & 0xffu) == number) { \
        vec4 color = vitrailHdrColor(uvec4(0u, next.y, next.z, 0u)); /* as keys tell them apart */ \
        vitrailPutFragment(light, color, f.blends[k], visible); \
      } \
    } else { \
      uvec3 key = vitrailTieKey(f.colors[k], f.blends[k], visible, number); \
      if (vitrailLessKey(last, key) && vitrailLessKey(key, next)) next = key; \
    } \
  }
      VITRAIL_TAKE_FRAGMENT(0u)
#if VITRAIL_RASTER_FRAGMENTS > 1
      if (!VITRAIL_ONE_BLEND) {
        VITRAIL_TAKE_FRAGMENT(1u)
      }
#endif
    }
    if (alike == 1u) return;
    if (isFound) {
      last = next;
      next = none;
      isFound = false;
      i = 0u;
    } else if (++i == alike) {
      if (next == none) return;
      isFound = true;
      i = ((next.x & 0xffu) - 1u) / 2u;
    }
  }
}

// Puts what there is over the opaque surface.
void vitrailBlendOver(ivec2 pixel, VitrailPixelLight light) {
  vec4 sum = vec4(0.0);
#define VITRAIL_ADD_SAMPLE(i) \
  if (i < VITRAIL_RASTER_SAMPLES) { \
    sum += vec4(vec3(0.0), 1.0 - light.through[i].a) + VITRAIL_THROUGH(light, i) * vitrailColorBehind(pixel, i); \
  }
  VITRAIL_EACH_SAMPLE(VITRAIL_ADD_SAMPLE)
  imageStore(vitrailColorImage, pixel, vec4(light.color, 0.0) + VITRAIL_SHARE * sum);
}

#endif
