// Everything that node.hlsl, loose.hlsl and sums.hlsl make of a fragment on its way into memory. pack.comp is the same.
#include "vitrail/loose.hlsl"
#include "vitrail/sums.hlsl"

// The kind of nodes (format, samples, whether the nearest depth is one, fragments), then 8 words a fragment.
ByteAddressBuffer fragments : register(t0);
RWByteAddressBuffer packed : register(u1); // 18 words a fragment

[numthreads(64, 1, 1)] void main(uint3 id : SV_DispatchThreadID) {
  uint4 kind = fragments.Load4(0u);
  if (id.x >= kind.w) return;
  VitrailLayout nodes = vitrailLayout(kind.x, kind.y, kind.z != 0u);
  float4 color = asfloat(fragments.Load4(16u + 32u * id.x));
  uint4 rest = fragments.Load4(32u + 32u * id.x); // depth, blend mode, coverage
  float depth = asfloat(rest.x);
  uint4 node;
  bool changes = vitrailPack(color, rest.y, depth, rest.z, nodes, node);
  uint4 raw;
  bool rawChanges = vitrailPackRaw(color, rest.y, depth, nodes, raw);
  uint4 finished = vitrailFinish(raw, nodes);
  float weight = float(countbits(rest.z)) / float(nodes.samples);
  VitrailSums sums = vitrailMergeFilters(vitrailSumsOf(vitrailKey(node, nodes), nodes, weight));
  uint first = 72u * id.x;
  packed.Store4(first, node);
  packed.Store4(first + 16u, raw);
  packed.Store4(first + 32u, finished);
  packed.Store4(first + 48u, uint4(sums.color, sums.opacity));
  packed.Store2(first + 64u, uint2(sums.density, (changes ? 1u : 0u) | (rawChanges ? 2u : 0u)));
}
