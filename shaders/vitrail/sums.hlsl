// sums.glsl for HLSL, as far as a fragment that found no node is concerned: the integers that it adds to the sums of
// its pixel. The kernels blend them.
#ifndef VITRAIL_SUMS_HLSL
#define VITRAIL_SUMS_HLSL

#include "node.hlsl"

struct VitrailSums {
  uint3 color;   // premultiplied, in 1/65536
  uint opacity;  // 1 - transmittance, in 1/65536
  uint density;  // -log2 of the transmittance, in 1/4096
  uint3 filters; // the same of multiplying surfaces, by channel
};

// A surface that lets nothing through counts as 2^-24.
float4 vitrailDensity(float4 transmittance) {
  precise float4 density = -log2(max(transmittance, 1e-9));
  return clamp(density, 0.0, 24.0);
}

// The sums of one fragment. `weight` is the part of the pixel that it covers. A fragment is summed where it is
// collected or where it is resolved, as it happens, and both must give the same integers: `precise`, as everything from
// the node's bits on.
VitrailSums vitrailSumsOf(uint4 key, VitrailLayout nodes, float weight) {
  VitrailPair pair = vitrailPairOf(vitrailKeyColor(key, nodes), vitrailKeyBlend(key, nodes));
  precise float3 color = min(pair.color, 16.0) * weight * 65536.0 + 0.5;
  precise float opacity = (1.0 - pair.transmittance.a) * weight * 65536.0 + 0.5;
  float4 density = vitrailDensity(pair.transmittance);
  precise float4 scaled = density * weight * 4096.0 + 0.5;
  VitrailSums sums;
  sums.color = uint3(color);
  sums.opacity = uint(opacity);
  sums.density = uint(scaled.a);
  sums.filters = uint3(0u, 0u, 0u);
  if (any(pair.transmittance.rgb != pair.transmittance.aaa)) sums.filters = uint3(scaled.rgb);
  return sums;
}

// In VITRAIL_SUM_WORDS words of memory there is no room for filters by channel: their mean joins the density.
VitrailSums vitrailMergeFilters(VitrailSums sums) {
  sums.density += (sums.filters.r + sums.filters.g + sums.filters.b + 1u) / 3u;
  sums.filters = uint3(0u, 0u, 0u);
  return sums;
}

#endif
