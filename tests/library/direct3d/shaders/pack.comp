// pack.hlsl in GLSL.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "vitrail/loose.glsl"
#include "vitrail/sums.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer FragmentsBlock { uvec4 fragments[]; };
layout(set = 0, binding = 1, std430) writeonly buffer PackedBlock { uint packed[]; };

void write(uint first, uvec4 words) {
  for (uint i = 0u; i < 4u; ++i) packed[first + i] = words[i];
}

void main() {
  uint number = gl_GlobalInvocationID.x;
  uvec4 kind = fragments[0];
  if (number >= kind.w) return;
  VitrailLayout nodes = VitrailLayout(kind.x, kind.y, kind.z != 0u);
  vec4 color = uintBitsToFloat(fragments[1u + 2u * number]);
  uvec4 rest = fragments[2u + 2u * number];
  float depth = uintBitsToFloat(rest.x);
  uvec4 node;
  bool changes = vitrailPack(color, rest.y, depth, rest.z, nodes, node);
  uvec4 raw;
  bool rawChanges = vitrailPackRaw(color, rest.y, depth, nodes, raw);
  uvec4 finished = vitrailFinish(raw, nodes);
  float weight = float(bitCount(rest.z)) / float(nodes.samples);
  VitrailSums sums = vitrailMergeFilters(vitrailSumsOf(vitrailKey(node, nodes), nodes, weight));
  uint first = 18u * number;
  write(first, node);
  write(first + 4u, raw);
  write(first + 8u, finished);
  write(first + 12u, uvec4(sums.color, sums.opacity));
  packed[first + 16u] = sums.density;
  packed[first + 17u] = (changes ? 1u : 0u) | (rawChanges ? 2u : 0u);
}
