// Fragments of a pixel, nearest first, blended as they come: what of the light behind is left, and what has been added
// to it.
#ifndef VITRAIL_TOOL_TILES_BLENDING_GLSL
#define VITRAIL_TOOL_TILES_BLENDING_GLSL

// The nodes of linked-list that pictures are held to; of them the order at one depth.
#define VITRAIL_ONLY_FORMAT 2
#include "vitrail/node.glsl"

#include "fragment.glsl"
#include "opaque_depth.glsl"
#include "source_order.glsl"

#ifdef TILES_MSAA
layout(set = 3, binding = 9, rgba16f) uniform writeonly image2D colorImage;
layout(set = 3, binding = 18) uniform texture2DMS opaqueImage;

vec4 colorBehind(ivec2 pixel, uint sample_) { return texelFetch(opaqueImage, pixel, int(sample_)); }
#else
layout(set = 3, binding = 9, rgba16f) uniform image2D colorImage;

vec4 colorBehind(ivec2 pixel, uint sample_) { return imageLoad(colorImage, pixel); }
#endif

#ifdef TILES_MSAA
#define EACH_SAMPLE(what) what(0) what(1) what(2) what(3) what(4) what(5) what(6) what(7)
#else
#define EACH_SAMPLE(what) what(0)
#endif

// What there is at each sample of a pixel: of fragments so far, and of the opaque surface.
struct PixelLight {
#ifdef TILES_MSAA
  VitrailPair fronts[TILES_MOST_SAMPLES];
  float depths[TILES_MOST_SAMPLES];
#else
  VitrailPair fronts[1];
#endif
  float most; // the most light that anything behind the fragments may send
};

const VitrailLayout kTilesNodes = VitrailLayout(VITRAIL_FORMAT_HDR, 1u, true);

// What a surface does to light, in one or two steps; none where a mask cuts it away.
struct SurfaceFragments {
  vec4 colors[2];
  uint blends[2];
  uint count;
};

// As nodes hold them: not negative, no infinite colours, NaN is 0.
vec4 storedColor(vec4 color) { return vec4(min(max(color.rgb, 0.0), LARGEST_HALF), min(max(color.a, 0.0), 1.0)); }

SurfaceFragments fragmentsOf(Surface surface) {
  SurfaceFragments f;
  f.count = surfaceCut ? 0u : 1u;
  f.colors[0] = storedColor(vec4(surface.color, surface.alpha));
  f.blends[0] = has(FEATURE_ADDITIVE) ? VITRAIL_ADDITIVE : VITRAIL_OVER;
  f.colors[1] = vec4(0.0);
  f.blends[1] = VITRAIL_MULTIPLY;
  if (has(FEATURE_TRANSMISSION)) {
    f.colors[0] = storedColor(reflectionOf(surface));
    f.blends[0] = VITRAIL_PREMULTIPLIED;
    f.colors[1] = storedColor(filterOf(surface));
    f.count *= 2u;
  }
  return f;
}

PixelLight lightBehind(ivec2 pixel) {
  PixelLight light;
  light.most = tiles.lightMost;
#ifdef TILES_MSAA
#define SET_DEPTH(i) light.depths[i] = i < kSamples ? opaqueDepth(pixel, i) : 0.0;
  EACH_SAMPLE(SET_DEPTH)
#endif
#define SET_SAMPLE(i) \
  light.fronts[i] = VitrailPair(vec3(0.0), vec4(1.0)); \
  if (i < kSamples) { \
    vec4 behind = colorBehind(pixel, i); \
    light.most = max(light.most, max(behind.r, max(behind.g, behind.b))); \
  }
  EACH_SAMPLE(SET_SAMPLE)
  return light;
}

// The samples at which a record's fragment shows, a bit each. `thread`: the pixel in its tile.
uint visibleSamples(PixelLight light, uint record, ivec2 pixel, uint thread) {
#ifdef TILES_MSAA
  vec4 plane = uintBitsToFloat(records[2u * record + 1u]);
  float depth = fma(plane.y, float(thread & 7u), fma(plane.z, float(thread >> 3), plane.x)) + depthSlack(plane, pixel);
  uint visible = 0u;
#define SEE_SAMPLE(i) \
  if (i < kSamples) { \
    uvec2 mask = sampleMasks[record * kSamples + i]; \
    bool covers = ((thread < 32u ? mask.x : mask.y) >> (thread & 31u) & 1u) != 0u; \
    float there = depth + dot(plane.yz, vec2(samplePlace(i) - 8)) / 16.0; \
    if (covers && there >= light.depths[i]) visible |= 1u << i; \
  }
  EACH_SAMPLE(SEE_SAMPLE)
  return visible;
#else
  return 1u;
#endif
}

