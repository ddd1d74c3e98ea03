// Sums over fragments that do not depend on their order: what is left of a list where it may not or cannot be sorted.
// The sums are integers, so adding in any order gives the same bits. They are blended as the weighted average of Bavoil
// and Myers, "Order Independent Transparency with Dual Depth Peeling" (2008): the mean colour, weighted by opacity,
// over the exact product of the transmittances. One fragment that covers its pixel comes out as itself, up to the sums'
// 16 and 12 bits.
//
// Premultiplied colours above 16 count as 16. The words hold 4,095 fragments of that brightness, 65,535 of brightness
// 1, and 43,690 that let nothing through; beyond that they wrap.
#ifndef VITRAIL_SUMS_GLSL
#define VITRAIL_SUMS_GLSL

#include "node.glsl"

struct VitrailSums {
  uvec3 color;  // premultiplied, in 1/65536
  uint opacity; // 1 - transmittance, in 1/65536
  uint density; // -log2 of the transmittance, in 1/4096
  uvec3 filters; // the same of multiplying surfaces, by channel
};

const VitrailSums VITRAIL_NO_SUMS = VitrailSums(uvec3(0u), 0u, 0u, uvec3(0u));

// A surface that lets nothing through counts as 2^-24.
vec4 vitrailDensity(vec4 transmittance) {
  precise vec4 density = -log2(max(transmittance, 1e-9));
  return clamp(density, 0.0, 24.0);
}

// The sums of one fragment. `weight` is the part of the pixel that it covers. A fragment is summed where it is
// collected or where it is resolved, as it happens, and both must give the same integers: `precise`, as everything from
// the node's bits on.
VitrailSums vitrailSumsOf(uvec4 key, VitrailLayout nodes, float weight) {
  VitrailPair pair = vitrailPairOf(key, nodes);
  VitrailSums sums = VITRAIL_NO_SUMS;
  precise vec3 color = min(pair.color, 16.0) * weight * 65536.0 + 0.5;
  precise float opacity = (1.0 - pair.transmittance.a) * weight * 65536.0 + 0.5;
  vec4 density = vitrailDensity(pair.transmittance);
  precise vec4 scaled = density * weight * 4096.0 + 0.5;
  sums.color = uvec3(color);
  sums.opacity = uint(opacity);
  sums.density = uint(scaled.a);
  if (pair.transmittance.rgb != vec3(pair.transmittance.a)) sums.filters = uvec3(scaled.rgb);
  return sums;
}

void vitrailAddSums(inout VitrailSums sums, VitrailSums more) {
  sums.color += more.color;
  sums.opacity += more.opacity;
  sums.density += more.density;
  sums.filters += more.filters;
}

VitrailPair vitrailPairOfSums(VitrailSums sums) {
  float transmittance = exp2(float(sums.density) / -4096.0);
  float opacity = float(sums.opacity) / 65536.0;
  VitrailPair pair;
  pair.color = vec3(sums.color) / 65536.0 * (opacity > 0.0 ? (1.0 - transmittance) / opacity : 1.0);
  pair.transmittance = vec4(transmittance * exp2(vec3(sums.filters) / -4096.0), transmittance);
  return pair;
}

// In VITRAIL_SUM_WORDS words of memory there is no room for filters by channel: their mean joins the density.
VitrailSums vitrailMergeFilters(VitrailSums sums) {
  sums.density += (sums.filters.r + sums.filters.g + sums.filters.b + 1u) / 3u;
  sums.filters = uvec3(0u);
  return sums;
}

#endif
