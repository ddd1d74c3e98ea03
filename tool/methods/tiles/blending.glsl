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

layout(set = 3, binding = 9, rgba16f) uniform image2D colorImage;

const VitrailLayout kTilesNodes = VitrailLayout(VITRAIL_FORMAT_HDR, 1u, true);

// What a surface does to light, in one or two steps; none where a mask cuts it away.
struct SurfaceFragments {
  vec4 colors[2];
  uint blends[2];
  uint count;
};

// As nodes hold them: not negative, no infinite colours, NaN is 0.
vec4 storedColor(vec4 color) { return vec4(min(max(color.rgb, 0.0), LARGEST_HALF), min(max(color.a, 0.0), 1.0)); }

SurfaceFragments fragmentsOf(uint record, ivec2 pixel) {
  Surface surface = shadeFragment(records[2u * record].zw, pixel, vec2(tiles.width, tiles.height));
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

void put(inout VitrailPair front, vec4 color, uint blend) {
  VitrailPair pair = vitrailPairOf(color, blend);
  front.color += front.transmittance.rgb * pair.color;
  front.transmittance *= pair.transmittance;
}

// Whether what is farther away than some fragments may be left out: whether that changes the picture by less than
// TILES_STOP of 1/255. What is left out is light of at most `most` together, or hides so much of what is behind. On the
// sRGB curve it counts most in the dark. Surfaces that add light without hiding as much have no such bound.
bool hasEnough(VitrailPair front, float most) {
  float through = max(max(front.transmittance.r, front.transmittance.g),
                      max(front.transmittance.b, front.transmittance.a));
  if ((kAnyFeatures & (FEATURE_ADDITIVE | FEATURE_TRANSMISSION)) != 0u) return through <= 0.0;
  float darkest = min(front.color.r, min(front.color.g, front.color.b));
  float steepness = darkest > 0.0031308 ? 0.43958 * pow(darkest, -0.58333) : 12.92;
  return through * most * steepness * 255.0 < TILES_STOP;
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

// The record of the i-th surface of those that have one depth, which the including shader has at hand.
uint alikeRecord(uint i);

// Blends them. Up to TILES_TIES are in the order of what they are: each turn finds the next fragment, of which a surface
// has two at most. More are in the order in which they are at hand, that of sourceBefore().
void blendAlike(inout VitrailPair front, ivec2 pixel, uint alike) {
  bool byColor = alike > 1u && alike <= TILES_TIES;
  uint turns = byColor ? 2u * alike : alike;
  uvec4 last = uvec4(0u);
  for (uint turn = 0u; turn < turns; ++turn) {
    uvec4 best = uvec4(0xffffffffu);
    vec4 bestColor = vec4(0.0);
    for (uint i = 0u; i < (byColor ? alike : 1u); ++i) {
      SurfaceFragments f = fragmentsOf(alikeRecord(byColor ? i : turn), pixel);
      for (uint k = 0u; k < f.count; ++k) {
        if (!byColor) {
          put(front, f.colors[k], f.blends[k]);
          continue;
        }
        uvec4 order = tieKey(f.colors[k], f.blends[k], 2u * i + k + 1u);
        if (lessKey(last, order) && lessKey(order, best)) {
          best = order;
          bestColor = f.colors[k];
        }
      }
    }
    if (!byColor) continue;
    if (best.w == 0xffffffffu) break;
    put(front, bestColor, best.x);
    last = best;
  }
}

void blendOver(ivec2 pixel, VitrailPair front) {
  vec4 behind = imageLoad(colorImage, pixel);
  imageStore(colorImage, pixel,
             vec4(front.color, 1.0 - front.transmittance.a) + front.transmittance * behind);
}

#endif