// What of the light behind comes through. Where all surfaces let the same of all colours through, one number is kept;
// not of several samples, where that came out slower.
#ifdef TILES_MSAA
#define THROUGH(front) (front).transmittance
#else
const bool kThroughVaries = (kAnyFeatures & (FEATURE_ADDITIVE | FEATURE_TRANSMISSION)) != 0u;
#define THROUGH(front) (kThroughVaries ? (front).transmittance : (front).transmittance.aaaa)
#endif

void put(inout PixelLight light, vec4 color, uint blend, uint visible) {
  VitrailPair pair = vitrailPairOf(color, blend);
#define PUT_SAMPLE(i) \
  if ((visible & (1u << i)) != 0u) { \
    light.fronts[i].color += THROUGH(light.fronts[i]).rgb * pair.color; \
    light.fronts[i].transmittance *= pair.transmittance; \
  }
  EACH_SAMPLE(PUT_SAMPLE)
}

// Whether what is farther away than some fragments may be left out: whether that changes the picture by less than
// TILES_STOP of 1/255. What is left out is light of at most `most` together, or hides so much of what is behind. On the
// sRGB curve it counts most in the dark. Surfaces that add light without hiding as much have no such bound.
bool hasEnoughAt(VitrailPair front, float most) {
  vec4 all = THROUGH(front);
  float through = max(max(all.r, all.g), max(all.b, all.a));
  if ((kAnyFeatures & (FEATURE_ADDITIVE | FEATURE_TRANSMISSION)) != 0u) return through <= 0.0;
  float darkest = min(front.color.r, min(front.color.g, front.color.b));
  float steepness = darkest > 0.0031308 ? 0.43958 * pow(darkest, -0.58333) : 12.92;
  return through * most * steepness * 255.0 < TILES_STOP;
}

bool hasEnough(PixelLight light) {
  bool enough = true;
#define ASK_SAMPLE(i) if (i < kSamples) enough = enough && hasEnoughAt(light.fronts[i], light.most);
  EACH_SAMPLE(ASK_SAMPLE)
  return enough;
}

// The order at one depth: by what fragments are, as in fragment lists.
uvec4 tieKey(vec4 color, uint blend, uint number) {
  uvec4 node;
  vitrailPack(color, blend, 0.0, 1u, kTilesNodes, node);
  return uvec4(blend, node.xy, number);
}

bool lessKey(uvec4 a, uvec4 b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z != b.z ? a.z < b.z : a.w < b.w;
}

// The i-th surface of those that have one depth, which the including shader has at hand: its record, and it, shaded.
uint alikeRecord(uint i);
Surface alikeSurface(uint i, ivec2 pixel);

// Blends them: one, or up to TILES_TIES in the order of what they are. Then each turn through all finds the next
// fragment, of which a surface has two at most. What shades them stands here once, as it is what takes long.
void blendAlike(inout PixelLight light, ivec2 pixel, uint thread, uint alike) {
  uvec4 last = uvec4(0u);
  uvec4 best = uvec4(0xffffffffu);
  vec4 bestColor = vec4(0.0);
  uint bestVisible = 0u;
  uint i = 0u;
  for (uint step = 0u; step < (2u * TILES_TIES + 1u) * TILES_TIES; ++step) {
    uint visible = kSamples > 1u ? visibleSamples(light, alikeRecord(i), pixel, thread) : 1u;
    if (visible != 0u) {
      SurfaceFragments f = fragmentsOf(alikeSurface(i, pixel));
      // No loop: arrays stay in registers where their indices are constants.
#define TAKE_FRAGMENT(k) \
  if (f.count > k && alike == 1u) put(light, f.colors[k], f.blends[k], visible); \
  if (f.count > k && alike > 1u) { \
    uvec4 order = tieKey(f.colors[k], f.blends[k], 2u * i + k + 1u); \
    if (lessKey(last, order) && lessKey(order, best)) { \
      best = order; \
      bestColor = f.colors[k]; \
      bestVisible = visible; \
    } \
  }
      TAKE_FRAGMENT(0u)
      if ((kAnyFeatures & FEATURE_TRANSMISSION) != 0u) {
        TAKE_FRAGMENT(1u)
      }
    }
    if (alike == 1u) return;
    if (++i < alike) continue;
    if (best.w == 0xffffffffu) return;
    put(light, bestColor, best.x, bestVisible);
    last = best;
    best = uvec4(0xffffffffu);
    i = 0u;
  }
}

// Puts what there is over the opaque surface.
void blendOver(ivec2 pixel, PixelLight light) {
  vec4 sum = vec4(0.0);
#define ADD_SAMPLE(i) \
  if (i < kSamples) { \
    VitrailPair front = light.fronts[i]; \
    sum += vec4(front.color, 1.0 - front.transmittance.a) + THROUGH(front) * colorBehind(pixel, i); \
  }
  EACH_SAMPLE(ADD_SAMPLE)
  imageStore(colorImage, pixel, sum / float(kSamples));
}

#endif
